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

/// Solids divided into tetrahedra.
namespace echinus {

/// Four vertex indices a, b, c, d. A tetrahedron is *positive* if a, b, c are counter-clockwise seen from d,
/// so that the volume (b - a) x (c - a) . (d - a) / 6 is positive.
using Tetrahedron = std::array<std::uint32_t, 4>;

/// A body divided into tetrahedra that share vertices. It has no invariants; require_valid_tetrahedra() tells
/// whether all other functions accept it.
struct TetrahedralMesh {
    std::vector<Vec3f> vertices; ///< [vertex_count] positions in the caller's unit, relative to `origin`
    std::vector<Tetrahedron> tetrahedra; ///< [tetrahedron_count]
    Vec3d origin{};                      ///< as TriangleMesh::origin
};

/// Makes a body from positions in double by rounding them to float, relative to an origin if float is too
/// coarse for them.
/// @param positions  [vertex_count]
TetrahedralMesh local_body(std::span<const Vec3d> positions, std::vector<Tetrahedron> tetrahedra);

/// Checks that each tetrahedron is positive, and that two tetrahedra with a common face lie on opposite sides
/// of it. Unused vertices may have any values. Signs are exact. The time is O(n log n) for n tetrahedra.
/// @throws Error InvalidMesh when there is no tetrahedron, an index is out of range, a used vertex is not
/// finite, a tetrahedron is flat or negative, or two lie on the same side of a common face; the message
/// names the first fault
void require_valid_tetrahedra(const TetrahedralMesh& mesh);

/// The faces that belong to only one tetrahedron, outward, in the order of the tetrahedra. The vertices are
/// those of the body with the same indices, including interior ones, which no face uses. The boundary is
/// closed, and manifold unless tetrahedra of the body meet in only an edge or a vertex. The time is O(n log
/// n) for n tetrahedra.
/// @throws Error InvalidMesh when an index is out of range, or two tetrahedra lie on the same side of a face
TriangleMesh boundary(const TetrahedralMesh& mesh);

/// Makes a box around the origin from cuboids, each divided into five tetrahedra; the division is mirrored
/// from cuboid to cuboid. Vertex (i, j, k), counted along x, y and z, has the index (k * (segments[1] + 1) +
/// j) * (segments[0] + 1) + i.
/// @param segments  the number of cuboids along x, y and z, 1 to 512 each
/// @throws Error InvalidOptions
TetrahedralMesh make_solid_box(const Vec3d& size, const std::array<std::uint32_t, 3>& segments);

// ---- From a closed surface to tetrahedra ----

struct TetrahedralizeOptions {
    /// The edge length of the lattice's cubes in the model's unit. The longest interior edges have this
    /// length; at the boundary some edges are 1.5 times as long. Parts thinner than this length are lost or
    /// torn. Either this or `count` is positive, and the other is 0.
    double size = 0;
    /// The target number of tetrahedra. The size is found by trial, so that the number is met to within 5 %
    /// if the model allows it; each trial takes as long as a call with a size.
    std::size_t count = 0;
    /// The largest number of tetrahedra; more are rejected. Making a million of them takes 150 MB, and the
    /// lattice in the model's box takes 1.2 bytes per vertex; a lattice of more than kMaxLatticeVertices is
    /// rejected, too.
    std::size_t most_tetrahedra = 10'000'000;
    unsigned thread_count = 0; ///< 0: all cores. The result does not depend on it.
    /// Called with the completed share, from one thread at a time; each trial starts again at 0. It may throw
    /// to stop.
    std::function<void(double share)> progress = nullptr;

    static constexpr std::size_t kMaxLatticeVertices = std::size_t{1} << 28U;
};

/// The result of tetrahedralize().
struct Tetrahedralization {
    TetrahedralMesh mesh; ///< valid; every vertex is used
    double size = 0;      ///< the size with which the lattice was made
    /// Number of tetrahedra left out because parts of the body would have met in only an edge or a vertex.
    std::size_t removed_tetrahedra = 0;
};

/// Fills the inside of an exact map with tetrahedra, by isosurface stuffing on a uniform lattice
/// (Labelle and Shewchuk 2007, "Isosurface Stuffing: Fast Tetrahedral Meshes with Good Dihedral Angles").
///
/// All tetrahedra are positive. Their dihedral angles depend only on which vertices of the lattice are inside
/// and where its edges are cut; the extremes over all cases, and so for every model, are 9.3 and 161.7
/// degrees (docs/tetrahedra.md). The boundary is closed, manifold and does not intersect itself. Its vertices
/// lie on the model's surface, up to rounding and two lattice steps of the map, except for vertices at which
/// tetrahedra were removed. Between the vertices it may deviate by about half a size where the model has
/// edges or features finer than the lattice; parts that are closer together than a size may merge. The volume
/// is therefore usually less than the model's, by a share that decreases with the square of the size once all
/// parts are thicker than a size (docs/tetrahedra.md): compare TetrahedralReport::volume.
///
/// For an open model the generalised winding number decides what is inside (exact_map.hpp). The vertices are
/// numbered along the model's longest axis. A million tetrahedra take about 1.5 s on one core; with a count,
/// this includes all trials.
/// @throws Error InvalidOptions when not exactly one of size and count is positive, or a size is not finite,
/// is smaller than 1/4096 of the model's largest coordinate (float is too coarse for it), or would take more
/// tetrahedra or lattice vertices than allowed; InvalidMesh when no tetrahedron of that size fits into the
/// model, or no size gives about that count
Tetrahedralization tetrahedralize(const ExactMapView& model, const TetrahedralizeOptions& options);

// ---- Quality ----

struct TetrahedralReport {
    std::size_t tetrahedron_count = 0;
    std::size_t vertex_count = 0; ///< number of used vertices
    double volume = 0;            ///< the total volume, in cubic units
    double least_volume = 0;      ///< the volume of the smallest tetrahedron
    double shortest_edge = 0, longest_edge = 0;
    double least_angle_deg = 0, greatest_angle_deg = 0; ///< angles between two faces of a tetrahedron
    MeshReport boundary;                                ///< the report of inspect() on boundary()
};

/// Examines a body of n tetrahedra in O(n log n) time.
/// @throws Error InvalidMesh as require_valid_tetrahedra() does
TetrahedralReport inspect_tetrahedra(const TetrahedralMesh& mesh);

/// The distances between the boundary of a body and the surface of a model, at samples on both: the corners
/// of their faces, and points between them with a spacing of at most the mean edge length of the boundary.
struct BoundaryDistance {
    double mean_to_model = 0, greatest_to_model = 0; ///< distances from the boundary to the model's surface
    double mean_to_boundary = 0,
           greatest_to_boundary = 0; ///< distances from the model's surface to the boundary
};

/// Measures the distances of BoundaryDistance.
/// @param thread_count  0: all cores; the result does not depend on it
/// @throws Error InvalidMesh as require_valid_tetrahedra() does
BoundaryDistance measure_distance(const TetrahedralMesh& mesh, const ExactMapView& model,
                                  unsigned thread_count = 0);

// ---- Embedding of a finer mesh ----

/// The position of a point relative to a body, in barycentric coordinates: weights of the corners of one
/// tetrahedron, which sum to 1. Outside the tetrahedron some weights are negative.
struct EmbeddedPoint {
    std::uint32_t tetrahedron = 0;
    Tetrahedron vertices{}; ///< the tetrahedron's corners
    std::array<float, 4> weights{};
};
using Embedding = std::vector<EmbeddedPoint>;

/// Finds for each point the tetrahedron that contains it, or else the nearest one, and the point's weights
/// there. If several tetrahedra are equally near, the one with the smallest index is chosen. Each point takes
/// O(log t) time in a body of t well-shaped tetrahedra.
/// @param points  [n] finite
/// @returns [n]
/// @throws Error InvalidMesh as require_valid_tetrahedra() does, or when a point is not finite
Embedding embed(const TetrahedralMesh& mesh, StridedSpan<const Vec3f> points, unsigned thread_count = 0);

/// Computes the positions of the points after the body's vertices have moved. An affine motion of the body
/// moves all points by the same motion, up to rounding. Since weights are floats, the rounding error of a
/// point is k times as large if its distance from its tetrahedron is k times the tetrahedron's height. The
/// function does not allocate.
/// @param positions  [vertex_count] the moved vertices of the body
/// @param points     [embedding.size()] out. Must not overlap positions
/// @pre the embedding was made with a body of the same number of vertices; points.size() == embedding.size()
void carry(const Embedding& embedding, StridedSpan<const Vec3f> positions, StridedSpan<Vec3f> points,
           unsigned thread_count = 1) noexcept;

/// Elastic material between four particles: stable Neo-Hookean (Macklin and Mueller 2021). make_soft_body()
/// makes such elements (soft_body.hpp). Units are those of the given masses, lengths and times: with
/// kilograms and metres, mu and lambda are in pascals.
struct ElasticTetrahedron {
    std::array<std::uint32_t, 4> particles; ///< (a, b, c, d)
    /// The gradients of the barycentric coordinates of b, c and d at rest, per length: the rows of the
    /// inverse of the matrix with the columns b - a, c - a and d - a.
    std::array<Vec3f, 3> gradients;
    float volume;     ///< the volume at rest; positive
    float mu, lambda; ///< the Lame parameters: mass / (length s^2); mu positive, lambda not negative
    /// Viscosity divided by mu, seconds: a strain rate adds the stress of the strain that it would reach in
    /// this time.
    float damping;
};

} // namespace echinus

ECHINUS_EXPORT_END
