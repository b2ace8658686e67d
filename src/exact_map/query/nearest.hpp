#pragma once

#include "directions/lattice.hpp"
#include "exact_map/query/place_in_bands.hpp"
#include "mesh/faces.hpp"

#include <echinus/contact.hpp>
#include <echinus/exact_map_view.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>

namespace echinus {

/// The distance of something from each child of a node, in any unit; larger than any bound if there is no
/// such child.
using ChildDistances = std::array<float, TreeNode::kWidth>;

/// The faces of a leaf, as a half-open range.
struct LeafFaces {
    std::uint32_t first, last;
};

/// Pushes onto a stack whose entries from index `sorted` on are sorted, with the nearest on top, and keeps
/// them sorted.
template <typename Entry>
void push_sorted(Entry* stack, std::size_t sorted, std::size_t& count, const Entry& entry) {
    std::size_t place = count++;
    for (; place > sorted && stack[place - 1].distance < entry.distance; --place)
        stack[place] = stack[place - 1];
    stack[place] = entry;
}

/// Branch and bound: calls visit(LeafFaces) for the leaves that are not beyond `bound`, near ones first.
/// Stops when all remaining leaves lie beyond the bound, which `visit` may lower.
/// @param measure  ChildDistances measure(node): lower bounds of distances in any unit
template <typename Measure, typename Visit>
void walk_near_leaves(const ExactMapView& map, const float& bound, const Measure& measure,
                      const Visit& visit) {
    struct Waiting {
        std::uint32_t child;
        float distance;
    };
    // validate() and the builder limit trees to this depth; at each level all children but one may be
    // waiting.
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

// Nearest points of an exact map's surface. Places are in lattice steps relative to the centre; distances are
// those in space stretched along the axes (see contact()).

struct NearestPoint {
    Vec3d point;
    double distance = 0; ///< in stretched space
    std::uint32_t face = 0;
    Feature feature = Feature::Unknown;
};

/// Is a place well outside the lattice? The farther away it is, the less the squared distances to different
/// faces differ, so the search then compares them in another form.
inline constexpr double kAfar = 1.25 * static_cast<double>(kLatticeExtent);
inline bool is_afar(const Vec3d& place) {
    return std::max({std::fabs(place.x), std::fabs(place.y), std::fabs(place.z)}) >= kAfar;
}

/// For a place so far away that the distances to the faces no longer differ when rounded to double: the place
/// from which the nearest face and its nearest point are determined instead. It lies on the ray from the
/// centre through the original place, so far out that both results are the same within a sixteenth of a
/// lattice step, stretched. Nearer places are returned unchanged.
inline Vec3d brought_within_reach(const Vec3d& place, const Vec3d& stretch = {1, 1, 1}) {
    constexpr double kReach = 0x1p44;
    const double largest = std::max(
        {std::fabs(place.x * stretch.x), std::fabs(place.y * stretch.y), std::fabs(place.z * stretch.z)});
    return largest > kReach ? place * (kReach / largest) : place;
}

/// The nearest face of the whole surface, if it is at most `farthest` away; of equally near faces, the first.
/// A branch-and-bound search of the face tree finds the global minimum.
std::optional<std::uint32_t> nearest_face(const ExactMapView& map, const Vec3d& place, const Vec3d& stretch,
                                          double farthest) noexcept;

/// The nearest point of one face.
NearestPoint nearest_point_on_face(const ExactMapView& map, std::uint32_t face, const Vec3d& place,
                                   const Vec3d& stretch) noexcept;

/// The squared distance by which nearest_face() compares faces.
double distance_sq_to_face(const ExactMapView& map, std::uint32_t face, const Vec3d& place,
                           const Vec3d& stretch) noexcept;

/// Unit normal of the stretched surface at its nearest point: the sum of the normals of the faces within
/// `reach` lattice steps of the point, each weighted by the angle that the face spans there (2 pi inside a
/// face, pi on its edge). Baerentzen and Aanaes 2005. If the normals cancel, as on a plate without thickness,
/// the normal of the nearest face; 0, 0, 1 if that face has no area.
Vec3f pseudonormal(const ExactMapView& map, const NearestPoint& nearest, const Vec3d& stretch,
                   double reach) noexcept;

// nearest_face() for many places.

struct NearestSearch {
    Vec3d place;                       ///< in lattice steps
    double farthest;                   ///< as for nearest_face()
    std::uint32_t near_leaf = kNoLeaf; ///< leaf_near(), or kNoLeaf if not yet known
};

/// The nearest face of a place, or kNoFace. The result equals that of nearest_face() on every instruction
/// set. The lanes are the boxes of a node or the faces of a leaf, so it needs no places near each other.
/// @param search  finite
std::uint32_t find_nearest_face(const ExactMapView& map, const Vec3d& stretch,
                                const NearestSearch& search) noexcept;

/// The nearest face of each place, or kNoFace. The results equal those of nearest_face() on every instruction
/// set.
///
/// As many places as there are lanes descend the tree together. A filter in single precision leaves few faces
/// for each of them, usually one; if there are several, the distances of the reference decide.
/// @param searches  finite; places near each other should be consecutive
/// @pre searches.size() == faces.size()
void find_nearest_faces(const ExactMapView& map, const Vec3d& stretch,
                        std::span<const NearestSearch> searches, std::span<std::uint32_t> faces) noexcept;

} // namespace echinus
