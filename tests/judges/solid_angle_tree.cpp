#include "judges/solid_angle_tree.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>

namespace echinus::test {

namespace {

constexpr std::uint32_t kLeafSize = 8;

/// van Oosterom and Strackee, "The Solid Angle of a Plane Triangle" (1983).
double triangle_solid_angle(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const double la = length(a), lb = length(b), lc = length(c);
    return 2 *
           std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
}

bool is_within(const Vec3d& p, const Vec3d& low, const Vec3d& high) {
    return p.x >= low.x && p.x <= high.x && p.y >= low.y && p.y <= high.y && p.z >= low.z && p.z <= high.z;
}

double coordinate(const Vec3d& v, int axis) {
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

} // namespace

SolidAngleTree::SolidAngleTree(const TriangleMesh& mesh) {
    const TriangleMesh welded = weld(mesh); // more edges cancel, which shortens the borders
    for (const Vec3f& vertex : welded.vertices) vertices_.emplace_back(vertex);
    faces_ = welded.faces;
    order_.resize(faces_.size());
    std::iota(order_.begin(), order_.end(), 0U);
    build(0, static_cast<std::uint32_t>(order_.size()));
}

void SolidAngleTree::find_box(Node& node) const {
    node.low = node.high = vertices_[faces_[order_[node.first]][0]];
    for (const std::uint32_t face : std::span(order_).subspan(node.first, node.count))
        for (const std::uint32_t vertex : faces_[face]) {
            const Vec3d& p = vertices_[vertex];
            node.low = {std::min(node.low.x, p.x), std::min(node.low.y, p.y), std::min(node.low.z, p.z)};
            node.high = {std::max(node.high.x, p.x), std::max(node.high.y, p.y), std::max(node.high.z, p.z)};
        }
}

/// The edges along which more faces run in one direction than in the other.
void SolidAngleTree::find_border(Node& node) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::int32_t> balance;
    for (const std::uint32_t face : std::span(order_).subspan(node.first, node.count))
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t from = faces_[face][k], to = faces_[face][(k + 1) % 3];
            balance[std::minmax(from, to)] += from < to ? 1 : -1;
        }
    node.first_edge = static_cast<std::uint32_t>(edges_.size());
    for (const auto& [edge, multiplicity] : balance)
        if (multiplicity != 0) edges_.push_back({edge.first, edge.second, multiplicity});
    node.edge_count = static_cast<std::uint32_t>(edges_.size()) - node.first_edge;
    if (node.edge_count > 0) node.apex = edges_[node.first_edge].from;
}

/// Sorts the node's faces into two halves along the longest side of its box.
std::uint32_t SolidAngleTree::split(const Node& node) {
    const Vec3d size = node.high - node.low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const auto begin = order_.begin() + node.first;
    const std::uint32_t half = node.count / 2;
    std::ranges::nth_element(begin, begin + half, begin + node.count, {}, [&](std::uint32_t face) {
        const auto& [a, b, c] = faces_[face];
        return coordinate(vertices_[a] + vertices_[b] + vertices_[c], axis);
    });
    return node.first + half;
}

void SolidAngleTree::build(std::uint32_t begin, std::uint32_t end) {
    const std::size_t index = nodes_.size();
    nodes_.emplace_back();
    Node node;
    node.first = begin;
    node.count = end - begin;
    find_box(node);
    find_border(node);
    if (node.count > kLeafSize) {
        const std::uint32_t middle = split(node);
        build(begin, middle);
        node.second = static_cast<std::uint32_t>(nodes_.size());
        build(middle, end);
    }
    nodes_[index] = node;
}

double SolidAngleTree::solid_angle(std::uint32_t index, const Vec3d& point) const {
    const Node& node = nodes_[index];
    double sum = 0;
    if (node.edge_count < node.count && !is_within(point, node.low, node.high)) {
        const Vec3d apex = vertices_[node.apex] - point;
        for (const Edge& edge : std::span(edges_).subspan(node.first_edge, node.edge_count))
            sum += edge.multiplicity *
                   triangle_solid_angle(apex, vertices_[edge.from] - point, vertices_[edge.to] - point);
        return sum;
    }
    if (node.second != 0) return solid_angle(index + 1, point) + solid_angle(node.second, point);
    for (const std::uint32_t face : std::span(order_).subspan(node.first, node.count)) {
        const auto& [a, b, c] = faces_[face];
        sum += triangle_solid_angle(vertices_[a] - point, vertices_[b] - point, vertices_[c] - point);
    }
    return sum;
}

double SolidAngleTree::winding_number(const Vec3d& point) const {
    return solid_angle(0, point) / (4 * std::numbers::pi);
}

} // namespace echinus::test
