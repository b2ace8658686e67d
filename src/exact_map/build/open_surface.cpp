#include "exact_map/build/open_surface.hpp"

#include "directions/face_cone.hpp"
#include "directions/lattice.hpp"
#include "exact_map/build/face_tree.hpp"
#include "geometry/box.hpp"
#include "geometry/whole_numbers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <numeric>
#include <tuple>
#include <utility>

namespace echinus {

namespace {

/// An edge seen from its lower vertex, with the number of faces that run away from it minus those towards it.
struct HalfEdge {
    std::uint32_t higher;
    std::int32_t count; ///< a face has an edge only once, so that sums are at most kMostFaces
};

/// Sums the half edges of one vertex by their other endpoint, and appends those that do not cancel.
void append_unbalanced(std::uint32_t lower, std::span<HalfEdge> half_edges, std::vector<BorderEdge>& border) {
    std::sort(half_edges.begin(), half_edges.end(),
              [](const HalfEdge& a, const HalfEdge& b) { return a.higher < b.higher; });
    for (std::size_t i = 0; i < half_edges.size();) {
        const std::uint32_t higher = half_edges[i].higher;
        std::int32_t sum = 0;
        for (; i < half_edges.size() && half_edges[i].higher == higher; ++i) sum += half_edges[i].count;
        if (sum != 0) border.push_back({lower, higher, sum});
    }
}

/// [vertex_count] For each vertex, the first vertex at the same lattice point.
std::vector<std::uint32_t> first_vertices_at(const std::vector<LatticePoint>& vertices) {
    const auto key = [&](std::uint32_t v) {
        return std::tuple(vertices[v].x, vertices[v].y, vertices[v].z, v);
    };
    std::vector<std::uint32_t> order(vertices.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    std::vector<std::uint32_t> first(vertices.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        const bool repeated = i > 0 && vertices[order[i]] == vertices[order[i - 1]];
        first[order[i]] = repeated ? first[order[i - 1]] : order[i];
    }
    return first;
}

/// @param number  [vertex_count] a number for each vertex, the same for vertices at the same place
std::vector<BorderEdge> unbalanced_edges(const LatticeMesh& lattice,
                                         const std::vector<std::uint32_t>& number) {
    const auto for_each_half_edge = [&](const auto& visit) {
        for (std::uint32_t face = 0; face < lattice.faces.size(); ++face) {
            if (is_collapsed(lattice.corners(face))) continue;
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t a = number[lattice.faces[face][k]];
                const std::uint32_t b = number[lattice.faces[face][(k + 1) % 3]];
                visit(std::min(a, b), HalfEdge{std::max(a, b), a < b ? 1 : -1});
            }
        }
    };
    std::vector<std::uint32_t> next(lattice.vertices.size() + 1);
    for_each_half_edge([&](std::uint32_t lower, HalfEdge) { ++next[lower + 1]; });
    std::partial_sum(next.begin(), next.end(), next.begin());
    std::vector<HalfEdge> half_edges(next.back());
    for_each_half_edge(
        [&](std::uint32_t lower, HalfEdge half_edge) { half_edges[next[lower]++] = half_edge; });
    // Now next[v] is the end of the half edges of v.
    std::vector<BorderEdge> border;
    std::size_t first = 0;
    for (std::uint32_t lower = 0; lower < lattice.vertices.size(); ++lower) {
        append_unbalanced(lower, std::span(half_edges).subspan(first, next[lower] - first), border);
        first = next[lower];
    }
    return border;
}

} // namespace

std::vector<BorderEdge> find_border(const LatticeMesh& lattice) {
    return unbalanced_edges(lattice, first_vertices_at(lattice.vertices));
}

namespace {

/// An edge along which a face runs in this direction and none against it.
struct OpenEdge {
    std::uint32_t from, to;
};

std::vector<OpenEdge> open_edges(std::span<const BorderEdge> border, std::size_t vertex_count) {
    std::vector<OpenEdge> result;
    for (const auto& [a, b, multiplicity] : border)
        if (std::max(a, b) < vertex_count)
            result.insert(result.end(), static_cast<std::size_t>(std::abs(std::int64_t{multiplicity})),
                          multiplicity > 0 ? OpenEdge{a, b} : OpenEdge{b, a});
    std::sort(result.begin(), result.end(),
              [](const OpenEdge& x, const OpenEdge& y) { return x.from < y.from; });
    return result;
}

/// Follows each edge once, and calls visit(loop) whenever the path meets itself, with the vertices of the
/// loop that this closes.
template <typename Visit>
void for_each_loop(std::span<const OpenEdge> edges, std::size_t vertex_count, const Visit& visit) {
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> next(vertex_count, kNone), place_on_path(vertex_count, kNone), path;
    for (std::size_t e = edges.size(); e-- > 0;) next[edges[e].from] = kept_as<std::uint32_t>(e);
    const auto take_edge_from = [&](std::uint32_t vertex) -> const OpenEdge* {
        std::uint32_t& e = next[vertex];
        if (e == kNone || e == edges.size() || edges[e].from != vertex) return nullptr;
        return &edges[e++];
    };
    for (const OpenEdge& first : edges) {
        std::uint32_t vertex = first.from;
        while (true) {
            if (const std::uint32_t place = place_on_path[vertex]; place != kNone) {
                const std::span loop = std::span(path).subspan(place);
                visit(loop);
                for (const std::uint32_t v : loop) place_on_path[v] = kNone;
                path.resize(place);
            }
            place_on_path[vertex] = kept_as<std::uint32_t>(path.size());
            path.push_back(vertex);
            const OpenEdge* edge = take_edge_from(vertex);
            if (edge == nullptr) break;
            vertex = edge->to;
        }
        for (const std::uint32_t v : path) place_on_path[v] = kNone;
        path.clear();
    }
}

class LoopCap {
  public:
    LoopCap(std::span<const Vec3<std::int32_t>> vertices, std::vector<Triangle>& triangles)
        : vertices_(vertices), triangles_(triangles) {}

    /// Fills the loop that a path and the edge between its endpoints form. The triangles run against it,
    /// since they close the surface.
    void operator()(std::span<const std::uint32_t> path) const {
        if (path.size() < 3) return;
        const std::size_t middle = path.size() / 2;
        add({path.front(), path.back(), path[middle]});
        (*this)(path.first(middle + 1));
        (*this)(path.subspan(middle));
    }

  private:
    void add(const Triangle& triangle) const {
        const LatticePoint a(vertices_[triangle[0]]), b(vertices_[triangle[1]]), c(vertices_[triangle[2]]);
        if (cross(b - a, c - a) != LatticePoint{}) triangles_.push_back(triangle);
    }

    std::span<const Vec3<std::int32_t>> vertices_;
    std::vector<Triangle>& triangles_;
};

} // namespace

std::vector<Triangle> cap_border(std::span<const BorderEdge> border,
                                 std::span<const Vec3<std::int32_t>> vertices) {
    std::vector<Triangle> triangles;
    for_each_loop(open_edges(border, vertices.size()), vertices.size(), LoopCap(vertices, triangles));
    return triangles;
}

namespace {

/// Moments of some faces about their area-weighted centre.
struct Moments {
    Vec3d centre;
    Vec3d area;                    ///< sum of the area vectors
    std::array<Vec3d, 3> first{};  ///< integral of the area vector times the offset along each axis
    std::array<Vec3d, 6> second{}; ///< integral of area vector times two offsets: xx, yy, zz, xy, xz, yz
    double total_area = 0, spread = 0, radius = 0;
    AlignedBox<double> box;
};

constexpr std::size_t kAxes[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};

std::array<double, 3> coordinates(const Vec3d& v) {
    return {v.x, v.y, v.z};
}

Moments moments_of_leaf(const WindingTree& tree, std::span<const Vec3<std::int32_t>> vertices,
                        std::size_t first) {
    const std::size_t last = std::min(first + TreeNode::kWidth, tree.triangle_count());
    Moments result;
    Vec3d weighted;
    const auto for_each = [&](const auto& visit) {
        for (std::size_t triangle = first; triangle < last; ++triangle) {
            const auto corner = [&](std::size_t k) {
                return Vec3d(vertices[tree.corners[3 * triangle + k]]);
            };
            const Vec3d a = corner(0), b = corner(1), c = corner(2);
            visit(a, b, c, cross(b - a, c - a) * 0.5);
        }
    };
    for_each([&](const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& area) {
        for (const Vec3d& corner : {a, b, c}) result.box.add(corner);
        result.area += area;
        result.total_area += length(area);
        weighted += (a + b + c) * (length(area) / 3);
    });
    result.centre = result.total_area > 0 ? weighted * (1 / result.total_area) : result.box.low;
    for_each([&](const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& area) {
        const Vec3d from_a = a - result.centre, from_b = b - result.centre, from_c = c - result.centre;
        const Vec3d sum = from_a + from_b + from_c;
        const auto at_a = coordinates(from_a), at_b = coordinates(from_b), at_c = coordinates(from_c),
                   at_sum = coordinates(sum);
        for (std::size_t i = 0; i < 3; ++i) result.first[i] += area * (at_sum[i] / 3);
        for (std::size_t n = 0; n < 6; ++n) {
            const auto [i, j] = kAxes[n];
            const double products =
                at_a[i] * at_a[j] + at_b[i] * at_b[j] + at_c[i] * at_c[j] + at_sum[i] * at_sum[j];
            result.second[n] += area * (products / 12);
        }
        const double squares =
            dot(from_a, from_a) + dot(from_b, from_b) + dot(from_c, from_c) + dot(sum, sum);
        result.spread += length(area) * squares / 12;
        result.radius = std::max({result.radius, length(from_a), length(from_b), length(from_c)});
    });
    return result;
}

/// The moments of several parts together. The spread of each part about its own centre grows by the squared
/// distance between the centres, weighted by area, since its own centre is the centre of its area.
Moments joined(const std::array<Moments, TreeNode::kWidth>& parts, std::size_t count) {
    Moments result;
    Vec3d weighted;
    for (std::size_t k = 0; k < count; ++k) {
        result.box.add(parts[k].box);
        result.area += parts[k].area;
        result.total_area += parts[k].total_area;
        weighted += parts[k].centre * parts[k].total_area;
    }
    result.centre = result.total_area > 0 ? weighted * (1 / result.total_area) : result.box.low;
    double radius = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const Moments& part = parts[k];
        const Vec3d offset = part.centre - result.centre;
        const auto by = coordinates(offset);
        for (std::size_t i = 0; i < 3; ++i) result.first[i] += part.first[i] + part.area * by[i];
        for (std::size_t n = 0; n < 6; ++n) {
            const auto [i, j] = kAxes[n];
            result.second[n] +=
                part.second[n] + part.first[i] * by[j] + part.first[j] * by[i] + part.area * (by[i] * by[j]);
        }
        result.spread += part.spread + dot(offset, offset) * part.total_area;
        radius = std::max(radius, length(offset) + part.radius);
    }
    result.radius = std::min(radius, result.box.farthest_distance(result.centre));
    return result;
}

/// The terms of orders 1 and 2 are polynomials in r = (x, y, z), divided by r^5 and r^7:
///
///     -3 sum of F_ij r_i r_j + trace r^2,   15/2 sum of S_ijk r_i r_j r_k - 3/2 r^2 (2 F' + F'') r,
///
/// with the moments F_ij of area i times offset j, and S_ijk with two offsets. Both polynomials are harmonic,
/// so the traces need not be stored: the first is a sum of x^2, y^2, z^2, xy, xz, yz in which the
/// coefficients of the squares sum to 0, the second a sum of the seven polynomials
///
///     x (x^2 - 3 z^2), y (y^2 - 3 z^2), z (z^2 - 3 x^2), x (y^2 - z^2), y (x^2 - z^2), z (y^2 - x^2), xyz,
///
/// found by subtracting multiples of x r^2, y r^2 and z r^2, which are not harmonic.
void store(const Moments& moments, std::size_t k, WindingNode& node) {
    constexpr double kPerSolidAngle = 1 / (4 * std::numbers::pi);
    const auto set = [&](double(&rows)[3][WindingNode::kWidth], const Vec3d& v) {
        rows[0][k] = v.x;
        rows[1][k] = v.y;
        rows[2][k] = v.z;
    };
    set(node.centre, moments.centre);
    set(node.area, moments.area * kPerSolidAngle);

    const auto& [x, y, z] = moments.first;
    const double third_of_trace = (x.x + y.y + z.z) / 3;
    const double quadratic[6] = {
        x.x - third_of_trace, y.y - third_of_trace, z.z - third_of_trace, x.y + y.x, x.z + z.x, y.z + z.y};
    for (std::size_t i = 0; i < 6; ++i) node.first[i][k] = -3 * kPerSolidAngle * quadratic[i];

    // Coefficients of the cubic form, in the order x^3, y^3, z^3, x y^2, x z^2, y x^2, y z^2, z x^2, z y^2,
    // xyz.
    const auto& [xx, yy, zz, xy, xz, yz] = moments.second;
    const double xxx = xx.x, yyy = yy.y, zzz = zz.z;
    const double xyy = yy.x + 2 * xy.y, xzz = zz.x + 2 * xz.z, yxx = xx.y + 2 * xy.x, yzz = zz.y + 2 * yz.z,
                 zxx = xx.z + 2 * xz.x, zyy = yy.z + 2 * yz.y, xyz = 2 * (yz.x + xz.y + xy.z);
    // Subtracts l r^2 with the linear form l that leaves a harmonic form: a tenth of the cubic form's
    // Laplacian.
    const double lx = (3 * xxx + xyy + xzz) / 5, ly = (3 * yyy + yxx + yzz) / 5,
                 lz = (3 * zzz + zxx + zyy) / 5;
    const double cubic[7] = {xxx - lx, yyy - ly, zzz - lz, xyy - lx, yxx - ly, zyy - lz, xyz};
    for (std::size_t i = 0; i < 7; ++i) node.second[i][k] = 7.5 * kPerSolidAngle * cubic[i];

    // Rounded up by more than all rounding errors above.
    constexpr double kUp = 1 + 0x1p-30;
    node.radius[k] = moments.radius * kUp;
    node.spread[k] = moments.spread * (kPerSolidAngle * kUp);
    node.total_area[k] = moments.total_area * (kPerSolidAngle * kUp);
}

} // namespace

std::vector<WindingNode> find_winding_nodes(const WindingTree& tree,
                                            std::span<const Vec3<std::int32_t>> vertices) {
    std::vector<WindingNode> result(tree.nodes.size());
    std::vector<Moments> of_node(tree.nodes.size());
    for (std::size_t i = tree.nodes.size(); i-- > 0;) {
        const TreeNode& node = tree.nodes[i];
        std::array<Moments, TreeNode::kWidth> parts;
        std::size_t count = 0;
        for (std::size_t k = 0; k < TreeNode::kWidth; ++k) {
            if (node.low[0][k] > node.high[0][k]) { // there is no such child: it counts as empty and far away
                result[i].centre[0][k] = 1e30;
                continue;
            }
            const std::uint32_t child = node.children[k];
            const bool is_leaf = (child & TreeNode::kLeaf) != 0;
            parts[count] = is_leaf
                               ? moments_of_leaf(tree, vertices, (child - TreeNode::kLeaf) * TreeNode::kWidth)
                               : of_node[child];
            store(parts[count], k, result[i]);
            ++count;
        }
        of_node[i] = joined(parts, count);
    }
    return result;
}

namespace {

/// Caps save the sum over the faces but not the crossings of the place's ray.
constexpr std::size_t kFewestFacesPerCap = 2;

/// Counts an edge once for each surplus face in one direction.
std::size_t edge_count(const ExactMapView& map) {
    std::size_t count = 0;
    for (const BorderEdge& edge : map.border)
        count += static_cast<std::size_t>(std::abs(std::int64_t{edge.multiplicity}));
    return count;
}

/// Up to a factor, how many triangles a sum has to evaluate one by one: for each, the share of the bounding
/// sphere that is closer to it than about its own length. So this is large for a tube of long faces and small
/// for caps of its round ends, although they have as many edges as the tube has faces.
template <typename Corner>
double count_nearby(const ExactMapView& map, std::size_t triangle_count, const Corner& corner) {
    double count = 0;
    for (std::size_t t = 0; t < triangle_count; ++t) {
        const auto at = [&](std::size_t k) { return Vec3d(map.vertices[corner(3 * t + k)]); };
        const Vec3d a = at(0), b = at(1), c = at(2);
        const double longest = std::max({length(b - a), length(c - b), length(a - c)});
        const double share = std::min(longest / static_cast<double>(kLatticeExtent), 1.0);
        count += share * share * share;
    }
    return count;
}

double count_nearby_faces(const ExactMapView& map) {
    return count_nearby(map, map.face_count(), [&](std::size_t i) { return map.corners[i]; });
}
double count_nearby(const ExactMapView& map, const std::vector<Triangle>& caps) {
    return count_nearby(map, caps.size(), [&](std::size_t i) { return caps[i / 3][i % 3]; });
}

/// Triangles to sum instead of the faces; none if that would not be faster.
std::vector<Triangle> find_caps(const ExactMapView& map) {
    constexpr double kFewNearby = 8, kGain = 4;
    const std::size_t edges = edge_count(map);
    if (kFewestFacesPerCap * edges <= map.face_count()) return cap_border(map.border, map.vertices);
    if (edges > 3 * map.face_count())
        return {}; // possible in a file, since nothing compares the border with the faces there
    const double faces_nearby = count_nearby_faces(map);
    if (faces_nearby < kFewNearby) return {};
    std::vector<Triangle> caps = cap_border(map.border, map.vertices);
    if (kGain * count_nearby(map, caps) > faces_nearby) return {};
    return caps;
}

void set_caps(const ExactMapView& map, OwnedWindingTree& result) {
    LatticeMesh caps;
    caps.faces = find_caps(map);
    if (caps.faces.empty()) return;
    for (const Vec3<std::int32_t>& vertex : map.vertices) caps.vertices.emplace_back(vertex);
    FaceTree tree;
    build_face_tree(caps, 1, tree);
    result.cap_nodes = std::move(tree.nodes);
    result.cap_corners.reserve(3 * caps.faces.size());
    for (const std::uint32_t cap : tree.order)
        for (const std::uint32_t corner : caps.faces[cap]) result.cap_corners.push_back(corner);
}

} // namespace

OwnedWindingTree make_winding_tree(const ExactMapView& map) {
    OwnedWindingTree result;
    set_caps(map, result);
    WindingTree& tree = result.tree;
    tree.has_caps = !result.cap_nodes.empty();
    tree.nodes = tree.has_caps ? std::span(std::as_const(result.cap_nodes)) : map.nodes;
    tree.corners = tree.has_caps ? IndexArray{{}, result.cap_corners} : map.corners;
    tree.neighbours_disagree = std::all_of(map.border.begin(), map.border.end(), [](const BorderEdge& edge) {
        return edge.multiplicity == 2 || edge.multiplicity == -2;
    });
    result.moments = find_winding_nodes(tree, map.vertices);
    tree.moments = result.moments;
    return result;
}

} // namespace echinus
