#pragma once

#include <echinus/export.hpp>
#include <echinus/geometry.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

ECHINUS_EXPORT_BEGIN

/// The arrays of an exact map (exact_map.hpp), for programs that inspect or store maps. Programs that only
/// query maps need nothing from this header.
namespace echinus {

/// The rule by which the winding number of the surface around a point decides whether the point is inside.
/// The rules differ only if parts of the surface overlap, or are nested, inverted or doubled.
enum class InsideRule : std::uint8_t {
    /// Points with any winding number except 0 are inside: the union of parts that have the same orientation
    /// or do not overlap. Where parts of opposite orientation overlap, their numbers cancel.
    Nonzero,
    Parity, ///< points with an odd winding number are inside: a part within a part is a hole
};

/// Indices, in 16 bits if all of them fit. At most one of the two spans is used.
struct IndexArray {
    std::span<const std::uint16_t> narrow;
    std::span<const std::uint32_t> wide;

    std::size_t size() const { return narrow.size() + wide.size(); }
    std::size_t size_bytes() const { return narrow.size_bytes() + wide.size_bytes(); }
    std::uint32_t operator[](std::size_t i) const { return wide.empty() ? narrow[i] : wide[i]; }
};

/// A radial interval of one cell that contains surface, [lower, upper), in units of ExactMapView::kBandUnit
/// lattice steps of the L1 norm |x| + |y| + |z|.
struct Band {
    std::uint16_t lower, upper;
    /// The band's faces are references[first_reference] up to the first one of the next band.
    std::uint32_t first_reference;
};
static_assert(sizeof(Band) == 8);

/// Boxes around the faces of up to eight subtrees: a node of an eight-wide tree, so that all eight boxes are
/// compared at once.
struct TreeNode {
    static constexpr std::size_t kWidth = 8;
    static constexpr std::uint32_t kLeaf = 0x8000'0000;

    /// The corners of the boxes, in units of ExactMapView::kBoxUnit lattice steps, rounded outwards. A child
    /// that does not exist has low > high.
    std::int16_t low[3][kWidth], high[3][kWidth];
    /// The index of a node, or kLeaf + g for a leaf g, which holds up to kWidth faces from kWidth * g on.
    std::uint32_t children[kWidth];
};
static_assert(sizeof(TreeNode) == 128);

/// A border edge of the surface: `multiplicity` more faces traverse it from a to b than from b to a.
struct BorderEdge {
    std::uint32_t a, b; ///< vertex indices
    std::int32_t multiplicity;
};
static_assert(sizeof(BorderEdge) == 12);

/// Triangles in a tree, for the winding number of an open surface (src/exact_map/layout.hpp).
struct WindingTree;

/// A map as plain arrays, wherever they are stored; the argument of all queries. It owns nothing and is cheap
/// to copy. validate() in src/exact_map checks the invariants of untrusted bytes and of built maps.
struct ExactMapView {
    static constexpr int kBandUnit = 16;
    static constexpr int kBoxUnit = 32;
    /// Stored instead of a gap's winding number if the number is not constant in the gap, because the surface
    /// is open.
    static constexpr std::int16_t kUncertain = std::numeric_limits<std::int16_t>::min();
    /// Stored instead of a gap's winding number if there is no gap, because a long band was split in two. For
    /// a particle in the lower half, the crossings between the origin and the particle are counted; for one
    /// in the upper half, the crossings beyond the particle.
    static constexpr std::int16_t kSplit = kUncertain + 1;

    Vec3f centre;     ///< C, local
    float radius = 0; ///< R: every vertex of the mesh lies within R of C
    std::uint32_t divisions = 0;
    InsideRule rule = InsideRule::Nonzero;
    std::span<const std::uint32_t> band_offsets; ///< [cell_count + 1]
    /// [cell_count] The upper limit of each cell's last band, or 0 without a band. Most particles lie beyond
    /// it, and their query ends there.
    std::span<const std::uint16_t> outer_limits;
    /// [band_count + 1] The bands by cell, then outwards; the last one is a sentinel. A band without faces
    /// separates two gaps of an open surface.
    std::span<const Band> bands;
    /// [band_count] The winding number of the gap between a band and the one below it, or kUncertain or
    /// kSplit. Beyond a cell's last band it is 0 and not stored.
    std::span<const std::int16_t> winding_below;
    IndexArray references; ///< [reference_count] the faces of the bands
    /// [reference_count] The parts of its cell that a face touches, one bit for each of the 16 parts
    /// (src/directions/octahedral_cells.hpp). A query tests only the faces of its own part.
    std::span<const std::uint16_t> reference_parts;
    /// [vertex_count] The vertices on the lattice. Four bytes before the first one are readable, so that a
    /// vector of four numbers can load any vertex as its last three.
    std::span<const Vec3<std::int32_t>> vertices;
    IndexArray corners;                 ///< [3 face_count] vertices of each face
    IndexArray face_numbers;            ///< [face_count] each face's index in the mesh
    std::span<const TreeNode> nodes;    ///< the tree over the faces; its root is the first node
    std::span<const BorderEdge> border; ///< the border edges; empty for a closed surface
    /// The tree for the winding number of an open surface; null for a closed one. Map files do not store the
    /// tree, since it follows from the other arrays.
    const WindingTree* winding_tree = nullptr;
    Vec3d origin{}; ///< TriangleMesh::origin: the origin of the local frame. Queries ignore it

    std::size_t cell_count() const { return std::size_t{8} * divisions * divisions; }
    std::size_t face_count() const { return face_numbers.size(); }
    /// The size of all arrays that queries read, including mesh and tree.
    std::size_t byte_count() const;
};

} // namespace echinus

ECHINUS_EXPORT_END
