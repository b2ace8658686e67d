#include "exact_map/build/make_winding_tree.hpp"

#include "exact_map/build/border_caps.hpp"
#include "exact_map/build/face_tree.hpp"
#include "exact_map/winding_nodes.hpp"

#include <cstddef>
#include <cstdlib>
#include <utility>

namespace echinus {

namespace {

/// Caps spare the sum over the faces but not the crossings of the place's ray.
constexpr std::size_t kFewestFacesPerCap = 2;

/// An edge along which several faces more run in one direction counts as often. The sum may be anything in a
/// file, the border of which is not compared with its faces.
bool has_few_edges(const ExactMapView& map) {
    std::size_t count = 0;
    for (const BorderEdge& edge : map.border)
        count += static_cast<std::size_t>(std::abs(std::int64_t{edge.multiplicity}));
    return kFewestFacesPerCap * count <= map.face_count();
}

void set_caps(const ExactMapView& map, OwnedWindingTree& result) {
    LatticeMesh caps;
    caps.faces = cap_border(map.border, map.vertices);
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
}

OwnedWindingTree make_winding_tree(const ExactMapView& map) {
    OwnedWindingTree result;
    if (has_few_edges(map)) set_caps(map, result);
    ExactMapView with_tree = map;
    result.show_in(with_tree);
    result.moments = find_winding_nodes(with_tree.winding_tree, map.vertices);
    return result;
}

} // namespace echinus
