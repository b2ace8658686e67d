#pragma once

#include <echinus/export.hpp>
#include <echinus/geometry.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

ECHINUS_EXPORT_BEGIN

namespace echinus {

/// Three vertex indices, counter-clockwise seen from outside.
using Triangle = std::array<std::uint32_t, 3>;

/// Triangles that share vertices by index, from which every map is built. A mesh has no invariants; inspect()
/// reports its properties.
struct TriangleMesh {
    std::vector<Vec3f> vertices; ///< [vertex_count] positions in the caller's unit, relative to `origin`
    std::vector<Triangle> faces; ///< [face_count]
    /// The origin of the vertices' frame in the frame of the file. It is 0, unless the mesh is so far from
    /// the file's origin that floats could not represent its shape (docs/conventions.md, "Large
    /// coordinates"). All functions that take or return positions of this mesh, or of a map of it, use
    /// positions relative to this origin; to_local() converts to them.
    Vec3d origin{};
};

/// Makes a mesh from positions in double by rounding them to float, relative to an origin if float is too
/// coarse for them.
/// @param positions  [vertex_count]
TriangleMesh local_mesh(std::span<const Vec3d> positions, std::vector<Triangle> faces);

/// The number of occurrences of a fault, and the first few faces at which it occurs.
struct Fault {
    static constexpr std::size_t kFirstFaceCount = 8;

    std::size_t count = 0;
    std::vector<std::uint32_t> first_faces; ///< their indices: at most kFirstFaceCount, ascending, each once
};

/// The properties of a mesh. An *edge* is an unordered pair of vertices; a face with two equal corners has
/// none. Vertices are distinguished by index, except on seams: vertices of unbalanced edges count as one
/// if they are at most 2^-21 R apart (R is the radius of the bounding sphere), a quarter of a lattice
/// step. All maps treat vertices in the same way, so their queries agree with `closed`.
struct MeshReport {
    std::size_t face_count = 0;
    std::size_t vertex_count = 0;
    std::size_t component_count = 0; ///< sets of faces joined by shared vertices
    bool closed = false; ///< every edge is balanced: the same number of faces traverse it in either direction
    bool manifold = false;    ///< every edge has at most two faces and the faces at each vertex form one fan
    bool orientable = false;  ///< faces can be flipped so that all edges with two faces are balanced
    Fault border_edges;       ///< edges with one face
    Fault nonmanifold_edges;  ///< edges with more than two faces
    Fault misoriented_edges;  ///< edges with two faces that traverse them in the same direction
    Fault duplicate_faces;    ///< faces with the same three vertices, in any order, as an earlier face
    Fault degenerate_faces;   ///< faces with two equal corners or with area zero
    double signed_volume = 0; ///< positive if faces point outwards; of limited meaning if the mesh is open
    Sphere bounding_sphere;   ///< the smallest sphere that encloses all vertices used by faces
    /// The spacing of floats at the largest coordinate, in the file's frame, if all coordinates are floats
    /// and half of this spacing exceeds a step of a map's lattice, R / 2^19; otherwise 0. If the coordinates
    /// have been rounded to float, the shape is wrong by up to half the spacing, and so are points given as
    /// floats in that frame.
    double rounding_step = 0;
};

/// Examines a mesh of n faces in O(n log n) time.
/// @throws Error InvalidMesh when there is no face, an index is out of range, or a used vertex is not
/// finite; the message names the first such face.
MeshReport inspect(const TriangleMesh& mesh);

/// Throws what inspect() would throw, and does nothing else.
void require_valid(const TriangleMesh& mesh);

/// The smallest sphere that encloses all points, up to the rounding of double. Every point lies inside or on
/// it. Without points it is a sphere of radius 0 at the origin.
/// @pre points are finite
Sphere smallest_enclosing_sphere(std::span<const Vec3f> points);

/// The repairs that repair() may make. All are off by default, so a mesh is changed only on request. The
/// repairs that all() enables require no guesswork. The others make open surfaces and assemblies solid, by
/// methods that suit some meshes and not others.
///
/// No repair opens a closed mesh.
struct RepairOptions {
    /// Drops duplicate faces. Faces with the same three vertices and opposite orientations cancel in
    /// pairs; the first of the remaining ones, which have the same orientation, stays. If dropping the others
    /// would leave an edge less balanced, all remaining ones stay; if only the first face of all closes a
    /// hole, that one stays. Nothing is dropped if no face would be left.
    bool drop_duplicate_faces = false;
    /// If two pairs of faces fill the same quadrilateral of four edges, each along its own diagonal, and
    /// edges are better balanced without one of the pairs, drops that pair, or the later pair if both are
    /// equally good. The caps of glmark2's horse are of this kind. Two solids that touch there keep both
    /// pairs.
    bool drop_doubled_patches = false;
    /// Reverses every closed component with a negative signed volume that does not lie inside another closed
    /// one, together with the closed components inside it, so that cavities stay cavities. Parts that touch
    /// only in vertices or edges count as separate components here.
    bool flip_inside_out = false;
    /// Closes seams: joins vertices of unbalanced edges that are at most weld_distance apart, drops faces
    /// that then have two equal corners, and fills holes that are at most as wide, such as the holes along an
    /// edge that is subdivided only by the faces on one side. Nothing is joined if no face would be left.
    bool close_seams = false;
    /// The width of seams in the mesh's unit, at most R, the radius of the bounding sphere. The effective
    /// value is at least 2^-21 R = 4.8e-7 R, a quarter of a map's lattice step, within which maps join
    /// vertices anyway.
    double weld_distance = 0;
    /// Drops faces without area at unbalanced edges, unless they fill a seam: faces whose three corners are
    /// collinear up to the rounding of float.
    bool drop_loose_slivers = false;
    /// Flips faces so that they agree with the majority of their neighbours, in every patch that is closed by
    /// itself; a patch consists of faces joined by edges with exactly two faces. Blocks that share only an
    /// edge are closed patches. A block that shares a side with another block, or all edges of a side, is
    /// not: its orientation would be a guess. The result may be inside out without flip_inside_out.
    bool orient_faces = false;

    /// Fills holes whose border has at most this number of edges, up to kMaxHoleEdges; 0 fills none. A hole
    /// is a loop of edges that more faces traverse in one direction than in the other. It is filled with the
    /// triangulation of least area (Barequet and Sharir 1995), which uses only its vertices and is oriented
    /// like the surrounding faces. A border whose filling has more than a third of the area of its component
    /// is not a hole but the rim of a sheet, and stays open. Loops that touch at a vertex are separated
    /// there. If no hole is left, the mesh is closed.
    std::uint32_t max_hole_edges = 0;
    /// Drops faces that have the solid on both sides, such as those of an engine in the body of a car. A
    /// point is in the solid if the absolute winding number exceeds 1/2; it is tested on both sides of four
    /// points of each face. Only whole patches of neighbours are dropped, and only if no remaining edge
    /// becomes less balanced, so a part that crosses the surface stays, and a closed mesh stays closed. If
    /// inside and outside would still change next to the remaining faces, only closed patches are dropped, or
    /// none. Walls thinner than 2^-15 R are ignored.
    bool drop_inner_faces = false;
    /// Makes a solid of this thickness, in the mesh's unit, of every open component: its surface moves
    /// forwards by half of the thickness, a copy moves backwards, and walls along its rims join the two.
    /// Edges with two faces that disagree about the outside, or with more than two faces, are rims of each of
    /// these faces. The result is closed. Where the radius of curvature is less than the thickness, the solid
    /// intersects itself. The value is at least 2^-15 R and 16 times the spacing of floats, and at most R,
    /// the radius of the bounding sphere; 0 does not thicken sheets.
    double sheet_thickness = 0;

    static constexpr std::uint32_t kMaxHoleEdges = 256;

    /// All repairs that require no guesswork.
    static constexpr RepairOptions all() {
        RepairOptions options;
        options.drop_duplicate_faces = options.drop_doubled_patches = options.flip_inside_out = true;
        options.close_seams = options.drop_loose_slivers = options.orient_faces = true;
        return options;
    }
};

/// The changes made by repair(). Faces are given by their indices in the input mesh, in ascending order;
/// faces that close holes have indices after those.
struct RepairReport {
    std::vector<std::uint32_t> duplicate_faces_dropped;
    std::vector<std::uint32_t> doubled_patch_faces_dropped;
    std::size_t components_flipped = 0;
    std::size_t holes_closed = 0;
    std::size_t holes_left = 0; ///< larger holes, or rims of sheets; 0 unless holes were to be closed
    std::vector<std::uint32_t> inner_faces_dropped;
    std::size_t sheets_thickened = 0;           ///< pieces of surface between rims
    std::size_t faces_added = 0;                ///< faces that fill seams, close holes or thicken sheets
    std::size_t vertices_welded = 0;            ///< vertices that were replaced by others in all faces
    std::vector<std::uint32_t> slivers_dropped; ///< loose slivers, and faces that lost their area by welding
    std::size_t faces_turned = 0;               ///< faces flipped so that neighbours agree
    std::size_t seams_filled = 0;               ///< filled holes of zero width

    bool changed_anything() const {
        return !duplicate_faces_dropped.empty() || !doubled_patch_faces_dropped.empty() ||
               components_flipped != 0 || holes_closed != 0 || !inner_faces_dropped.empty() ||
               sheets_thickened != 0 || vertices_welded != 0 || !slivers_dropped.empty() ||
               faces_turned != 0 || seams_filled != 0;
    }
};

struct RepairedMesh {
    TriangleMesh mesh;
    RepairReport report;
};

/// Makes a repaired copy. Makes only the repairs that the options request, and reports every change. Seams
/// are welded first. Then duplicate faces, doubled patches, slivers, orientation and the filling of seams
/// follow, repeated until nothing changes; then holes, inside-out parts, inner faces and sheets. Faces keep
/// their order, and new faces are appended. Vertices do not change, except those of thickened sheets; some
/// may become unused. Vertices are distinguished by index: call weld() first, or close seams, if vertices at
/// equal positions are meant to be one. The same mesh and options give the same bytes on every machine.
///
/// The time is O(n log n) for n faces. flip_inside_out adds O(components^2) comparisons of boxes and, where
/// boxes contain each other, winding numbers; max_hole_edges adds O(border edges * max_hole_edges^2), at most
/// 0.2 ms per border edge; drop_inner_faces adds one to three exact maps and up to ten queries per face, on
/// one core.
/// @throws Error InvalidMesh as inspect() does, or if a thickened sheet exceeds the range of float; with
/// drop_inner_faces as ExactMap::build() does; InvalidOptions for values outside the stated ranges
RepairedMesh repair(const TriangleMesh& mesh, const RepairOptions& options);

/// Joins vertices at equal positions (0 and -0 are equal), then drops unused vertices, in O(n log n) time for
/// n vertices. Faces and the remaining vertices keep their order. A NaN equals only a NaN with the same bits.
/// @throws Error InvalidMesh when an index is out of range
TriangleMesh weld(const TriangleMesh& mesh);

/// Generalised winding number of a point: the solid angle of all faces over 4 pi (Jacobson et al. 2013).
/// For a closed mesh with outward faces it is 1 inside, 0 outside, and between the two on the surface. It is
/// NaN for a point that is not finite. The function visits all faces and is independent of every map: it is a
/// reference for tests, not a query.
/// @pre indices are in range
double winding_number(const TriangleMesh& mesh, const Vec3d& point);

/// Distance from a point to the nearest point of the surface. It is infinite without faces or if the point is
/// not finite. The function visits all faces: it is a reference for tests, not a query.
/// @pre indices are in range
double unsigned_distance(const TriangleMesh& mesh, const Vec3d& point);

// ---- Generators ----
//
// Generated meshes are closed, with outward faces, centred at the origin, and bit-identical on every machine.
// Lengths must be finite and positive, even when rounded to float.

/// Generators throw InvalidOptions for more faces than this.
inline constexpr std::uint32_t kMaxGeneratedFaceCount = 1U << 27U;

/// A torus about the z axis. The paper's torus has 60 x 24 segments, which make 2880 faces.
/// @throws Error InvalidOptions unless 0 < minor_radius < major_radius and both counts are at least 3
TriangleMesh make_torus(double major_radius, double minor_radius, std::uint32_t major_segments,
                        std::uint32_t minor_segments);

/// A sphere of meridians and parallels with its poles on the z axis; all vertices lie on the sphere.
/// @throws Error InvalidOptions unless radius > 0, meridian_count >= 3 and parallel_count >= 2 (rows of
/// faces)
TriangleMesh make_sphere(double radius, std::uint32_t meridian_count, std::uint32_t parallel_count);

/// A box of the given edge lengths, with each side divided into segments x segments squares of two faces.
/// @throws Error InvalidOptions unless all lengths are positive and segments >= 1
TriangleMesh make_box(const Vec3d& size, std::uint32_t segments = 1);

} // namespace echinus

ECHINUS_EXPORT_END
