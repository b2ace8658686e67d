#ifndef ECHINUS_ECHINUS_H
#define ECHINUS_ECHINUS_H

#include <echinus/version.h>

#include <stddef.h>
#include <stdint.h>

/// Echinus for C99 and for languages that call C. The library is libechinus-c; docs/c.md begins with a
/// complete program.
///
/// Errors. A function that can fail returns a status, and echinus_last_error() returns a message. No
/// exception leaves a function. A function that fails sets its output handle to NULL, and changes nothing
/// else unless its declaration says so.
///
/// Null pointers. A NULL argument gives ECHINUS_INVALID_ARGUMENT, unless its declaration says "or NULL". An
/// array of 0 elements may be NULL. The functions that end in _destroy take NULL and do nothing. Functions
/// that return a value and no status return 0 or NULL for a handle that is NULL.
///
/// Ownership. The caller owns a handle that a function returns through an echinus_..._ **, and destroys it
/// once with the _destroy function of its type. A function reads const arguments only during the call, unless
/// its declaration says otherwise. A returned pointer belongs to the handle that was passed.
///
/// Threads. Meshes, maps, tetrahedra, deformables, scenes and arrays are immutable: any number of threads may
/// use one at once. A builder or a simulation may be used by one thread at a time. thread_count is the number
/// of threads that a call may use; 0 means all cores. No answer depends on it.
///
/// Strides. Points are x, y, z as float. A batch is given by the address of the first x, a count, and the
/// stride in bytes from one x to the next: a multiple of 4, at least 12; 0 means 12. Answers are written
/// contiguously and must not overlap the points.
///
/// Extensible structs begin with their size. An _init function fills options with the defaults and the size;
/// for results the caller sets .size before the call. New members will be added at the end with a default of
/// zero. So a program and a library of different versions are compatible; a call fails with
/// ECHINUS_INVALID_ARGUMENT if the program sets a member that the library does not have. Flags are 0 or 1,
/// and reserved members of options are 0; other values give ECHINUS_INVALID_ARGUMENT.
///
/// Frames, units and terms are those of docs/conventions.md: right-handed, lengths in the caller's unit,
/// angles in radians, faces counter-clockwise seen from outside, rotations as unit quaternions w, x, y, z.
/// "Local" is the frame of the mesh from which a map was built, "world" the frame in which a collider has its
/// pose.
///
/// Origins. A mesh that is so far from 0 in its file that floats could not represent its shape has an origin,
/// and so have its map and its tetrahedra: local positions are then relative to the origin, which is 0 for
/// all other meshes. echinus_to_local() converts doubles to local points. A collider's pose and scale place
/// the file's frame: world = pose (scale (origin + local)). Simulations reject an origin that is not 0.

#ifdef __cplusplus
extern "C" {
#endif

#ifndef ECHINUS_API
#if defined(_WIN32) && defined(echinus_c_EXPORTS) /* while the library is built */
#define ECHINUS_API __declspec(dllexport)
#elif defined(_WIN32)
#define ECHINUS_API __declspec(dllimport)
#elif defined(__GNUC__)
#define ECHINUS_API __attribute__((visibility("default")))
#else
#define ECHINUS_API
#endif
#endif

// ---- Errors and the library ----

/// The kinds of errors. Later versions may add values, but do not remove any.
typedef enum echinus_status {
    ECHINUS_OK = 0,
    ECHINUS_UNREADABLE = 1,          ///< a file does not exist, is a directory, or cannot be read
    ECHINUS_UNWRITABLE = 2,          ///< a file cannot be written: permission, missing folder, full disk
    ECHINUS_WRONG_FORMAT = 3,        ///< the bytes do not have the format that the name or the reader expects
    ECHINUS_DAMAGED = 4,             ///< the right format, but truncated or self-contradictory
    ECHINUS_UNSUPPORTED_VERSION = 5, ///< a map file of a version that this library does not read
    ECHINUS_INVALID_MESH = 6,        ///< no faces, a coordinate that is not finite, an index out of range
    ECHINUS_INVALID_OPTIONS = 7,     ///< an option outside the range that its declaration states
    ECHINUS_INVALID_SCENE = 8,       ///< a scene with an unknown key, a missing key or a value out of range
    ECHINUS_DIVERGED = 9,            ///< a simulation whose positions are not finite or have left all bounds
    ECHINUS_INVALID_ARGUMENT =
        100, ///< NULL, a wrong size or stride, an index out of range, a map of the wrong kind
    ECHINUS_OUT_OF_MEMORY = 101, ///< out of memory
    ECHINUS_INTERNAL = 102       ///< a bug in the library: please report it
} echinus_status;

/// The name of a status as declared above, for instance "ECHINUS_OK"; "unknown status" for any other number.
ECHINUS_API const char* echinus_status_name(echinus_status status);

/// The message of the last failed call on this thread: one sentence that names the file, face, byte or
/// argument, the value that was found and the one that was expected. It is empty if no call has failed, and
/// is kept until the next failure on this thread.
ECHINUS_API const char* echinus_last_error(void);

/// The version of the library that the program runs with, such as "0.2.0". ECHINUS_VERSION_STRING is that of
/// the header.
ECHINUS_API const char* echinus_version(void);

/// The vector instructions that batches use: "avx512", "avx2", "sse4", "neon" or "scalar". They affect speed
/// only.
ECHINUS_API const char* echinus_instruction_set(void);

/// The sets that this machine supports, by index, the widest first; NULL beyond the last.
ECHINUS_API const char* echinus_available_instruction_set(size_t number);

/// Selects a different set for the whole process, from the next query on. Any thread may call this.
ECHINUS_API echinus_status echinus_use_instruction_set(const char* name);

/// The index of a face, a particle or a collider that does not exist or is not known. All indices in arrays
/// and results are uint32_t.
#define ECHINUS_NONE UINT32_MAX

// ---- Arrays ----

/// An array whose length is determined by the library. The function that returns it documents the type of its
/// elements.
typedef struct echinus_array echinus_array;

ECHINUS_API const void* echinus_array_data(const echinus_array* array);
/// The number of elements, not of bytes.
ECHINUS_API size_t echinus_array_count(const echinus_array* array);
ECHINUS_API void echinus_array_destroy(echinus_array* array);

// ---- Meshes ----

/// Triangles with shared vertices. All indices are in range, and all coordinates that faces use are finite.
typedef struct echinus_mesh echinus_mesh;

/// Copies vertices and faces. Nothing is repaired: echinus_mesh_inspect() reports faults.
/// @param faces  [3 face_count] vertex indices, counter-clockwise seen from outside
/// @return ECHINUS_INVALID_MESH without faces, or for an index out of range or a used vertex that is not
/// finite
ECHINUS_API echinus_status echinus_mesh_create(const float* vertices, size_t vertex_count,
                                               size_t vertex_stride, const uint32_t* faces, size_t face_count,
                                               echinus_mesh** mesh);

/// Copies vertices in double and faces. If floats could not represent the shape, the mesh has an origin.
/// @param vertices  [3 vertex_count]
ECHINUS_API echinus_status echinus_mesh_create_double(const double* vertices, size_t vertex_count,
                                                      const uint32_t* faces, size_t face_count,
                                                      echinus_mesh** mesh);

/// Reads OBJ, PLY, STL, OFF, glTF, GLB or 3DS, depending on the file name's extension. All meshes of the file
/// are joined, polygons are triangulated and equal positions are welded.
/// @return ECHINUS_UNREADABLE, ECHINUS_WRONG_FORMAT, ECHINUS_DAMAGED or ECHINUS_INVALID_MESH
ECHINUS_API echinus_status echinus_mesh_read(const char* path, echinus_mesh** mesh);

/// Writes OBJ, PLY (binary), STL (binary) or OFF, depending on the file name's extension. The file is written
/// atomically.
/// @return ECHINUS_UNWRITABLE or ECHINUS_WRONG_FORMAT
ECHINUS_API echinus_status echinus_mesh_write(const echinus_mesh* mesh, const char* path);

/// Makes a torus about the z axis. It is centred at the origin, as are the next two shapes.
/// @return ECHINUS_INVALID_OPTIONS unless 0 < minor_radius < major_radius, their sum is finite as a float,
/// and both counts are at least 3
ECHINUS_API echinus_status echinus_mesh_torus(double major_radius, double minor_radius,
                                              uint32_t major_segments, uint32_t minor_segments,
                                              echinus_mesh** mesh);
/// Makes a sphere of meridians and parallels with its poles on the z axis.
/// @return ECHINUS_INVALID_OPTIONS unless radius > 0 and finite as a float, meridian_count >= 3 and
/// parallel_count >= 2
ECHINUS_API echinus_status echinus_mesh_sphere(double radius, uint32_t meridian_count,
                                               uint32_t parallel_count, echinus_mesh** mesh);
/// Makes a box, with each side divided into segments x segments squares of two faces.
/// @param size  [3] lengths of the edges
/// @return ECHINUS_INVALID_OPTIONS unless all lengths are positive and finite as floats, and segments >= 1
ECHINUS_API echinus_status echinus_mesh_box(const double* size, uint32_t segments, echinus_mesh** mesh);

ECHINUS_API void echinus_mesh_destroy(echinus_mesh* mesh);

ECHINUS_API size_t echinus_mesh_vertex_count(const echinus_mesh* mesh);
/// [3 vertex_count] x, y, z, relative to the origin
ECHINUS_API const float* echinus_mesh_vertices(const echinus_mesh* mesh);
/// [3] the origin of the vertices' frame in the frame of the file; 0 for most meshes
ECHINUS_API const double* echinus_mesh_origin(const echinus_mesh* mesh);
ECHINUS_API size_t echinus_mesh_face_count(const echinus_mesh* mesh);
/// [3 face_count]
ECHINUS_API const uint32_t* echinus_mesh_faces(const echinus_mesh* mesh);

#define ECHINUS_FIRST_FACE_COUNT 8

/// The number of occurrences of a fault, and the first faces at which it occurs.
typedef struct echinus_fault {
    uint64_t count;
    uint32_t first_face_count; ///< number of valid elements in first_faces
    uint32_t first_faces[ECHINUS_FIRST_FACE_COUNT];
    uint32_t reserved; ///< 0
} echinus_fault;

/// The properties of a mesh. Vertices are distinguished by index, except that vertices of unbalanced edges
/// count as one if they are at most 2^-21 of the radius apart. All maps treat vertices in the same way.
typedef struct echinus_mesh_report {
    size_t size;
    uint64_t face_count;
    uint64_t vertex_count;
    uint64_t component_count; ///< sets of faces joined by common vertices
    int32_t closed;   ///< every edge is balanced: the same number of faces traverse it in either direction
    int32_t manifold; ///< at most two faces at each edge, and one fan of faces at each vertex
    echinus_fault border_edges;
    echinus_fault nonmanifold_edges;
    echinus_fault misoriented_edges;
    echinus_fault duplicate_faces;
    echinus_fault degenerate_faces;
    double signed_volume; ///< positive if faces point outwards; of limited meaning if the mesh is open
    double centre[3];     ///< centre of the smallest sphere that encloses all vertices used by faces
    double radius;
    /// The spacing of floats at the largest coordinate, if all coordinates are floats and half of this
    /// spacing exceeds a step of a map's lattice; otherwise 0. Finer detail is lost.
    double rounding_step;
    int32_t orientable; ///< faces can be flipped so that all edges with two faces are balanced
    int32_t reserved;   ///< 0
} echinus_mesh_report;

/// Converts points in double to floats relative to an origin. Any thread may call this.
/// @param points  [3 count]
/// @param origin  [3] the origin of a mesh, a map or tetrahedra
/// @param local   [3 count] out
ECHINUS_API echinus_status echinus_to_local(const double* points, size_t count, const double* origin,
                                            float* local);

/// Examines a mesh.
/// @param report  out; the caller sets its size
ECHINUS_API echinus_status echinus_mesh_inspect(const echinus_mesh* mesh, echinus_mesh_report* report);

// Options: repair. Generated by bindings/generate_options; edit bindings/options.toml.
/// The repairs that a call may make. All are off by default. None opens a closed mesh.
typedef struct echinus_repair_options {
    size_t size;
    /// Among faces with the same three vertices, drop opposite ones in pairs, and keep the first of the rest
    int32_t drop_duplicate_faces;
    /// Where two pairs of faces fill the same quadrilateral, each along its own diagonal, drop one pair
    int32_t drop_doubled_patches;
    /// Flip closed parts whose faces point inwards; cavities stay cavities
    int32_t flip_inside_out;
    /// 0
    int32_t reserved;
    /// Fill holes whose border has at most this number of edges, with the triangulation of least area. The
    /// rim of a sheet, whose filling would have more than a third of the sheet's area, is not a hole (0 to
    /// 256)
    uint32_t max_hole_edges;
    /// Drop faces that have the solid on both sides, such as those of an engine in the body of a car: one
    /// patch of neighbours at a time, and only if no remaining edge becomes less balanced
    int32_t drop_inner_faces;
    /// Thicken open parts into solids of this thickness, half of it on either side; 0: none (not negative)
    double sheet_thickness;
    /// Join vertices at the borders of holes that are at most weld_distance apart, and fill holes that are no
    /// wider
    int32_t close_seams;
    /// Drop faces without area at the borders of holes, unless they fill a seam
    int32_t drop_loose_slivers;
    /// Flip faces so that neighbours agree, in parts that are closed by themselves
    int32_t orient_faces;
    /// 0
    int32_t reserved_2;
    /// The width of seams, at most the radius of the bounding sphere. The effective value is at least 2^-21
    /// of the radius, within which maps join vertices anyway (not negative)
    double weld_distance;
} echinus_repair_options;

ECHINUS_API void echinus_repair_options_init(echinus_repair_options* options, size_t size);
// End of options.

typedef struct echinus_repair_report {
    size_t size;
    uint64_t duplicate_faces_dropped;
    uint64_t doubled_patch_faces_dropped;
    uint64_t components_flipped;
    uint64_t holes_closed; ///< holes that were filled, before components are flipped
    uint64_t holes_left;   ///< holes with more edges, or rims of sheets; 0 unless holes were to be closed
    uint64_t inner_faces_dropped;
    uint64_t sheets_thickened;
    uint64_t faces_added;     ///< faces that fill seams, close holes or thicken sheets
    uint64_t vertices_welded; ///< vertices that were replaced by others in all faces
    uint64_t slivers_dropped; ///< loose slivers, and faces that lost their area by welding
    uint64_t faces_turned;    ///< faces flipped so that neighbours agree
    uint64_t seams_filled;    ///< filled holes of zero width
} echinus_repair_report;

/// Makes a repaired copy of a mesh. Faces keep their order, and new faces are appended. Vertices do not
/// change, except those of thickened sheets.
/// @param report         out; the caller sets its size; or NULL
/// @param dropped_faces  out, uint32_t: indices of the dropped faces in the given mesh, ascending; faces that
/// closed a hole have indices after those of the mesh; or NULL
/// @return ECHINUS_INVALID_MESH; ECHINUS_INVALID_OPTIONS for a max_hole_edges above 256, or a thickness or
/// weld distance that is not valid for the mesh
ECHINUS_API echinus_status echinus_mesh_repair(const echinus_mesh* mesh,
                                               const echinus_repair_options* options, echinus_mesh** repaired,
                                               echinus_repair_report* report, echinus_array** dropped_faces);

/// The displacements of echinus_mesh_part(), and what still intersects.
typedef struct echinus_part_report {
    size_t size;
    uint64_t own_pairs;     ///< pairs of faces of the surface
    uint64_t model_pairs;   ///< pairs of a face of the surface and a face of a model, of all models
    uint64_t inside_count;  ///< vertices inside a closed model
    double stretched_share; ///< the share of edges whose length changed by more than 5 %
    double largest_stretch; ///< the largest length of an edge over its length before, minus 1
} echinus_part_report;

/// Makes a copy of a surface such as a garment that is moved, with little stretch, out of models, out of
/// itself, and its layers into their order. Whatever could not be parted is counted in the report, and found
/// by echinus_mesh_intersecting_pairs() and echinus_mesh_self_intersecting_pairs(). It may take
/// minutes for 10 000 vertices on a detailed model.
/// @param models        [model_count] open or closed, in any frame; an open one has no inside
/// @param pinned        [vertex_count] 1 for vertices that stay where they are, otherwise 0; or NULL
/// @param layers        [vertex_count] the layer of each vertex, a larger number farther outside; all
/// vertices of a face are in the same one; or NULL. The outer side of a layer is the one that faces away from
/// the closed models, or without any, the one to which the normals of the faces point
/// @param thickness     distance from which contact pushes the surface off the models, at most four mean edge
/// lengths; 0: a tenth of the mean edge length
/// @param thread_count  0: all cores; the result does not depend on it
/// @param report        out; the caller sets its size; or NULL
/// @return ECHINUS_INVALID_MESH, also for a model of which no exact map is possible; ECHINUS_INVALID_OPTIONS
ECHINUS_API echinus_status echinus_mesh_part(const echinus_mesh* mesh, const echinus_mesh* const* models,
                                             size_t model_count, const uint8_t* pinned, const uint8_t* layers,
                                             double thickness, uint32_t thread_count, echinus_mesh** parted,
                                             echinus_part_report* report);

/// Makes a copy in which vertices at equal positions are joined and unused vertices are dropped.
ECHINUS_API echinus_status echinus_mesh_weld(const echinus_mesh* mesh, echinus_mesh** welded);

/// Generalised winding number of a point, by brute force over all faces: for tests.
/// @param point  [3]
ECHINUS_API echinus_status echinus_mesh_winding_number(const echinus_mesh* mesh, const double* point,
                                                       double* winding_number);
/// Distance from a point to the nearest point of the surface, by brute force over all faces: for tests.
/// @param point  [3]
ECHINUS_API echinus_status echinus_mesh_unsigned_distance(const echinus_mesh* mesh, const double* point,
                                                          double* distance);

/// Finds the intersecting faces of two meshes by exact tests; touching counts.
/// @param pairs  out, uint32_t[2]: a face of a and a face of b, ascending
ECHINUS_API echinus_status echinus_mesh_intersecting_pairs(const echinus_mesh* a, const echinus_mesh* b,
                                                           echinus_array** pairs);
/// Finds the faces of one mesh that intersect other than in shared vertices and edges, by exact tests.
/// @param pairs  out, uint32_t[2]: two faces, ascending
ECHINUS_API echinus_status echinus_mesh_self_intersecting_pairs(const echinus_mesh* mesh,
                                                                echinus_array** pairs);

/// A polyline along which surfaces intersect.
typedef struct echinus_intersection_curve {
    uint32_t point_count;
    int32_t closed; ///< 1: a segment joins the last point to the first
} echinus_intersection_curve;

/// Finds the intersecting faces and the curves along which they cross. Coplanar faces, faces without area and
/// faces that touch in a point have no curve.
/// @param b       in the frame of a; or NULL for a itself
/// @param pairs   out, uint32_t[2], as the functions above return them; or NULL
/// @param curves  out, echinus_intersection_curve
/// @param points  out, float[3], local: the points of the first curve, then those of the next
/// @return ECHINUS_INVALID_MESH for more than 2^25 pairs
ECHINUS_API echinus_status echinus_mesh_intersections(const echinus_mesh* a, const echinus_mesh* b,
                                                      echinus_array** pairs, echinus_array** curves,
                                                      echinus_array** points);

/// How far the vertices of one mesh are inside another.
typedef struct echinus_penetration {
    /// 1 if the depth was measured: the other mesh is closed, and an exact map of it is possible. Otherwise
    /// vertex_count is 0.
    int32_t known;
    uint32_t vertex_count;
    uint32_t deepest_vertex; ///< ECHINUS_NONE without a vertex inside
    float depth;             ///< the deepest vertex's distance from the other surface
} echinus_penetration;

/// A pair of the meshes that were checked, or one mesh and itself.
typedef struct echinus_checked_meshes {
    uint32_t a, b; ///< a <= b; equal for a mesh and itself
    uint64_t pair_count;
    uint64_t curve_count;
    double curve_length; ///< total length of all curves
    echinus_penetration a_in_b, b_in_a;
} echinus_checked_meshes;

/// Finds the pairs of meshes that intersect or of which one has a vertex inside the other, and the meshes
/// that intersect themselves. echinus_mesh_intersections() returns their curves.
/// @param meshes        [mesh_count] in one frame
/// @param thread_count  for measuring depths; 0: all cores
/// @param found         out, echinus_checked_meshes, ascending
/// @return as echinus_mesh_intersections(), and ECHINUS_INVALID_MESH for meshes with different origins
ECHINUS_API echinus_status echinus_check(const echinus_mesh* const* meshes, size_t mesh_count,
                                         uint32_t thread_count, echinus_array** found);

// ---- Maps: building and inspecting ----

/// An exact map, a distance map, or a custom map, which calls two functions of the caller.
typedef struct echinus_map echinus_map;

typedef enum echinus_map_kind {
    ECHINUS_MAP_EXACT = 1,
    ECHINUS_MAP_DISTANCE = 2,
    ECHINUS_MAP_CUSTOM = 3
} echinus_map_kind;

/// The rule by which the winding number of the surface around a point decides whether the point is inside.
typedef enum echinus_inside_rule {
    ECHINUS_INSIDE_NONZERO = 0, ///< points with any winding number except 0 are inside
    ECHINUS_INSIDE_PARITY = 1   ///< points with odd numbers are inside: a part within a part is a hole
} echinus_inside_rule;

/// The point at which the rays of a map start.
typedef enum echinus_centre_choice {
    ECHINUS_CENTRE_BOUNDING_SPHERE = 0, ///< the centre of the smallest enclosing sphere
    ECHINUS_CENTRE_SEARCH = 1 ///< the point with the best expected map; costs about twenty coarse builds
} echinus_centre_choice;

// Options: exact_map. Generated by bindings/generate_options; edit bindings/options.toml.
typedef struct echinus_exact_map_options {
    size_t size;
    /// Each octant of directions has divisions^2 cells; 0: chosen according to the mesh (0 to 512)
    uint32_t divisions;
    /// Threads that build the map; 0: all cores. The map does not depend on it
    uint32_t thread_count;
    /// The largest size of the map, which gets as many cells as fit; 0: no limit. It cannot be combined with
    /// a number of cells (0 to 4e9 bytes)
    uint64_t byte_budget;
    /// The points that count as inside where parts of the model overlap: those in any part, or those in an
    /// odd number of parts
    echinus_inside_rule rule;
    /// The origin of the rays: the centre of the bounding sphere, or a point found by a search for the fewest
    /// face tests per query
    echinus_centre_choice centre;
    /// If false, the map of an open surface is built up to 0.2 s faster, and the same answers take up to
    /// eight times as long, which is acceptable for a map that is used for one frame only
    int32_t find_certain_gaps;
    /// 0
    uint32_t reserved;
} echinus_exact_map_options;

ECHINUS_API void echinus_exact_map_options_init(echinus_exact_map_options* options, size_t size);
// End of options.

/// Builds an exact map, which decides inside or outside by integer arithmetic and finds the true nearest
/// point of the surface. Its bytes do not depend on the number of threads.
/// @param options  or NULL for the defaults
/// @return ECHINUS_INVALID_OPTIONS; ECHINUS_INVALID_MESH if no map can be built, for instance because the
/// bounding radius lies outside [1e-15, 1e15]
ECHINUS_API echinus_status echinus_map_build_exact(const echinus_mesh* mesh,
                                                   const echinus_exact_map_options* options,
                                                   echinus_map** map);

/// The grid by which a distance map divides the directions around its centre.
typedef enum echinus_direction_grid {
    ECHINUS_GRID_SPHERICAL = 0,
    ECHINUS_GRID_OCTAHEDRAL = 1,
    ECHINUS_GRID_CUBE = 2,
    ECHINUS_GRID_ELLIPSOIDAL = 3
} echinus_direction_grid;

/// The correction for vertices that linear interpolation between samples cuts off.
typedef enum echinus_vertex_correction {
    ECHINUS_CORRECTION_NONE = 0,
    ECHINUS_CORRECTION_PAPER = 1,
    ECHINUS_CORRECTION_SIGNED = 2
} echinus_vertex_correction;

/// The format of a stored distance.
typedef enum echinus_entry_format {
    ECHINUS_ENTRY_FLOAT32 = 0,
    ECHINUS_ENTRY_UNORM16 = 1
} echinus_entry_format;

/// The axis of the mesh on which the poles of a grid lie.
typedef enum echinus_pole_axis {
    ECHINUS_POLE_X = 0,
    ECHINUS_POLE_Y = 1,
    ECHINUS_POLE_Z = 2
} echinus_pole_axis;

// Options: distance_map. Generated by bindings/generate_options; edit bindings/options.toml.
typedef struct echinus_distance_map_options {
    size_t size;
    /// The grid of directions
    echinus_direction_grid grid;
    /// Spherical and ellipsoidal grid: the number of samples of longitude (4 to 8192)
    uint32_t longitude_count;
    /// Spherical and ellipsoidal grid: the number of samples of colatitude (4 to 8192)
    uint32_t colatitude_count;
    /// Octahedral and cube grid: the number of parts into which each edge is divided (4 to 4096)
    uint32_t divisions;
    /// The correction for vertices of the mesh between the samples
    echinus_vertex_correction correction;
    /// The format of a stored distance; unorm16 takes half the bytes, with an error of at most 7.6e-6 R, or
    /// 1.4e-5 R on octahedral and ellipsoidal grids
    echinus_entry_format entry_format;
    /// Spherical and ellipsoidal grid: the axis of the mesh on which the poles of the grid lie, where samples
    /// crowd
    echinus_pole_axis pole_axis;
    /// The origin of the rays: the centre of the bounding sphere, or a point found by a search for the fewest
    /// wrong answers near the surface
    echinus_centre_choice centre;
    /// Threads that build the map; 0: all cores. The map does not depend on it
    uint32_t thread_count;
    /// 0
    uint32_t reserved;
} echinus_distance_map_options;

ECHINUS_API void echinus_distance_map_options_init(echinus_distance_map_options* options, size_t size);
// End of options.

/// Builds a distance map, which interpolates sorted distances along a grid of rays. It is fast, but some of
/// its answers are wrong.
/// @param options  or NULL for the defaults
ECHINUS_API echinus_status echinus_map_build_distance(const echinus_mesh* mesh,
                                                      const echinus_distance_map_options* options,
                                                      echinus_map** map);

ECHINUS_API void echinus_map_destroy(echinus_map* map);

typedef struct echinus_map_info {
    size_t size;
    echinus_map_kind kind;
    float centre[3]; ///< the start of the rays, local; this and all further members are 0 for a custom map
    float radius;    ///< every vertex of the mesh is within this distance of the centre
    uint32_t face_count;  ///< number of faces of the mesh
    uint64_t byte_count;  ///< size of all data that queries read
    uint64_t source_hash; ///< identifies the mesh and the options that the map was built from
    double origin[3];     ///< the origin of the local frame in the frame of the mesh's file
} echinus_map_info;

/// @param info  out; the caller sets its size
ECHINUS_API echinus_status echinus_map_describe(const echinus_map* map, echinus_map_info* info);

typedef struct echinus_exact_map_statistics {
    size_t size;
    uint32_t face_count;
    uint32_t dropped_faces; ///< faces without area on the lattice, which do not affect what is inside
    uint32_t longest_list;  ///< largest number of faces in a band
    float mean_list;
    float expected_tests; ///< expected number of faces that a query near the surface tests
    float certain_share;  ///< share of the bounding sphere's volume with stored answers; 1 for a closed mesh
    float uncertain_directions; ///< share of directions along which an answer is computed somewhere
    uint32_t reserved;          ///< 0
} echinus_exact_map_statistics;

/// The statistics of the build of an exact map.
ECHINUS_API echinus_status echinus_map_exact_statistics(const echinus_map* map,
                                                        echinus_exact_map_statistics* statistics);

typedef struct echinus_distance_map_statistics {
    size_t size;
    uint32_t face_count;
    uint32_t dropped_faces;
    uint32_t max_entries;       ///< largest number of entries of a direction
    uint32_t corrected_entries; ///< entries moved by the vertex correction
    uint32_t clamped_entries;   ///< corrections that were clamped
    float wrong_parity_share;   ///< share of directions that see a hole; 0 for a closed mesh
} echinus_distance_map_statistics;

/// The statistics of the build of a distance map.
ECHINUS_API echinus_status echinus_map_distance_statistics(const echinus_map* map,
                                                           echinus_distance_map_statistics* statistics);

/// The surface of a map as a mesh, in the local frame: the mesh on the lattice of an exact map, or the layers
/// that a distance map interpolates.
/// @param classes  out, uint32_t [face_count]: the longest list that contains the face (exact map), or its
/// layer (distance map); or NULL
/// @return ECHINUS_INVALID_ARGUMENT for a custom map
ECHINUS_API echinus_status echinus_map_surface(const echinus_map* map, echinus_mesh** mesh,
                                               echinus_array** classes);

/// Builds exact maps of a surface whose vertices move while its faces stay the same.
typedef struct echinus_map_builder echinus_map_builder;

/// @param faces    [3 face_count]; copied
/// @param options  or NULL for the defaults
ECHINUS_API echinus_status echinus_map_builder_create(const uint32_t* faces, size_t face_count,
                                                      const echinus_exact_map_options* options,
                                                      echinus_map_builder** builder);
/// Builds the map that echinus_map_build_exact() would build from these vertices. The memory of the previous
/// map is reused if that map was destroyed.
ECHINUS_API echinus_status echinus_map_builder_rebuild(echinus_map_builder* builder, const float* vertices,
                                                       size_t vertex_count, size_t vertex_stride,
                                                       echinus_map** map);
ECHINUS_API void echinus_map_builder_destroy(echinus_map_builder* builder);

// ---- Map files ----

/// Writes a map file atomically.
/// @return ECHINUS_UNWRITABLE; ECHINUS_INVALID_ARGUMENT for a custom map
ECHINUS_API echinus_status echinus_map_save(const echinus_map* map, const char* path);

/// The bytes of a map file.
/// @param bytes  out, unsigned char
ECHINUS_API echinus_status echinus_map_serialise(const echinus_map* map, echinus_array** bytes);

/// Maps a file into memory, verifies it and reads it in place. While it is in use, the file may be replaced
/// or removed, but must not be overwritten in place.
/// @return ECHINUS_UNREADABLE, ECHINUS_WRONG_FORMAT, ECHINUS_UNSUPPORTED_VERSION or ECHINUS_DAMAGED
ECHINUS_API echinus_status echinus_map_load(const char* path, echinus_map** map);

/// Makes a map that uses bytes of the caller in place, after verifying them.
/// @param bytes    at an address that is a multiple of 8; unchanged until release is called
/// @param release  called with `context` once the map and all simulations that use it are gone, from the
///                 thread that destroys the last of them; or NULL. Not called if this call fails
/// @param context  passed to release; or NULL
/// @param name     replaces the path in error messages
ECHINUS_API echinus_status echinus_map_view(const void* bytes, size_t byte_count,
                                            void (*release)(void* context), void* context, const char* name,
                                            echinus_map** map);

// ---- Custom maps ----

struct echinus_contact;

/// A data structure of the caller that colliders query in place of a map. Points are x, y, z, contiguous, in
/// the frame of the structure. Any number of threads may call at once. The functions must not exit by an
/// exception or longjmp.
typedef struct echinus_custom_map {
    size_t size;
    void* context; ///< passed to the functions
    /// @param inside  [count] out: 1 inside, 0 outside
    void (*contains)(void* context, const float* points, size_t count, uint8_t* inside);
    /// Returns a contact for each particle that is inside, or outside within the margin.
    /// @param contacts  [count] out: every element must be written
    void (*contacts)(void* context, const float* points, size_t count, float margin,
                     struct echinus_contact* contacts);
    /// Called when the map and all simulations that use it are destroyed; or NULL. It is not called if the
    /// map could not be made.
    void (*release)(void* context);
} echinus_custom_map;

/// Makes a custom map.
/// @param custom  the caller sets its size; copied
ECHINUS_API echinus_status echinus_map_from_custom(const echinus_custom_map* custom, echinus_map** map);

// ---- Queries of maps, in the local frame ----
//
// A point with NaN or infinity is outside, has no contact and meets nothing. A call takes up to 120 KB of the
// stack. Batches are several times as fast as calls for single points, and give bit-identical answers. Custom
// maps are queried through colliders: here they give ECHINUS_INVALID_ARGUMENT.

/// The part of a triangle on which the nearest point lies.
typedef enum echinus_feature {
    ECHINUS_FEATURE_UNKNOWN = 0,
    ECHINUS_FEATURE_FACE = 1,
    ECHINUS_FEATURE_EDGE = 2,
    ECHINUS_FEATURE_VERTEX = 3
} echinus_feature;

/// The answer for one particle. Without a contact, point is the particle, depth and normal are 0, and face is
/// ECHINUS_NONE.
typedef struct echinus_contact {
    float point[3];  ///< the target of the push-out
    float normal[3]; ///< outward unit normal
    float depth;     ///< distance to point: positive inside, negative outside
    uint32_t face;   ///< index in the mesh; ECHINUS_NONE if it is not known
    uint8_t inside;
    uint8_t certain; ///< 0 if the mesh is open and its winding number is within 0.1 of a threshold
    uint8_t feature; ///< an echinus_feature
} echinus_contact;

/// Decides which points are inside.
/// @param inside  [count] out: 1 inside, 0 outside
ECHINUS_API echinus_status echinus_map_contains(const echinus_map* map, const float* points, size_t count,
                                                size_t stride, uint32_t thread_count, uint8_t* inside);

/// Decides which points are inside, and whether that is certain.
/// @param inside   [count] out
/// @param certain  [count] out: 0 if the mesh is open and its winding number is within 0.1 of a threshold
ECHINUS_API echinus_status echinus_map_classify(const echinus_map* map, const float* points, size_t count,
                                                size_t stride, uint32_t thread_count, uint8_t* inside,
                                                uint8_t* certain);

/// Finds contacts: whether points are inside, how deep, and where the push-out leads.
/// @param margin    points outside also get a contact if the surface is at most this far away; not negative
/// @param contacts  [count] out
ECHINUS_API echinus_status echinus_map_contacts(const echinus_map* map, const float* points, size_t count,
                                                size_t stride, float margin, uint32_t thread_count,
                                                echinus_contact* contacts);

/// Signed distances of points from the surface, however far away: negative inside, positive outside, the
/// opposite of depth. Where the distance is 0, the sign bit tells whether the point is inside. Only exact
/// maps support this. A point with NaN gives NaN and a point with infinity gives infinity, both with a
/// gradient of 0.
/// @param distances  [count] out
/// @param gradients  [3 count] out: unit vectors along which the distance grows fastest; or NULL
ECHINUS_API echinus_status echinus_map_signed_distance(const echinus_map* map, const float* points,
                                                       size_t count, size_t stride, uint32_t thread_count,
                                                       float* distances, float* gradients);

/// Winding numbers of the surface around points: integers for a closed surface, otherwise generalised winding
/// numbers. Only exact maps support this. A point with NaN gives NaN, and a point with infinity gives 0.
/// @param tolerance        the largest error of the result; the result is never on the wrong side of an odd
/// multiple of one half. Not negative; 0 counts as 1e-8
/// @param winding_numbers  [count] out
ECHINUS_API echinus_status echinus_map_winding_number(const echinus_map* map, const float* points,
                                                      size_t count, size_t stride, float tolerance,
                                                      uint32_t thread_count, float* winding_numbers);

/// The point at which a particle that moves along a segment first meets the surface.
typedef struct echinus_sweep_hit {
    float fraction;   ///< position on the segment; 1 without a crossing
    float point[3];   ///< the crossing; the end of the segment without a crossing
    float normal[3];  ///< outward normal of the face; 0 without a crossing
    uint32_t face;    ///< ECHINUS_NONE without a crossing
    uint8_t entering; ///< the crossing leads from outside to inside
} echinus_sweep_hit;

/// Finds the first crossing of each segment. Only exact maps support this.
/// @param hits  [count] out
ECHINUS_API echinus_status echinus_map_sweep(const echinus_map* map, const float* from, size_t from_stride,
                                             const float* to, size_t to_stride, size_t count,
                                             uint32_t thread_count, echinus_sweep_hit* hits);

// ---- Triangles against the surface of an exact map, in the local frame ----
//
// Triangles are nine floats, corner after corner; their stride is a multiple of 4, at least 36; 0 means 36. A
// triangle with two equal corners is an edge, and one with three equal corners a point. A triangle with a
// corner that is not finite is far from all faces.

/// Decides which triangles have a point in common with the surface.
/// @param intersecting  [count] out: 0 or 1
ECHINUS_API echinus_status echinus_map_intersects(const echinus_map* map, const float* triangles,
                                                  size_t count, size_t stride, uint32_t thread_count,
                                                  uint8_t* intersecting);

typedef struct echinus_clearance {
    float distance; ///< a lower bound on the distance between the triangle and the surface
    uint32_t face;  ///< the face at this distance; ECHINUS_NONE if none is within the search distance
} echinus_clearance;

/// Finds the distance of each triangle from the surface.
/// @param farthest    the search distance; not negative, may be infinite
/// @param clearances  [count] out
ECHINUS_API echinus_status echinus_map_clearance(const echinus_map* map, const float* triangles, size_t count,
                                                 size_t stride, float farthest, uint32_t thread_count,
                                                 echinus_clearance* clearances);

typedef struct echinus_triangle_sweep_hit {
    float fraction; ///< fraction of the path up to which the triangle does not meet the surface
    uint32_t face;  ///< the face that it reaches; ECHINUS_NONE if it meets none
} echinus_triangle_sweep_hit;

/// Moves triangles, whose corners follow straight lines, until they reach the surface. Paths that begin or
/// end farther than 10^11 radii from the map's centre are ignored: they meet nothing.
/// @param hits  [count] out
ECHINUS_API echinus_status echinus_map_sweep_triangles(const echinus_map* map, const float* from,
                                                       size_t from_stride, const float* to, size_t to_stride,
                                                       size_t count, uint32_t thread_count,
                                                       echinus_triangle_sweep_hit* hits);

/// Finds the faces within reach of each triangle of a mesh.
/// @param triangles  [3 triangle_count] vertex indices
/// @param reach      not negative; 0: only touching faces
/// @param offsets    out, uint32_t [triangle_count + 1]: the start of each triangle's list
/// @param faces      out, uint32_t: the lists one after the other, each ascending
ECHINUS_API echinus_status echinus_map_faces_within(const echinus_map* map, const float* vertices,
                                                    size_t vertex_count, size_t vertex_stride,
                                                    const uint32_t* triangles, size_t triangle_count,
                                                    float reach, uint32_t thread_count,
                                                    echinus_array** offsets, echinus_array** faces);

// ---- Colliders ----

/// A pose: a rotation followed by a translation.
typedef struct echinus_pose {
    double rotation[4]; ///< unit quaternion w, x, y, z, to within 1e-4
    double translation[3];
} echinus_pose;

/// The rotation by an angle about an axis, counter-clockwise seen from the tip of the axis.
/// @param axis      [3] finite, of any length except 0
/// @param rotation  [4] out: w, x, y, z
ECHINUS_API echinus_status echinus_rotation_about(const double* axis, double angle_rad, double* rotation);

/// A map in the world: a plain value that the caller owns. The map must exist as long as the collider is
/// used, except in a simulation, which keeps the data that it needs. In an array all colliders have the size
/// of the first.
typedef struct echinus_collider {
    size_t size;
    const echinus_map* map;
    echinus_pose pose;
    double scale[3];            ///< factors along the axes of the map, before the pose; finite, not 0
    double linear_velocity[3];  ///< velocity of the pose's translation, units per second
    double angular_velocity[3]; ///< rotation about the pose's translation, in world axes, radians per second
} echinus_collider;

/// Fills in a collider at rest in the map's own frame.
ECHINUS_API void echinus_collider_init(echinus_collider* collider, size_t size, const echinus_map* map);

/// Like echinus_map_contains(), in the world, for maps of every kind.
ECHINUS_API echinus_status echinus_collider_contains(const echinus_collider* collider, const float* points,
                                                     size_t count, size_t stride, uint32_t thread_count,
                                                     uint8_t* inside);

/// Like echinus_map_contacts(), in the world, for maps of every kind.
ECHINUS_API echinus_status echinus_collider_contacts(const echinus_collider* collider, const float* points,
                                                     size_t count, size_t stride, float margin,
                                                     uint32_t thread_count, echinus_contact* contacts);

/// Finds where moving particles first meet a collider that moves from its previous pose to its present one.
/// `point` is the present position of the surface point that was met. Distance maps and custom maps have no
/// sweep, so no crossing is found.
ECHINUS_API echinus_status echinus_collider_sweep(const echinus_collider* collider,
                                                  const echinus_pose* previous, const float* from,
                                                  size_t from_stride, const float* to, size_t to_stride,
                                                  size_t count, uint32_t thread_count,
                                                  echinus_sweep_hit* hits);

/// The velocity of the collider's material at a point, units per second.
/// @param point     [3]
/// @param velocity  [3] out
ECHINUS_API echinus_status echinus_collider_velocity_at(const echinus_collider* collider, const double* point,
                                                        double* velocity);

/// The pose of a collider after the given time at its velocities.
/// @param seconds  finite
ECHINUS_API echinus_status echinus_collider_pose_after(const echinus_collider* collider, double seconds,
                                                       echinus_pose* pose);

/// A keyframe: the pose of a collider at a time.
typedef struct echinus_pose_key {
    double time; ///< seconds
    echinus_pose pose;
} echinus_pose_key;

/// The pose at a time: between two keys the translation is interpolated linearly, and the rotation at
/// constant speed along the shorter arc. Before the first key it is the pose of the first key, and after the
/// last key that of the last.
/// @param keys  [key_count], at least one; their times ascend, and poses are finite
/// @param pose  out
ECHINUS_API echinus_status echinus_pose_at(const echinus_pose_key* keys, size_t key_count, double seconds,
                                           echinus_pose* pose);

/// The vertices of a model over time, in equally spaced samples. A cache is immutable.
typedef struct echinus_vertex_cache echinus_vertex_cache;

/// Copies the samples.
/// @param samples         [3 vertex_count sample_count] in the model's own frame; at least one sample of one
///                        vertex
/// @param start_time      the time of the first sample, seconds
/// @param sample_seconds  the time from one sample to the next, seconds; positive
ECHINUS_API echinus_status echinus_vertex_cache_create(const float* samples, size_t sample_count,
                                                       size_t vertex_count, double start_time,
                                                       double sample_seconds, echinus_vertex_cache** cache);
/// Reads a PC2 point cache; a folder of OBJ files, one for each frame, in the order of their names; or the
/// model's own glTF, GLB or 3DS file with one animation.
/// @param mesh               the model, as returned by echinus_mesh_read()
/// @param frames_per_second  positive
/// @return as echinus_mesh_read(); ECHINUS_INVALID_MESH also if the number of vertices, or a face of a
/// folder's mesh or of a file with an animation, differs from the model's, or the file does not have exactly
/// one animation
ECHINUS_API echinus_status echinus_vertex_cache_read(const char* path, const echinus_mesh* mesh,
                                                     double frames_per_second, echinus_vertex_cache** cache);
ECHINUS_API void echinus_vertex_cache_destroy(echinus_vertex_cache* cache);

typedef struct echinus_vertex_cache_info {
    size_t size;
    uint64_t sample_count;
    uint64_t vertex_count;
    double start_time;
    double sample_seconds;
    const float* samples; ///< [3 vertex_count sample_count]; valid as long as the cache exists
} echinus_vertex_cache_info;

/// @param info  out; the caller sets its size
ECHINUS_API echinus_status echinus_vertex_cache_describe(const echinus_vertex_cache* cache,
                                                         echinus_vertex_cache_info* info);
/// The vertices at a time, interpolated linearly between samples. Before the first sample they are those of
/// the first, and after the last sample those of the last.
/// @param vertices  [3 vertex_count] out
ECHINUS_API echinus_status echinus_vertex_cache_at(const echinus_vertex_cache* cache, double seconds,
                                                   float* vertices);

// ---- Tetrahedra: solids divided into tetrahedra (docs/tetrahedra.md) ----

/// A body of tetrahedra that share vertices. Each tetrahedron is positive, and two with a common face lie on
/// opposite sides of it; other bodies are rejected. It is immutable.
typedef struct echinus_tetrahedra echinus_tetrahedra;

/// Copies vertices and tetrahedra.
/// @param tetrahedra  [4 tetrahedron_count] vertices a, b, c, d: a, b, c turn counter-clockwise seen from d
/// @return ECHINUS_INVALID_MESH, naming the first invalid tetrahedron or vertex; signs are exact
ECHINUS_API echinus_status echinus_tetrahedra_create(const float* vertices, size_t vertex_count,
                                                     size_t vertex_stride, const uint32_t* tetrahedra,
                                                     size_t tetrahedron_count, echinus_tetrahedra** body);

/// The changes that made a file's body valid.
typedef struct echinus_tetrahedra_file_report {
    size_t size;
    uint64_t turned_tetrahedra; ///< tetrahedra with negative volume that were reversed: the order of corners
                                ///< is a convention of the file
    uint64_t dropped_vertices;  ///< vertices that no tetrahedron uses
} echinus_tetrahedra_file_report;

/// Reads .msh (Gmsh 2.2 and 4.1), .vtk (legacy, an unstructured grid) or TetGen's pair .node and .ele; either
/// file of the pair may be named.
/// @param report  out; the caller sets its size; or NULL
/// @return ECHINUS_UNREADABLE, ECHINUS_WRONG_FORMAT, ECHINUS_DAMAGED or ECHINUS_INVALID_MESH
ECHINUS_API echinus_status echinus_tetrahedra_read(const char* path, echinus_tetrahedra** body,
                                                   echinus_tetrahedra_file_report* report);
/// Writes .msh (Gmsh 2.2) or .vtk, depending on the file name's extension. The file is written atomically.
/// @return ECHINUS_UNWRITABLE or ECHINUS_WRONG_FORMAT
ECHINUS_API echinus_status echinus_tetrahedra_write(const echinus_tetrahedra* body, const char* path);

/// Makes a box around the origin, of cuboids that are divided into five tetrahedra each. Vertex (i, j, k),
/// counted along x, y and z, has the index (k * (segments[1] + 1) + j) * (segments[0] + 1) + i.
/// @param size      [3] lengths of the edges
/// @param segments  [3] cuboids along each axis, 1 to 512
ECHINUS_API echinus_status echinus_tetrahedra_box(const double* size, const uint32_t* segments,
                                                  echinus_tetrahedra** body);

// Options: tetrahedralize. Generated by bindings/generate_options; edit bindings/options.toml.
typedef struct echinus_tetrahedralize_options {
    size_t size;
    /// The edge of the lattice's cubes, in the model's unit. Set either this or count; 0: not set (not
    /// negative)
    double lattice_size;
    /// The target number of tetrahedra: the size is found by trial
    uint64_t count;
    /// The largest number of tetrahedra; more are rejected
    uint64_t most_tetrahedra;
    /// Threads to use; 0: all cores. The result does not depend on it
    uint32_t thread_count;
    /// 0
    uint32_t reserved;
} echinus_tetrahedralize_options;

ECHINUS_API void echinus_tetrahedralize_options_init(echinus_tetrahedralize_options* options, size_t size);
// End of options.

typedef struct echinus_tetrahedralize_report {
    size_t size;
    double lattice_size;
    /// Tetrahedra left out because parts would have met in only an edge or a vertex.
    uint64_t removed_tetrahedra;
} echinus_tetrahedralize_report;

/// Fills the inside of an exact map with tetrahedra, by isosurface stuffing. The boundary is closed, manifold
/// and does not intersect itself; the extreme dihedral angles are 9.3 and 161.7 degrees.
/// @param report  out; the caller sets its size; or NULL
/// @return ECHINUS_INVALID_OPTIONS; ECHINUS_INVALID_MESH when no tetrahedron of that size fits into the
/// model; ECHINUS_INVALID_ARGUMENT for a map that is not exact
ECHINUS_API echinus_status echinus_tetrahedralize(const echinus_map* model,
                                                  const echinus_tetrahedralize_options* options,
                                                  echinus_tetrahedra** body,
                                                  echinus_tetrahedralize_report* report);

ECHINUS_API void echinus_tetrahedra_destroy(echinus_tetrahedra* body);

ECHINUS_API size_t echinus_tetrahedra_vertex_count(const echinus_tetrahedra* body);
/// [3 vertex_count] x, y, z
ECHINUS_API const float* echinus_tetrahedra_vertices(const echinus_tetrahedra* body);
/// [3] the origin of the vertices' frame, as echinus_mesh_origin()
ECHINUS_API const double* echinus_tetrahedra_origin(const echinus_tetrahedra* body);
ECHINUS_API size_t echinus_tetrahedra_count(const echinus_tetrahedra* body);
/// [4 count]
ECHINUS_API const uint32_t* echinus_tetrahedra_indices(const echinus_tetrahedra* body);

typedef struct echinus_tetrahedra_report {
    size_t size;
    uint64_t tetrahedron_count;
    uint64_t vertex_count; ///< number of used vertices
    double volume;         ///< the total volume
    double least_volume;   ///< the volume of the smallest tetrahedron
    double shortest_edge;
    double longest_edge;
    double least_angle_deg; ///< smallest angle between two faces of a tetrahedron, in degrees
    double greatest_angle_deg;
} echinus_tetrahedra_report;

/// @param report  out; the caller sets its size
ECHINUS_API echinus_status echinus_tetrahedra_inspect(const echinus_tetrahedra* body,
                                                      echinus_tetrahedra_report* report);

/// The faces that belong to only one tetrahedron, outward, with all vertices of the body.
ECHINUS_API echinus_status echinus_tetrahedra_boundary(const echinus_tetrahedra* body, echinus_mesh** mesh);

/// The distances between the boundary of a body and the surface of a model, at samples on both.
typedef struct echinus_boundary_distance {
    size_t size;
    double mean_to_model;
    double greatest_to_model;
    double mean_to_boundary;
    double greatest_to_boundary;
} echinus_boundary_distance;

/// @param distance  out; the caller sets its size
/// @return ECHINUS_INVALID_ARGUMENT for a map that is not exact
ECHINUS_API echinus_status echinus_tetrahedra_measure_distance(const echinus_tetrahedra* body,
                                                               const echinus_map* model,
                                                               uint32_t thread_count,
                                                               echinus_boundary_distance* distance);

/// The positions of points, for instance of a finer mesh, relative to a body, so that they can follow the
/// body. An embedding is immutable.
typedef struct echinus_embedding echinus_embedding;

/// Finds the tetrahedron that contains each point, or else the nearest one, and the point's weights there.
/// @param points  [count] finite
/// @return ECHINUS_INVALID_MESH when a point is not finite
ECHINUS_API echinus_status echinus_embedding_create(const echinus_tetrahedra* body, const float* points,
                                                    size_t count, size_t stride, uint32_t thread_count,
                                                    echinus_embedding** embedding);
ECHINUS_API void echinus_embedding_destroy(echinus_embedding* embedding);
/// The number of points.
ECHINUS_API size_t echinus_embedding_count(const echinus_embedding* embedding);
/// Computes the positions of the points after the body's vertices have moved.
/// @param positions       [position_count] the positions of all vertices of the body
/// @param points          [3 count] out; must not overlap the positions
/// @return ECHINUS_INVALID_ARGUMENT for a different number of positions
ECHINUS_API echinus_status echinus_embedding_carry(const echinus_embedding* embedding, const float* positions,
                                                   size_t position_count, size_t position_stride,
                                                   uint32_t thread_count, float* points);

// ---- Deformables ----

typedef enum echinus_constraint_kind {
    ECHINUS_CONSTRAINT_STRUCTURAL = 0,
    ECHINUS_CONSTRAINT_SHEAR = 1,
    ECHINUS_CONSTRAINT_BENDING = 2
} echinus_constraint_kind;
#define ECHINUS_CONSTRAINT_KIND_COUNT 3

/// A distance constraint, which pulls or pushes two particles to a distance.
typedef struct echinus_distance_constraint {
    uint32_t a, b;
    float rest_length; ///< not negative
    uint8_t kind;      ///< an echinus_constraint_kind
    uint8_t reserved[3];
} echinus_distance_constraint;

/// Fixes a particle to a collider of a simulation.
typedef struct echinus_attachment {
    uint32_t particle;
    uint32_t collider; ///< index in the simulation's colliders
} echinus_attachment;

/// A particle and a collider of a simulation that do not collide. Faces and edges that contain the particle
/// also pass through the collider.
typedef struct echinus_collision_filter {
    uint32_t particle;
    uint32_t collider; ///< index in the simulation's colliders
} echinus_collision_filter;

/// Elastic material between four particles, for ECHINUS_SOLVER_NEWTON; echinus_deformable_soft_body() makes
/// such elements.
typedef struct echinus_elastic_tetrahedron {
    uint32_t particles[4];
    /// The rows of the inverse of the matrix with the columns b - a, c - a and d - a at rest.
    float gradients[3][3];
    float volume;     ///< the volume at rest; positive
    float mu, lambda; ///< the Lame parameters: mu positive, lambda not negative
    float damping;    ///< viscosity divided by mu, seconds
} echinus_elastic_tetrahedron;

/// Particles, their constraints and materials, in world units.
typedef struct echinus_deformable echinus_deformable;

/// The parts of a deformable, as arrays.
typedef struct echinus_deformable_arrays {
    size_t size;
    size_t particle_count;
    const float* positions;      ///< [3 particle_count]
    const float* velocities;     ///< [3 particle_count] units per second; NULL: all are at rest
    const float* inverse_masses; ///< [particle_count] 0 for a pinned particle; NULL means 1 for all
    /// The distance constraints in the order of relaxation; Newton uses only the structural constraints of
    /// threads
    const echinus_distance_constraint* constraints;
    size_t constraint_count;
    const uint32_t* faces; ///< [3 face_count]
    size_t face_count;
    const echinus_attachment* attachments; ///< attachments of pinned particles, at most one for each
    size_t attachment_count;
    const echinus_elastic_tetrahedron* tetrahedra;
    size_t tetrahedron_count;
    const echinus_collision_filter* filters;
    size_t filter_count;
} echinus_deformable_arrays;

/// Copies the arrays. Their consistency is checked when a simulation is created from them.
/// @param arrays  the caller sets its size and the used members; all others are zero
ECHINUS_API echinus_status echinus_deformable_create(const echinus_deformable_arrays* arrays,
                                                     echinus_deformable** deformable);

// Options: cloth. Generated by bindings/generate_options; edit bindings/options.toml.
/// A rectangular sheet: columns along x, rows along y, particle row * column_count + column.
typedef struct echinus_cloth_options {
    size_t size;
    /// Particles along x; at most 2^24 in total (2 to 8388608)
    uint32_t column_count;
    /// Particles along y. The particle (row, column) has the number row * column_count + column (2 to
    /// 8388608)
    uint32_t row_count;
    /// Length along x (positive)
    double width;
    /// Length along y (positive)
    double height;
    /// Initial pose of the middle of the sheet
    echinus_pose pose;
    /// [pin_count] particles that do not move
    const uint32_t* pins;
    size_t pin_count;
} echinus_cloth_options;

ECHINUS_API void echinus_cloth_options_init(echinus_cloth_options* options, size_t size);
// End of options.

/// Makes a rectangular sheet of cloth.
/// @param options  or NULL for the defaults
ECHINUS_API echinus_status echinus_deformable_cloth(const echinus_cloth_options* options,
                                                    echinus_deformable** deformable);

// Options: mesh_cloth. Generated by bindings/generate_options; edit bindings/options.toml.
typedef struct echinus_mesh_cloth_options {
    size_t size;
    /// A vertex starts at position + rotation * (scale * vertex)
    echinus_pose pose;
    /// Scale factor, applied before the pose (1e-9 to 1e9)
    double scale;
    /// [3 rest_vertex_count] the rest shape, if it differs from the mesh: as many vertices as the mesh has,
    /// or none
    const float* rest_vertices;
    size_t rest_vertex_count;
    /// [2 thread_edge_count] edges without faces: threads and needles
    const uint32_t* thread_edges;
    size_t thread_edge_count;
    /// [pin_count] vertices that do not move
    const uint32_t* pins;
    size_t pin_count;
    /// [attachment_count] vertices that move with a collider, and the index of that collider in the
    /// simulation
    const echinus_attachment* attachments;
    size_t attachment_count;
} echinus_mesh_cloth_options;

ECHINUS_API void echinus_mesh_cloth_options_init(echinus_mesh_cloth_options* options, size_t size);
// End of options.

/// Makes a cloth whose particles are the vertices of a mesh.
/// @param options  or NULL for the defaults
/// @return ECHINUS_INVALID_MESH, naming the face, edge or vertex; ECHINUS_INVALID_OPTIONS
ECHINUS_API echinus_status echinus_deformable_cloth_of_mesh(const echinus_mesh* mesh,
                                                            const echinus_mesh_cloth_options* options,
                                                            echinus_deformable** deformable);

// Options: soft_body. Generated by bindings/generate_options; edit bindings/options.toml.
/// The material and initial pose of a soft body; in SI units with metres, kilograms and seconds.
typedef struct echinus_soft_body_options {
    size_t size;
    /// Water has 1000 kg/m^3 (1e-9 to 1e15 mass/length^3)
    double density;
    /// Stiffness; soft tissue has 1e3 to 1e5 Pa (1e-9 to 1e15 mass/(length s^2))
    double young_modulus;
    /// Near 0.5 the volume is preserved (0 to 0.4999)
    double poisson_ratio;
    /// Viscosity divided by the shear modulus (0 to 1e9 s)
    double damping;
    /// A vertex starts at position + rotation * (scale * vertex)
    echinus_pose pose;
    /// Scale factor, applied before the pose (1e-9 to 1e9)
    double scale;
    /// [pin_count] vertices that do not move
    const uint32_t* pins;
    size_t pin_count;
    /// [attachment_count] vertices that move with a collider, and the index of that collider in the
    /// simulation
    const echinus_attachment* attachments;
    size_t attachment_count;
} echinus_soft_body_options;

ECHINUS_API void echinus_soft_body_options_init(echinus_soft_body_options* options, size_t size);
// End of options.

/// Makes a body at rest. Its particles are the vertices of the tetrahedra, and its faces are their boundary.
/// @param options  or NULL for the defaults
/// @return ECHINUS_INVALID_OPTIONS, or ECHINUS_INVALID_MESH if a vertex belongs to no tetrahedron
ECHINUS_API echinus_status echinus_deformable_soft_body(const echinus_tetrahedra* body,
                                                        const echinus_soft_body_options* options,
                                                        echinus_deformable** deformable);

/// Combines several deformables into one. The particles of the parts follow each other in order. With
/// ECHINUS_COLLISION_SURFACES_AND_SELF, they collide with each other.
/// @param parts  [part_count]
/// @return ECHINUS_INVALID_OPTIONS, naming the part, for a part that no simulation would accept
ECHINUS_API echinus_status echinus_deformable_combine(const echinus_deformable* const* parts,
                                                      size_t part_count, echinus_deformable** deformable);

/// Multiplies all masses of a deformable by a finite, positive factor. With ECHINUS_SOLVER_NEWTON, the masses
/// of cloth come from the density in the options of the simulation instead.
ECHINUS_API echinus_status echinus_deformable_with_masses_times(const echinus_deformable* deformable,
                                                                double factor, echinus_deformable** result);

/// The same deformable, with filters that disable collision of all its particles with a collider. After
/// echinus_deformable_combine(), the filters apply to this part only.
/// @param collider  index in the simulation's colliders
ECHINUS_API echinus_status echinus_deformable_passing_through(const echinus_deformable* deformable,
                                                              uint32_t collider, echinus_deformable** result);

/// @param arrays  out; the caller sets its size; its pointers are valid as long as the deformable exists
ECHINUS_API echinus_status echinus_deformable_read(const echinus_deformable* deformable,
                                                   echinus_deformable_arrays* arrays);

ECHINUS_API void echinus_deformable_destroy(echinus_deformable* deformable);

// ---- Simulations ----

/// The parts of a deformable that collide; CollisionMode in simulation.hpp describes them.
typedef enum echinus_collision_mode {
    ECHINUS_COLLISION_PARTICLES = 0,
    ECHINUS_COLLISION_SURFACES = 1,
    ECHINUS_COLLISION_SURFACES_AND_SELF = 2
} echinus_collision_mode;

/// The method by which a deformable moves.
typedef enum echinus_solver {
    ECHINUS_SOLVER_NEWTON = 0,  ///< a continuous material in SI units
    ECHINUS_SOLVER_JAKOBSEN = 1 ///< the paper's solver: distance constraints and collision of particles
} echinus_solver;

/// A thickness of this value lets the library choose.
#define ECHINUS_THICKNESS_CHOSEN (-1.0)

// Options: simulation. Generated by bindings/generate_options; edit bindings/options.toml.
/// SimulationOptions in simulation.hpp describes the cost of each member.
typedef struct echinus_simulation_options {
    size_t size;
    /// Seconds per frame. The paper's solver needs smaller steps: there, halving the step doubles the
    /// computing time and reduces the stretch to a quarter (1e-9 to 1e9 s)
    double time_step;
    /// Newton: a continuous material in SI units; jakobsen: the paper's solver, with distance constraints and
    /// collision of particles only
    echinus_solver solver;
    /// Jakobsen only: relaxations per frame, each of all distance constraints and then of all contacts; more
    /// relaxations take longer and leave less stretch (1 to 1e6)
    uint32_t iteration_count;
    /// Newton only: the largest number of steps of Newton's method per frame or substep, or twice that number
    /// while there is no contact; fewer are taken if it converges (1 to 1000)
    uint32_t newton_step_count;
    /// The number of consecutive frames for which all particles must be slow and near one position (1 to 1e9)
    uint32_t rest_frame_count;
    /// The distance from one position within which a particle at rest stays (0 to 1e9)
    double rest_distance;
    /// The largest speed of a particle at rest at the end of a frame (at least 0 length/s)
    double rest_speed;
    /// The acceleration of gravity. A model whose y axis points up needs [0, -9.81, 0] (-1e9 to 1e9
    /// length/s^2)
    double gravity[3];
    /// Jakobsen only: share of the velocity that is lost per frame; its effect depends on time_step (0 to 1)
    double drag;
    /// Jakobsen only: share of a constraint's error that one relaxation removes, for structural, shear and
    /// bending constraints (0 to 1.99)
    double stiffness[ECHINUS_CONSTRAINT_KIND_COUNT];
    /// Distance that the deformable keeps from colliders, by default half the mean rest length of structural
    /// constraints or, for soft bodies, half the mean edge length (0 to 1e9), or ECHINUS_THICKNESS_CHOSEN
    double thickness;
    /// Newton only: distance that layers keep from each other if they collide; less near small faces. By
    /// default the thickness (0 to 1e9), or ECHINUS_THICKNESS_CHOSEN
    double self_thickness;
    /// Coulomb's coefficient of friction, for contacts with models and, if layers collide, between layers; 0:
    /// no friction (0 to 1e9)
    double friction;
    /// The largest distance of a particle from the initial middle of all particles; if a particle is farther
    /// away, the simulation ends as diverged. 0: 10 000 times the initial extent (0 to 1e30)
    double bound;
    /// Jakobsen only: rescue particles that would pass through an exact map
    int32_t keep_free;
    /// Accept exact maps of open meshes, for which nothing is guaranteed. The collision of surfaces does not
    /// need this option
    int32_t allow_open_colliders;
    /// The parts that collide; with jakobsen only particles do. particles: particles collide with models;
    /// surfaces: edges and faces do, too, so none of them intersects a model at the end of a frame, within
    /// limits; surfaces_and_self: in addition, faces do not intersect each other
    echinus_collision_mode collision;
    /// Newton only: separate, before the first frame, an initial state in which surfaces intersect or
    /// particles are inside the model, instead of rejecting it; needs the collision of surfaces
    int32_t untangle;
    /// 0
    uint32_t reserved;
    /// Threads that compute a frame; 0: all cores. The results are bit-identical for any number (0 to 1024)
    uint32_t thread_count;
    /// Newton only, like the next four options: mass of the cloth per area (1e-6 to 1e6 kg/m^2)
    double density;
    /// Force per width that resists stretching of warp and weft (1e-6 to 1e9 N/m)
    double stretch_stiffness;
    /// Force per width that resists shear between warp and weft (0 to 1e9 N/m)
    double shear_stiffness;
    /// Moment per width and curvature that resists bending (0 to 1e6 N m)
    double bending_stiffness;
    /// Viscosity of the cloth divided by its stiffness (0 to 1e6 s)
    double damping;
    /// Newton only: tolerance of Newton's method, relative to the mean edge length. It has converged if the
    /// decrease of the energy corresponds to a root-mean-square displacement of at most the tolerance times
    /// that length (0 to 1)
    double newton_tolerance;
    /// Newton only: resistance of still air, the rate at which the velocity of a free particle decays; 0 is a
    /// vacuum (0 to 1e6 1/s)
    double air_drag;
    /// Velocity of the air; needs wind_rate (-1e9 to 1e9 length/s)
    double wind[3];
    /// The rate at which particles take on the air's velocity relative to a face, along the face's normal;
    /// higher for lighter cloth. 0: no air. Without wind the air is at rest and slows motion (0 to 1e9 1/s)
    double wind_rate;
    /// Newton only: pressure inside closed pieces of cloth in excess of the surrounding pressure; it is
    /// constant, as if a pump maintained it (0 to 1e9 N/m^2)
    double pressure;
} echinus_simulation_options;

ECHINUS_API void echinus_simulation_options_init(echinus_simulation_options* options, size_t size);
// End of options.

/// The simulation of a deformable and its colliders. The same input gives the same positions bit for bit.
typedef struct echinus_simulation echinus_simulation;

/// Creates a simulation. It copies the deformable and keeps the data that it needs of the maps, so all
/// arguments may be destroyed afterwards.
/// @param colliders  [collider_count]
/// @param options    or NULL for the defaults
/// @return ECHINUS_INVALID_OPTIONS, naming the fault; ECHINUS_INVALID_ARGUMENT also for more colliders than
/// memory can hold
ECHINUS_API echinus_status echinus_simulation_create(const echinus_deformable* deformable,
                                                     const echinus_collider* colliders, size_t collider_count,
                                                     const echinus_simulation_options* options,
                                                     echinus_simulation** simulation);

/// Makes an independent copy in the present state.
ECHINUS_API echinus_status echinus_simulation_copy(const echinus_simulation* simulation,
                                                   echinus_simulation** copy);

ECHINUS_API void echinus_simulation_destroy(echinus_simulation* simulation);

/// Returns the state of a simulation without its inputs (docs/saved_states.md).
/// @param state  out, unsigned char
ECHINUS_API echinus_status echinus_simulation_save_state(const echinus_simulation* simulation,
                                                         echinus_array** state);
/// Makes another simulation, with the inputs of the given one, that resumes from a saved state bit for bit.
/// The given simulation does not change.
/// @param bytes  [byte_count]; all bytes are checked before use
/// @return ECHINUS_WRONG_FORMAT, ECHINUS_UNSUPPORTED_VERSION or ECHINUS_DAMAGED for bytes that are not a
/// state of this version; ECHINUS_INVALID_OPTIONS for a state of another simulation, naming the difference
ECHINUS_API echinus_status echinus_simulation_restored(const echinus_simulation* simulation,
                                                       const void* bytes, size_t byte_count,
                                                       echinus_simulation** restored);

/// Computes one frame.
/// @return ECHINUS_DIVERGED, naming the frame; from then on the simulation can only be read
ECHINUS_API echinus_status echinus_simulation_step(echinus_simulation* simulation);

ECHINUS_API size_t echinus_simulation_particle_count(const echinus_simulation* simulation);
/// [3 particle_count] The present positions x, y, z of all particles. The address does not change as long as
/// the simulation exists, and each step overwrites the values.
ECHINUS_API const float* echinus_simulation_positions(const echinus_simulation* simulation);
/// All arrays of the deformable in its present state.
/// @param arrays  out; the caller sets its size; its pointers are valid as long as the simulation exists
ECHINUS_API echinus_status echinus_simulation_read(const echinus_simulation* simulation,
                                                   echinus_deformable_arrays* arrays);

/// Number of frames computed so far.
ECHINUS_API uint32_t echinus_simulation_frame(const echinus_simulation* simulation);
/// Has the rest condition held for the required number of frames?
ECHINUS_API int32_t echinus_simulation_at_rest(const echinus_simulation* simulation);
/// Speed of the fastest particle in the last frame, units per second; infinite before the first.
ECHINUS_API double echinus_simulation_largest_speed(const echinus_simulation* simulation);
/// XXH64 hash of the bits of all positions and velocities.
ECHINUS_API uint64_t echinus_simulation_state_hash(const echinus_simulation* simulation);

/// Times and counts since the simulation began, as in SimulationProfile in simulation.hpp. Times vary from
/// run to run.
typedef struct echinus_simulation_profile {
    size_t size;
    double integration_seconds;
    double constraint_seconds;
    double collision_seconds;
    uint64_t query_count;
    uint64_t contact_count;
    uint64_t map_query_count;
    uint64_t rescued_count;
    uint64_t lost_count;
    uint64_t truncated_count;
    uint64_t measured_pair_count;
    uint64_t unresolved_count;
} echinus_simulation_profile;

/// @param profile  out; the caller sets its size
ECHINUS_API echinus_status echinus_simulation_read_profile(const echinus_simulation* simulation,
                                                           echinus_simulation_profile* profile);

/// The relative deviation of structural constraints from their rest lengths at the end of the last frame;
/// 0.01 is 1 %, and 0 without such constraints. With ECHINUS_SOLVER_JAKOBSEN, it is the residual error of the
/// relaxations.
/// @param root_mean_square, largest  [1] out
ECHINUS_API echinus_status echinus_simulation_residual(const echinus_simulation* simulation,
                                                       double* root_mean_square, double* largest);

/// The given options, with the effective thickness.
/// @param options  out; the caller sets its size
ECHINUS_API echinus_status echinus_simulation_read_options(const echinus_simulation* simulation,
                                                           echinus_simulation_options* options);

ECHINUS_API size_t echinus_simulation_collider_count(const echinus_simulation* simulation);
/// A collider in its present pose.
/// @param collider  out; the caller sets its size; its map is valid as long as the simulation exists. For a
/// deforming collider it is the map of the vertices at the time of the last call of this function
ECHINUS_API echinus_status echinus_simulation_read_collider(const echinus_simulation* simulation,
                                                            size_t index, echinus_collider* collider);

/// Sets the velocities of a collider, which it keeps until they are set again.
/// @param linear, angular  [3] finite
ECHINUS_API echinus_status echinus_simulation_set_collider_velocity(echinus_simulation* simulation,
                                                                    size_t index, const double* linear,
                                                                    const double* angular);

/// The collider moves to this pose during the next frame, at constant velocity and rotating along the shorter
/// arc, and then stays there until the next call.
ECHINUS_API echinus_status echinus_simulation_set_collider_pose(echinus_simulation* simulation, size_t index,
                                                                const echinus_pose* pose);

/// The collider follows keyframes: each frame moves it to the pose of echinus_pose_at() at the frame's end.
/// The collider starts from its present pose, so place it at the present pose of echinus_pose_at() first.
/// Without keys it does not move.
/// @param keys  [key_count]; their times ascend, in seconds since the simulation began
/// @return ECHINUS_INVALID_OPTIONS, naming the key
ECHINUS_API echinus_status echinus_simulation_set_collider_keyframes(echinus_simulation* simulation,
                                                                     size_t index,
                                                                     const echinus_pose_key* keys,
                                                                     size_t key_count);

/// During the next frame the vertices of a collider move to these positions along straight lines; then they
/// stop. The call needs an exact map and the collision of surfaces; the map is rebuilt in this call.
/// @param vertices  [vertex_count] the vertices of the mesh from which the collider's map was built, in its
/// order and frame
/// @return ECHINUS_INVALID_OPTIONS; on failure nothing changes
ECHINUS_API echinus_status echinus_simulation_set_collider_vertices(echinus_simulation* simulation,
                                                                    size_t index, const float* vertices,
                                                                    size_t vertex_count,
                                                                    size_t vertex_stride);

/// Each frame moves the vertices of a collider to the positions that echinus_vertex_cache_at() returns for
/// the frame's end. The cache may be destroyed afterwards.
/// @return as echinus_simulation_set_collider_vertices()
ECHINUS_API echinus_status echinus_simulation_set_collider_cache(echinus_simulation* simulation, size_t index,
                                                                 const echinus_vertex_cache* cache);

/// The load that the deformable exerted on a collider in the last frame by contact, friction and attached
/// particles, averaged over the frame; 0 before the first frame, and always with ECHINUS_SOLVER_JAKOBSEN.
/// @param force   [3] out, N
/// @param torque  [3] out, N m, about the pose's translation, as it moves
ECHINUS_API echinus_status echinus_simulation_load_on(const echinus_simulation* simulation, size_t index,
                                                      double* force, double* torque);

/// Lets a collider move freely from its present velocities in the following frames, as a rigid body of
/// uniform density that gravity and contact with the deformable move. This needs an exact map of a closed
/// mesh and ECHINUS_SOLVER_NEWTON.
/// @param mass  kg, finite, 1e-9 to 1e15
/// @return ECHINUS_INVALID_OPTIONS; on failure nothing changes
ECHINUS_API echinus_status echinus_simulation_set_collider_free(echinus_simulation* simulation, size_t index,
                                                                double mass);

/// A contact of the last frame, between a particle, edge or face of the deformable and a
/// collider, or between two elements of the deformable.
typedef struct echinus_contact_point {
    double position[3]; ///< position on the deformable when the contact last exerted a force; world frame
    double normal[3]; ///< unit; points towards the deformable or, in self-collision, towards the first of the
                      ///< two elements in contact
    double gap;       ///< the distance when the contact last exerted a force; positive
    double normal_impulse;      ///< impulse of the frame along the normal, on the deformable or, in
                                ///< self-collision, on the first of the two elements, N s
    double friction_impulse[3]; ///< impulse of the frame perpendicular to the normal, on the same one, N s
    uint32_t collider;          ///< ECHINUS_NONE: the deformable is in contact with itself
    /// The particles of the deformable's element, followed in self-collision by those of the second one: a
    /// vertex and the three corners of a face, or the two ends of either edge. Unused entries are
    /// ECHINUS_NONE.
    uint32_t particles[4];
} echinus_contact_point;

/// Sets whether the following frames record their contacts; off by default. This setting is not part of a
/// saved state.
ECHINUS_API echinus_status echinus_simulation_record_contacts(echinus_simulation* simulation, int32_t is_on);

/// Returns the contacts that were recorded in the last frame. For each collider, the impulses of its contacts
/// divided by the time step sum to the opposite of the load on it, except for the loads of attached particles
/// and of particles whose displacement was truncated. ECHINUS_SOLVER_JAKOBSEN records none.
/// @param points  out, echinus_contact_point
ECHINUS_API echinus_status echinus_simulation_contact_points(const echinus_simulation* simulation,
                                                             echinus_array** points);

/// Sets the velocity of a particle for the next frame. A pinned particle does not move.
/// @param velocity  [3] finite, units per second
ECHINUS_API echinus_status echinus_simulation_set_particle_velocity(echinus_simulation* simulation,
                                                                    size_t particle, const double* velocity);

/// Sets the wind for one frame.
/// @param wind  [3] velocity of the air, finite, units per second
/// @param rate  per second; higher for lighter cloth; finite, not negative
ECHINUS_API echinus_status echinus_simulation_blow(echinus_simulation* simulation, const double* wind,
                                                   double rate);

// ---- Collision for your own solver (docs/own_solver.md) ----

// Options: particle_collision. Generated by bindings/generate_options; edit bindings/options.toml.
typedef struct echinus_particle_collision_options {
    size_t size;
    /// Coulomb's coefficient of friction between particles and models; 0: no friction (0 to 1e9)
    double friction;
    /// Accept exact maps of open meshes, for which nothing is guaranteed
    int32_t allow_open_colliders;
    /// Threads that share a step; 0: all cores. The results are bit-identical for any number (0 to 1024)
    uint32_t thread_count;
} echinus_particle_collision_options;

ECHINUS_API void echinus_particle_collision_options_init(echinus_particle_collision_options* options,
                                                         size_t size);
// End of options.

/// Keeps the particles of any solver out of models: particle_collision.hpp.
typedef struct echinus_particle_collision echinus_particle_collision;

/// Creates collision for particles. It keeps the data that it needs of the maps, so all arguments may be
/// destroyed afterwards.
/// @param colliders  [collider_count] in their initial poses; their velocities are ignored
/// @param thickness  the distance that particles keep from the surface; not negative
/// @param options    or NULL for the defaults
/// @return as echinus_simulation_create()
ECHINUS_API echinus_status echinus_particle_collision_create(
    const echinus_collider* colliders, size_t collider_count, double thickness,
    const echinus_particle_collision_options* options, echinus_particle_collision** collision);
/// May be NULL.
ECHINUS_API void echinus_particle_collision_destroy(echinus_particle_collision* collision);

/// Moves a collider to a pose during the solver's next step, at constant velocity and rotating along the
/// shorter arc. Then it stops.
ECHINUS_API echinus_status echinus_particle_collision_set_collider_pose(echinus_particle_collision* collision,
                                                                        size_t index,
                                                                        const echinus_pose* pose);
/// Places a collider at a pose at once, without sweeping particles in between.
ECHINUS_API echinus_status echinus_particle_collision_place_collider(echinus_particle_collision* collision,
                                                                     size_t index, const echinus_pose* pose);

/// Sets the friction of one collider, in place of the friction in the options.
ECHINUS_API echinus_status echinus_particle_collision_set_collider_friction(
    echinus_particle_collision* collision, size_t index, double friction);

/// Corrects the particles after a step of the solver, and moves the colliders. ParticleCollision::correct()
/// describes the treatment of NaN.
/// @param previous_positions  [3 particle_count] the positions at the start of the step
/// @param positions       [3 particle_count] in: the solver's positions; out: corrected positions
/// @param velocities      [3 particle_count] in and out, units per second; or NULL
/// @param inverse_masses  [particle_count] 0 for pinned particles; or NULL: all are pushed
/// @param seconds         the duration of the step; positive
/// @param corrected       out: [corrected_count] the indices of corrected particles, ascending; valid
///                        until the next call; or NULL
/// @param corrected_count out; or NULL
ECHINUS_API echinus_status echinus_particle_collision_correct(
    echinus_particle_collision* collision, const float* previous_positions, float* positions,
    float* velocities, const float* inverse_masses, size_t particle_count, double seconds,
    const uint32_t** corrected, size_t* corrected_count);

/// The number of times that a particle that was once outside ended a step inside an exact map, or on the
/// other side of its surface.
ECHINUS_API uint64_t echinus_particle_collision_lost_count(const echinus_particle_collision* collision);

// Options: surface_collision. Generated by bindings/generate_options; edit bindings/options.toml.
typedef struct echinus_surface_collision_options {
    size_t size;
    /// Coulomb's coefficient of friction; 0: no friction (0 to 1e9)
    double friction;
    /// Distance that layers keep from each other; less near small faces. By default the thickness (0 to 1e9),
    /// or ECHINUS_THICKNESS_CHOSEN
    double self_thickness;
    /// Faces do not intersect each other either
    int32_t self_collision;
    /// Separate an initial state in which surfaces intersect or particles are inside the model, instead of
    /// rejecting it
    int32_t untangle;
    /// Threads that share a step; 0: all cores. The results are bit-identical for any number (0 to 1024)
    uint32_t thread_count;
    /// 0
    uint32_t reserved;
} echinus_surface_collision_options;

ECHINUS_API void echinus_surface_collision_options_init(echinus_surface_collision_options* options,
                                                        size_t size);
// End of options.

/// Keeps the faces between the particles of any solver off models and off each other:
/// surface_collision.hpp.
typedef struct echinus_surface_collision echinus_surface_collision;

/// Creates collision for surfaces. It copies the arrays and keeps the data that it needs of the maps.
/// @param positions  [3 particle_count] the initial positions, at which no faces may intersect (but see
/// untangle)
/// @param faces      [3 face_count] the faces between the particles; at least one
/// @param colliders  [collider_count] in their initial poses; their velocities are ignored
/// @param thickness  the distance to keep from colliders; not negative
/// @param options    or NULL for the defaults
/// @return as echinus_simulation_create()
ECHINUS_API echinus_status echinus_surface_collision_create(const float* positions, size_t particle_count,
                                                            const uint32_t* faces, size_t face_count,
                                                            const echinus_collider* colliders,
                                                            size_t collider_count, double thickness,
                                                            const echinus_surface_collision_options* options,
                                                            echinus_surface_collision** collision);
/// May be NULL.
ECHINUS_API void echinus_surface_collision_destroy(echinus_surface_collision* collision);

/// Like echinus_particle_collision_set_collider_pose().
ECHINUS_API echinus_status echinus_surface_collision_set_collider_pose(echinus_surface_collision* collision,
                                                                       size_t index,
                                                                       const echinus_pose* pose);

/// Corrects the particles after a step of the solver, and moves the colliders. The step starts from
/// echinus_surface_collision_positions(), at which the previous step ended.
/// @param positions       [3 particle_count] in: the solver's positions; out: corrected positions
/// @param velocities      [3 particle_count] in and out, units per second; or NULL
/// @param particle_count  the number of particles of the object
/// @param seconds         the duration of the step; positive
/// @param corrected       out: [corrected_count] the indices of corrected particles, ascending; valid
///                        until the next call; or NULL
/// @param corrected_count out; or NULL
ECHINUS_API echinus_status echinus_surface_collision_correct(echinus_surface_collision* collision,
                                                             float* positions, float* velocities,
                                                             size_t particle_count, double seconds,
                                                             const uint32_t** corrected,
                                                             size_t* corrected_count);

/// [3 particle_count] The present positions, which are free of intersections. The address does not change.
ECHINUS_API const float* echinus_surface_collision_positions(const echinus_surface_collision* collision);
/// The number of unresolved pairs of elements, for which no free space was proven, summed over all steps.
/// While it is 0, no faces intersect, except because of rounding far from the origin (docs/limits.md).
ECHINUS_API uint64_t echinus_surface_collision_unresolved_count(const echinus_surface_collision* collision);

// ---- Scenes: simulations as JSON (docs/scenes.md) ----

typedef struct echinus_scene echinus_scene;

/// Reads a scene.
/// @return ECHINUS_UNREADABLE or ECHINUS_INVALID_SCENE, naming the key
ECHINUS_API echinus_status echinus_scene_read(const char* path, echinus_scene** scene);

/// Reads a scene from text.
/// @param name  replaces the path in error messages; files of the scene are looked up in its folder, if it
/// has one
ECHINUS_API echinus_status echinus_scene_parse(const char* json, const char* name, echinus_scene** scene);

ECHINUS_API void echinus_scene_destroy(echinus_scene* scene);

/// The number of frames after which the simulation should end at the latest.
ECHINUS_API uint32_t echinus_scene_frame_limit(const echinus_scene* scene);

/// Reads or generates the meshes of a scene, makes the requested repairs, builds the maps and creates the
/// simulation. Files are looked up in the given folders, then in the scene's folder and in its ../models.
/// @param folders  [folder_count] paths
/// @return as echinus_mesh_read(), the builds and echinus_simulation_create()
ECHINUS_API echinus_status echinus_simulation_from_scene(const echinus_scene* scene,
                                                         const char* const* folders, size_t folder_count,
                                                         uint32_t thread_count,
                                                         echinus_simulation** simulation);

#ifdef __cplusplus
}
#endif

#endif
