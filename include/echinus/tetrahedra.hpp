#pragma once

#include <echinus/exact_map_view.hpp>
#include <echinus/export.hpp>
#include <echinus/geometry.hpp>
#include <echinus/mesh.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

ECHINUS_EXPORT_BEGIN

/// Solids cut into tetrahedra.
namespace echinus {

/// Four vertex indices a, b, c, d. *Positive*: a, b, c turn counter-clockwise seen from d, so that the volume
/// (b - a) x (c - a) . (d - a) / 6 is positive.
using Tetrahedron = std::array<std::uint32_t, 4>;

/// A body cut into tetrahedra that share vertices. It has no invariants; require_valid_tetrahedra() tells
/// whether every other function takes it.
struct TetrahedralMesh {
    std::vector<Vec3f> vertices; ///< [vertex_count] positions in the caller's unit, relative to `origin`
    std::vector<Tetrahedron> tetrahedra; ///< [tetrahedron_count]
    Vec3d origin{};                      ///< as TriangleMesh::origin
};

/// A body of positions in double, rounded to float. Where float is too coarse for them, relative to an
/// origin.
/// @param positions  [vertex_count]
TetrahedralMesh local_body(std::span<const Vec3d> positions, std::vector<Tetrahedron> tetrahedra);

/// Each tetrahedron is positive, and two that share a face lie on either side of it. Vertices that no
/// tetrahedron uses may be anything. Signs are exact. Time O(n log n).
/// @throws Error InvalidMesh when there is no tetrahedron, an index is out of range, a used vertex is not
/// finite, a tetrahedron is flat or negative, or two lie on the same side of a face of theirs; the sentence
/// names the first
void require_valid_tetrahedra(const TetrahedralMesh& mesh);

/// The faces that belong to one tetrahedron only, outward, in the order of the tetrahedra. The vertices are
/// those of the body with their numbers, also the inner ones, which no face uses. Closed; and manifold unless
/// tetrahedra of the body meet in no more than an edge or a vertex. Time O(n log n).
/// @throws Error InvalidMesh when an index is out of range, or two tetrahedra lie on the same side of a face
TriangleMesh boundary(const TetrahedralMesh& mesh);

/// A box around the origin, of cuboids cut into five tetrahedra each, turned from cuboid to cuboid. Vertex
/// (i, j, k), counted along x, y and z, has the index (k * (segments[1] + 1) + j) * (segments[0] + 1) + i.
/// @param segments  cuboids along x, y and z, 1 to 512 each
/// @throws Error InvalidOptions
TetrahedralMesh make_solid_box(const Vec3d& size, const std::array<std::uint32_t, 3>& segments);

// ---- From a closed surface to tetrahedra ----

struct TetrahedralizeOptions {
    /// The edge of the lattice's cubes, in the model's unit: the longest edges inside the body; at the
    /// boundary some are half as long again. Thinner parts are lost or torn. Either this or
    /// `count` is positive, the other 0.
    double size = 0;
    /// About so many tetrahedra: the size is found by trying, within 5 % where the model lets it; each try
    /// takes as long as one with a size.
    std::size_t count = 0;
    /// More tetrahedra are refused. A million take 150 MB while they are made, and the lattice in the model's
    /// box 1.2 bytes for each vertex, of which more than kMaxLatticeVertices are refused, too.
    std::size_t most_tetrahedra = 10'000'000;
    unsigned thread_count = 0; ///< 0: all cores. The result does not depend on it.
    /// Called with the finished share, from one thread at a time; each try begins anew at 0. May throw to
    /// stop.
    std::function<void(double share)> progress = nullptr;

    static constexpr std::size_t kMaxLatticeVertices = std::size_t{1} << 28U;
};

/// The result of tetrahedralize().
struct Tetrahedralization {
    TetrahedralMesh mesh; ///< valid; every vertex is used
    double size = 0;      ///< of the lattice
    /// Left out where parts of the body would have met in no more than an edge or a vertex.
    std::size_t removed_tetrahedra = 0;
};

/// Fills what an exact map says is inside with tetrahedra, by isosurface stuffing on a uniform lattice
/// (Labelle and Shewchuk 2007, "Isosurface Stuffing: Fast Tetrahedral Meshes with Good Dihedral Angles").
///
/// All tetrahedra are positive. Their dihedral angles depend on which vertices of the lattice are inside and
/// where its edges are cut, not on the model; the extremes that were found by trying those cases are 9.3 and
/// 161.7 degrees (docs/tetrahedra.md). The boundary is closed, manifold and does not intersect itself. Its
/// vertices lie on the model's surface, up to rounding and two lattice steps of the map, except for those
/// where tetrahedra were removed. Between them it may be off by about half a size, where the model has edges
/// or features finer than the lattice; parts that are nearer than a size to each other may join. The volume
/// therefore differs from the model's, mostly downwards, by a share that falls with the square of the size
/// once all parts are thicker than that (docs/tetrahedra.md): compare TetrahedralReport::volume.
///
/// For an open model, inside is where the generalised winding number says so (exact_map.hpp).
/// The vertices are numbered along its longest axis.
/// Time: about 1.5 s for a million tetrahedra on one core, all tries for a count included.
/// @throws Error InvalidOptions when not exactly one of size and count is positive, a size is not finite, is
/// smaller than 1/4096 of the model's largest coordinate, where float is too coarse, or would take more
/// tetrahedra or lattice vertices than allowed; InvalidMesh when no tetrahedron of that size fits into the
/// model
Tetrahedralization tetrahedralize(const ExactMapView& model, const TetrahedralizeOptions& options);

// ---- Quality ----

struct TetrahedralReport {
    std::size_t tetrahedron_count = 0;
    std::size_t vertex_count = 0; ///< that tetrahedra use
    double volume = 0;            ///< sum of all tetrahedra, in the cube of the unit
    double least_volume = 0;      ///< of one tetrahedron
    double shortest_edge = 0, longest_edge = 0;
    double least_angle_deg = 0, greatest_angle_deg = 0; ///< between two faces of a tetrahedron
    MeshReport boundary;                                ///< inspect() of boundary()
};

/// Examines a body. Time O(n log n).
/// @throws Error InvalidMesh as require_valid_tetrahedra() does
TetrahedralReport inspect_tetrahedra(const TetrahedralMesh& mesh);

/// How far the boundary of a body and the surface of a model are apart, at samples on both: the corners of
/// their faces, and points between them no farther apart than the mean edge of the boundary.
struct BoundaryDistance {
    double mean_to_model = 0, greatest_to_model = 0;       ///< from the boundary to the model's surface
    double mean_to_boundary = 0, greatest_to_boundary = 0; ///< from the model's surface to the boundary
};

/// @param thread_count  0: all cores; the result does not depend on it
/// @throws Error InvalidMesh as require_valid_tetrahedra() does
BoundaryDistance measure_distance(const TetrahedralMesh& mesh, const ExactMapView& model,
                                  unsigned thread_count = 0);

// ---- A finer mesh that goes along ----

/// Where a point lies in a body: the weights of a tetrahedron's corners, whose sum is 1. Outside of the
/// tetrahedron some are negative.
struct EmbeddedPoint {
    std::uint32_t tetrahedron = 0;
    Tetrahedron vertices{}; ///< its corners
    std::array<float, 4> weights{};
};
using Embedding = std::vector<EmbeddedPoint>;

/// Finds the tetrahedron that each point lies in, or else the nearest one, and the point's weights there. Of
/// several, the one with the smallest number. Time O(log n) for a point in a body of well-shaped tetrahedra.
/// @param points  [n] finite
/// @returns [n]
/// @throws Error InvalidMesh as require_valid_tetrahedra() does, or when a point is not finite
Embedding embed(const TetrahedralMesh& mesh, StridedSpan<const Vec3f> points, unsigned thread_count = 0);

/// Where the points are once the body's vertices have moved. An affine motion of the body moves all points by
/// the same motion, up to rounding: weights are floats, so a point that is farther from its tetrahedron than
/// that is high by a factor of k is off by k times as much. Does not allocate.
/// @param positions  [vertex_count] of the body, moved
/// @param points     [embedding.size()] out. Does not overlap positions
/// @pre the embedding was made with a body of as many vertices; points.size() == embedding.size()
void carry(const Embedding& embedding, StridedSpan<const Vec3f> positions, StridedSpan<Vec3f> points,
           unsigned thread_count = 1) noexcept;

/// Elastic material between four particles: stable Neo-Hookean (Macklin and Mueller 2021). Made by
/// make_soft_body() (soft_body.hpp). Units are those in which masses, lengths and seconds are given: with
/// kilograms and metres, mu and lambda are in pascals.
struct ElasticTetrahedron {
    std::array<std::uint32_t, 4> particles; ///< (a, b, c, d)
    /// At rest, the gradients of the barycentric coordinates of b, c and d: the rows of the inverse of the
    /// matrix with the columns b - a, c - a and d - a. Per length.
    std::array<Vec3f, 3> gradients;
    float volume;     ///< at rest; positive
    float mu, lambda; ///< the Lame parameters: mass / (length s^2); mu positive, lambda not negative
    /// Viscosity over mu, seconds: of a strain that begins, its stress grows by as much as if that strain had
    /// lasted so long.
    float damping;
};

} // namespace echinus

ECHINUS_EXPORT_END
