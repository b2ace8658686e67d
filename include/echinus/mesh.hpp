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

/// A triangle soup with shared vertices, the input of every map. It has no invariants; inspect() reports its
/// properties.
struct TriangleMesh {
    std::vector<Vec3f> vertices; ///< [vertex_count] positions in the caller's unit, relative to `origin`
    std::vector<Triangle> faces; ///< [face_count]
    /// Where the vertices' frame begins in that of the file. 0, unless the mesh is so far from the file's
    /// origin that floats could not hold its shape (docs/conventions.md, "Large coordinates"). All functions
    /// that take or return positions of this mesh, or of a map of it, mean positions relative to it:
    /// to_local() makes them.
    Vec3d origin{};
};

/// A mesh of positions in double, rounded to float. Where float is too coarse for them, relative to an
/// origin.
/// @param positions  [vertex_count]
TriangleMesh local_mesh(std::span<const Vec3d> positions, std::vector<Triangle> faces);

/// How often a fault occurs, and the first few faces at which it does.
struct Fault {
    static constexpr std::size_t kFirstFaceCount = 8;

    std::size_t count = 0;
    std::vector<std::uint32_t> first_faces; ///< at most kFirstFaceCount, ascending, each once
};

/// The properties of a mesh. An *edge* is an unordered pair of vertices; a face with two equal corners has
/// none. Vertices are distinguished by index, except on seams: vertices of edges that are not balanced count
/// as one where they are no farther apart than 2^-21 R (R: radius of the bounding sphere), a quarter of a
/// lattice step. So they do for all maps, whose queries therefore agree with `closed`.
struct MeshReport {
    std::size_t face_count = 0;
    std::size_t vertex_count = 0;
    std::size_t component_count = 0; ///< sets of faces joined by shared vertices
    bool closed = false;     ///< every edge is balanced: equally many faces run along it in each direction
    bool manifold = false;   ///< every edge has at most two faces and the faces at each vertex form one fan
    bool orientable = false; ///< faces can be turned so that all edges with two faces are balanced; a Moebius
                             ///< strip's cannot
    Fault border_edges;      ///< edges with one face
    Fault nonmanifold_edges; ///< edges with more than two faces
    Fault misoriented_edges; ///< edges with two faces that run along them the same way
    Fault duplicate_faces;   ///< faces with the same three vertices, in any order, as an earlier face
    Fault degenerate_faces;  ///< faces with two equal corners or with area zero
    double signed_volume = 0; ///< positive where faces turn outwards; of limited meaning when not closed
    Sphere bounding_sphere;   ///< the smallest that encloses all vertices used by faces
    /// The step of float at the largest coordinate, in the file's frame, where all coordinates are floats and
    /// half of this step exceeds a step of a map's lattice, R / 2^19; otherwise 0. If the coordinates were
    /// rounded before they came here, the shape is off by up to half the step, and so are points that come as
    /// floats in that frame.
    double rounding_step = 0;
};

/// Examines a mesh. Time O(n log n).
/// @throws Error InvalidMesh when there is no face, an index is out of range, or a used vertex is not finite;
/// the sentence names the first such face.
MeshReport inspect(const TriangleMesh& mesh);

/// Throws what inspect() would throw, and does nothing else.
void require_valid(const TriangleMesh& mesh);

/// The smallest sphere that encloses all points, up to the rounding of double; every point lies inside or on
/// it.
/// @pre points are finite. No points give a sphere of radius 0 at the origin.
Sphere smallest_enclosing_sphere(std::span<const Vec3f> points);

/// The steps that repair() may take. All off by default: a mesh is never changed without request. Those of
/// all() need no guess. The others make open surfaces and assemblies solid, in ways that are right for some
/// meshes and not for others.
///
/// None opens a closed mesh.
struct RepairOptions {
    /// Drops duplicate faces. Faces with the same three vertices and opposite orientations cancel in pairs;
    /// the first of the remaining ones, which turn the same way, stays. Where that would leave an edge less
    /// balanced, all remaining ones stay; where just the first face of all closes a hole, that one does.
    /// Nothing is dropped where no face would be left.
    bool drop_duplicate_faces = false;
    /// Where two pairs of faces fill the same quadrilateral of four edges, each along its own diagonal, and
    /// edges are balanced better without one of them, drops that pair; the later one where both are as good.
    /// The caps of glmark2's horse are of this kind. Two solids that touch there keep both.
    bool drop_doubled_patches = false;
    /// Reverses every closed component with a negative signed volume that does not lie in another closed one,
    /// together with the closed components in it: cavities stay cavities. Here parts that touch in vertices
    /// or edges only are components of their own.
    bool flip_inside_out = false;
    /// Closes seams: joins vertices of edges that are not balanced where they are no farther apart than
    /// weld_distance, drops faces that have two equal corners then, and fills holes that are no wider, such
    /// as those along an edge that only the faces on its other side divide. Nothing is joined where no face
    /// would be left.
    bool close_seams = false;
    /// In the mesh's unit, at most R, the radius of the bounding sphere; at least 2^-21 R counts, within
    /// which maps do the same: 4.8e-7 R, a quarter of their lattice's step.
    double weld_distance = 0;
    /// Drops faces without area at edges that are not balanced, unless they fill a seam: three corners on one
    /// line, as far as float tells.
    bool drop_loose_slivers = false;
    /// Turns faces so that neighbours agree, as most of them do, in every patch, faces joined by edges with
    /// exactly two faces, that is closed without the rest of the mesh. Blocks that share an edge are such
    /// patches; a block that shares a side, or all edges of one, is not, as turning it takes a guess. The
    /// outcome may be inside out without flip_inside_out.
    bool orient_faces = false;

    /// Fills holes whose border has at most so many edges, up to kMaxHoleEdges; 0 leaves them. A hole is a
    /// loop of edges along which more faces run one way than the other. It gets the triangles of least area
    /// (Barequet and Sharir 1995), which run as the faces around it do and use its vertices only. A border
    /// whose filling has more than a third of the area of its component is not a hole but the rim of a sheet,
    /// and is left. Loops that touch at a vertex are parted there. If no hole is left, the mesh is closed.
    std::uint32_t max_hole_edges = 0;
    /// Drops faces that have the solid on both sides, such as an engine in the body of a car: what is inside
    /// (winding number beyond 1/2 either way) is looked at on both sides of four places of each face. Only
    /// whole patches of neighbours go, and only where no edge that stays is less balanced for it: so a part
    /// that crosses the surface stays, and a closed mesh stays closed. Where all the same something changed
    /// from inside to outside or back beside the faces that stay, only closed patches go, or none. Walls
    /// thinner than 2^-15 R count as none.
    bool drop_inner_faces = false;
    /// Makes a solid of this thickness, in the mesh's unit, of every component that is not closed: its
    /// surface moves forwards by half of it, a copy backwards, and walls along its rims join the two. Edges
    /// with two faces that disagree about the outside, or with more than two faces, are rims of each of
    /// them. The result is closed. Where a surface bends more sharply than it is thick, the solid crosses
    /// itself. At least 2^-15 R and 16 times what float resolves, and at most R, the radius of the bounding
    /// sphere; 0 leaves sheets.
    double sheet_thickness = 0;

    static constexpr std::uint32_t kMaxHoleEdges = 256;

    /// All that need no guess.
    static constexpr RepairOptions all() {
        RepairOptions options;
        options.drop_duplicate_faces = options.drop_doubled_patches = options.flip_inside_out = true;
        options.close_seams = options.drop_loose_slivers = options.orient_faces = true;
        return options;
    }
};

/// The work of repair(); face numbers of the input mesh, ascending. Faces that close holes have the numbers
/// after those.
struct RepairReport {
    std::vector<std::uint32_t> duplicate_faces_dropped;
    std::vector<std::uint32_t> doubled_patch_faces_dropped;
    std::size_t components_flipped = 0;
    std::size_t holes_closed = 0;
    std::size_t holes_left = 0; ///< with more edges, or rims of sheets; 0 unless holes were to be closed
    std::vector<std::uint32_t> inner_faces_dropped;
    std::size_t sheets_thickened = 0;           ///< pieces of surface between rims
    std::size_t faces_added = 0;                ///< to fill seams, to close holes and to thicken sheets
    std::size_t vertices_welded = 0;            ///< in whose place faces refer to others now
    std::vector<std::uint32_t> slivers_dropped; ///< loose ones, and faces that lost their area by welding
    std::size_t faces_turned = 0;               ///< so that neighbours agree
    std::size_t seams_filled = 0;               ///< holes without width

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

/// A repaired copy. Does only what the options name, and reports every change, in this order: seams that are
/// welded, duplicate faces, doubled patches, slivers, orientation, seams that are filled, these five again as
/// long as there are any, holes, what is inside out, inner faces, sheets. Faces keep their order, new ones
/// come after them. Vertices stay unchanged but for those of sheets that are thickened; faces may no longer
/// use some. Vertices are distinguished by index: weld() first, or close seams, where equal positions mean
/// the same vertex. The same mesh and options give the same bytes on every machine.
///
/// Time O(n log n). flip_inside_out adds O(components^2) comparisons of boxes and, where boxes contain each
/// other, winding numbers; max_hole_edges O(border edges * max_hole_edges^2), at most 0.2 ms a border edge;
/// drop_inner_faces one to three exact maps and up to ten queries a face, on one core.
/// @throws Error InvalidMesh as inspect() does, or when a thickened sheet leaves the range of float; with
/// drop_inner_faces as ExactMap::build() does; InvalidOptions for values beyond the stated ranges
RepairedMesh repair(const TriangleMesh& mesh, const RepairOptions& options);

/// Joins vertices at equal positions (0 and -0 are equal), then drops vertices that no face uses. Keeps the
/// order of the faces and of the remaining vertices. A NaN equals only a NaN of the same bits. Time O(n log
/// n).
/// @throws Error InvalidMesh when an index is out of range
TriangleMesh weld(const TriangleMesh& mesh);

/// Generalised winding number of a point: the solid angle of all faces over 4 pi (Jacobson et al. 2013). 1
/// inside a closed, outward mesh, 0 outside; between them on the surface; NaN for a point that is not finite.
/// Brute force over all faces and independent of every map: a reference for tests, not a query.
/// @pre indices are in range
double winding_number(const TriangleMesh& mesh, const Vec3d& point);

/// Distance from a point to the nearest point of the surface, brute force over all faces: a reference for
/// tests, not a query. Infinity when there are no faces or the point is not finite.
/// @pre indices are in range
double unsigned_distance(const TriangleMesh& mesh, const Vec3d& point);

// ---- Generators ----
//
// Closed, outward, centred at the origin; the same bits on every machine. Lengths must be finite and
// positive, as float too.

/// Generators refuse more faces than this as InvalidOptions.
inline constexpr std::uint32_t kMaxGeneratedFaceCount = 1U << 27U;

/// A torus about the z axis; the paper's has 60 x 24 segments, which makes 2880 faces.
/// @throws Error InvalidOptions unless 0 < minor_radius < major_radius and both counts are at least 3
TriangleMesh make_torus(double major_radius, double minor_radius, std::uint32_t major_segments,
                        std::uint32_t minor_segments);

/// A sphere of meridians and parallels with its poles on the z axis; all vertices lie on the sphere.
/// @throws Error InvalidOptions unless radius > 0, meridian_count >= 3 and parallel_count >= 2 (rows of
/// faces)
TriangleMesh make_sphere(double radius, std::uint32_t meridian_count, std::uint32_t parallel_count);

/// A box of the given edge lengths, each side cut into segments x segments squares of two faces.
/// @throws Error InvalidOptions unless all lengths are positive and segments >= 1
TriangleMesh make_box(const Vec3d& size, std::uint32_t segments = 1);

} // namespace echinus

ECHINUS_EXPORT_END
