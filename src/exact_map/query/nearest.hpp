#pragma once

#include "directions/lattice.hpp"
#include "exact_map/query/place_in_bands.hpp"

#include <echinus/contact.hpp>
#include <echinus/exact_map_view.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>

namespace echinus {

/// How far something is from each child of a node; larger than any bound where there is no child.
using ChildDistances = std::array<float, TreeNode::kWidth>;

/// The faces of a leaf, half open.
struct LeafFaces {
    std::uint32_t first, last;
};

/// Pushes onto a stack whose entries from `sorted` on are sorted, the nearest on top, and keeps them so.
template <typename Entry>
void push_sorted(Entry* stack, std::size_t sorted, std::size_t& count, const Entry& entry) {
    std::size_t place = count++;
    for (; place > sorted && stack[place - 1].distance < entry.distance; --place)
        stack[place] = stack[place - 1];
    stack[place] = entry;
}

/// Branch and bound: calls visit(LeafFaces) for the leaves that are not beyond `bound`, near ones first.
/// Stops when what is left lies beyond the bound, which `visit` may lower.
/// @param measure  ChildDistances measure(node): lower bounds of the distance in any unit
template <typename Measure, typename Visit>
void walk_near_leaves(const ExactMapView& map, const float& bound, const Measure& measure,
                      const Visit& visit) {
    struct Waiting {
        std::uint32_t child;
        float distance;
    };
    // validate() and the builder keep trees to this depth; at each level all children but one may wait.
    constexpr std::size_t kMaxDepth = 12;
    std::array<Waiting, kMaxDepth * TreeNode::kWidth> waiting;
    std::size_t count = 0;
    waiting[count++] = {0, 0};
    while (count > 0) {
        const Waiting next = waiting[--count];
        if (next.distance > bound) continue;
        if ((next.child & TreeNode::kLeaf) != 0) {
            const std::uint32_t first =
                (next.child - TreeNode::kLeaf) * static_cast<std::uint32_t>(TreeNode::kWidth);
            visit(LeafFaces{first, std::min(first + static_cast<std::uint32_t>(TreeNode::kWidth),
                                            static_cast<std::uint32_t>(map.face_count()))});
            continue;
        }
        const TreeNode& node = map.nodes[next.child];
        const ChildDistances distances = measure(node);
        const std::size_t before = count;
        for (std::size_t k = 0; k < TreeNode::kWidth; ++k) {
            if (distances[k] <= bound)
                push_sorted(waiting.data(), before, count, Waiting{node.children[k], distances[k]});
        }
    }
}

// Nearest points of an exact map's surface. Places are in lattice steps from the centre, and distances those
// of space stretched along the axes (see contact()).

struct NearestPoint {
    Vec3d point;
    double distance = 0; ///< of the stretched
    std::uint32_t face = 0;
    Feature feature = Feature::Unknown;
};

/// Is a place clear of the lattice? The farther it is, the less squared distances to different faces differ,
/// and the search compares them in another form.
inline constexpr double kAfar = 1.25 * static_cast<double>(kLatticeExtent);
inline bool is_afar(const Vec3d& place) {
    return std::max({std::fabs(place.x), std::fabs(place.y), std::fabs(place.z)}) >= kAfar;
}

/// Where a place is so far that the distances to the faces, rounded to double, no longer differ, the place
/// from which the nearest face and its nearest point are found instead: on its ray from the centre, and so
/// far that both are the same but for a sixteenth of a lattice step, stretched.
inline Vec3d brought_within_reach(const Vec3d& place, const Vec3d& stretch = {1, 1, 1}) {
    constexpr double kReach = 0x1p44;
    const double largest = std::max(
        {std::fabs(place.x * stretch.x), std::fabs(place.y * stretch.y), std::fabs(place.z * stretch.z)});
    return largest > kReach ? place * (kReach / largest) : place;
}

/// The nearest face of the whole surface, if it is at most `farthest` away: a branch and bound search of the
/// face tree, so that the minimum is global. Of faces that are equally near, the first.
std::optional<std::uint32_t> nearest_face(const ExactMapView& map, const Vec3d& place, const Vec3d& stretch,
                                          double farthest) noexcept;

/// The nearest point of one face.
NearestPoint nearest_point_on_face(const ExactMapView& map, std::uint32_t face, const Vec3d& place,
                                   const Vec3d& stretch) noexcept;

/// The squared distance by which nearest_face() compares faces.
double distance_sq_to_face(const ExactMapView& map, std::uint32_t face, const Vec3d& place,
                           const Vec3d& stretch) noexcept;

/// Unit normal of the stretched surface at its nearest point: the sum of the normals of the faces within
/// `reach` lattice steps of it, each weighed by the angle that the face spans there (a full turn inside a
/// face, half a turn on its edge). Baerentzen and Aanaes 2005. Where they cancel, as on a plate without
/// thickness, that of the nearest face; 0, 0, 1 where that has no area.
Vec3f pseudonormal(const ExactMapView& map, const NearestPoint& nearest, const Vec3d& stretch,
                   double reach) noexcept;

// nearest_face() for many places.

struct NearestSearch {
    Vec3d place;                       ///< in lattice steps
    double farthest;                   ///< as nearest_face() takes it
    std::uint32_t near_leaf = kNoLeaf; ///< leaf_near(), or not yet known
};

inline constexpr std::uint32_t kNoFace = UINT32_MAX;

/// The nearest face of a place, or kNoFace; the same as that of nearest_face(), whatever the instruction set.
/// It needs no places near each other: a node's boxes and a leaf's faces are the lanes.
/// @param search  finite
std::uint32_t find_nearest_face(const ExactMapView& map, const Vec3d& stretch,
                                const NearestSearch& search) noexcept;

/// The nearest face of each place, or kNoFace; the same as that of nearest_face(), whatever the instruction
/// set.
///
/// As many places as there are lanes go down the tree together. A filter in single precision leaves each of
/// them few faces, mostly one; among several the distances of the reference decide.
/// @param searches  places near each other should follow each other; finite
/// @pre searches.size() == faces.size()
void find_nearest_faces(const ExactMapView& map, const Vec3d& stretch,
                        std::span<const NearestSearch> searches, std::span<std::uint32_t> faces) noexcept;

} // namespace echinus
