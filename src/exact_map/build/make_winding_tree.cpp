#include "exact_map/build/make_winding_tree.hpp"

#include "exact_map/build/border_caps.hpp"
#include "exact_map/build/face_tree.hpp"
#include "exact_map/winding_nodes.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <utility>

namespace echinus {

namespace {

/// Caps spare the sum over the faces but not the crossings of the place's ray.
constexpr std::size_t kFewestFacesPerCap = 2;

/// An edge along which several faces more run in one direction counts as often.
std::size_t edge_count(const ExactMapView& map) {
    std::size_t count = 0;
    for (const BorderEdge& edge : map.border)
        count += static_cast<std::size_t>(std::abs(std::int64_t{edge.multiplicity}));
    return count;
}

/// How many of some triangles a sum has to take one by one, up to a factor: for each, the share of the
/// bounding sphere that is not far from it as it is long. So a tube of long faces has many, and caps of its
/// round ends few, although they have as many edges as it has faces.
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

/// Triangles to sum instead of the faces; none where that would not be faster.
std::vector<Triangle> find_caps(const ExactMapView& map) {
    constexpr double kFewNearby = 8, kGain = 4;
    const std::size_t edges = edge_count(map);
    if (kFewestFacesPerCap * edges <= map.face_count()) return cap_border(map.border, map.vertices);
    if (edges > 3 * map.face_count())
        return {}; // in a file, where nothing compares the border with the faces
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

void OwnedWindingTree::show_in(ExactMapView& map) const {
    map.winding_tree_has_caps = !cap_nodes.empty();
    map.winding_tree.nodes = map.winding_tree_has_caps ? std::span(cap_nodes) : map.nodes;
    map.winding_tree.corners = map.winding_tree_has_caps ? IndexArray{{}, cap_corners} : map.corners;
    map.winding_tree.moments = moments;
    map.neighbours_disagree = neighbours_disagree;
}

OwnedWindingTree make_winding_tree(const ExactMapView& map) {
    OwnedWindingTree result;
    result.neighbours_disagree =
        std::all_of(map.border.begin(), map.border.end(),
                    [](const BorderEdge& edge) { return edge.multiplicity == 2 || edge.multiplicity == -2; });
    set_caps(map, result);
    ExactMapView with_tree = map;
    result.show_in(with_tree);
    result.moments = find_winding_nodes(with_tree.winding_tree, map.vertices);
    return result;
}

} // namespace echinus
