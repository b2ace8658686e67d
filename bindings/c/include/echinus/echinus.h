#ifndef ECHINUS_ECHINUS_H
#define ECHINUS_ECHINUS_H

#include <echinus/version.h>

#include <stddef.h>
#include <stdint.h>

/// Echinus for C99 and for whatever calls C. Library libechinus-c; docs/c.md begins with a whole program.
///
/// Errors. A function that can fail returns a status, and echinus_last_error() has a sentence about it. No
/// exception crosses this border. A function that fails sets the handle that it would have made to NULL, and
/// changes nothing else unless its declaration says so.
///
/// Null pointers. An argument that is NULL is ECHINUS_INVALID_ARGUMENT, unless its declaration says "or
/// NULL". An array of 0 elements may be NULL. The functions that end in _destroy take NULL and do nothing.
/// Functions that return a value and no status return 0 or NULL for a handle that is NULL.
///
/// Ownership. A handle that a function gives through an echinus_..._ ** belongs to the caller, who destroys
/// it once by the _destroy of its type. A function reads during the call what it takes as const, and does not
/// keep it, unless its declaration says so. A pointer that it returns belongs to the handle that was asked.
///
/// Threads. Meshes, maps, tetrahedra, deformables, scenes and arrays never change: any number of threads may
/// use one at once. A builder and a simulation are for one thread at a time. thread_count is how many threads
/// a call may use; 0 stands for all cores. No answer depends on it.
///
/// Strides. Points are x, y, z as float. A batch of them is the address of the first x, a count, and the
/// bytes from one x to the next: a multiple of 4 and at least 12; 0 stands for 12. Answers lie one after the
/// other and do not overlap the points.
///
/// Structs that may grow begin with their size. Options are filled by their _init function, which writes the
/// defaults and the size; of results the caller sets .size before the call. New members will be added at the
/// end, and zero will be their default. So a program and a library of different versions understand each
/// other, and a program that sets a member which the library does not have gets ECHINUS_INVALID_ARGUMENT.
/// Flags are 0 or 1, and what is called reserved in options is 0; other numbers are ECHINUS_INVALID_ARGUMENT.
///
/// Frames, units and words are those of docs/conventions.md: right-handed, lengths in the caller's unit,
/// angles in radians, faces counter-clockwise seen from outside, rotations as unit quaternions w, x, y, z.
/// "Local" is the frame of the mesh that a map was built from, "world" is where a collider stands.
///
/// Origins. A mesh whose file has it so far from 0 that floats could not hold its shape has an origin, and so
/// have its map and its tetrahedra: everything local is then relative to it. It is 0 for all others.
/// echinus_to_local() makes local points of doubles. A collider's pose and scale place the file's frame:
/// world = pose (scale (origin + local)). Simulations refuse an origin that is not 0.

#ifdef __cplusplus
extern "C" {
#endif

#ifndef ECHINUS_API
#if defined(__GNUC__)
#define ECHINUS_API __attribute__((visibility("default")))
#else
#define ECHINUS_API
#endif
#endif

// ---- Errors and the library ----

/// The kinds of errors. Values are only ever added.
typedef enum echinus_status {
    ECHINUS_OK = 0,
    ECHINUS_UNREADABLE = 1,          ///< a file does not exist, is a directory, or cannot be read
    ECHINUS_UNWRITABLE = 2,          ///< a file cannot be written: permission, missing folder, full disk
    ECHINUS_WRONG_FORMAT = 3,        ///< the bytes are not of the format that the name or the reader expects
    ECHINUS_DAMAGED = 4,             ///< the right format, but truncated or self-contradictory
    ECHINUS_UNSUPPORTED_VERSION = 5, ///< a map file of a version that this library does not read
    ECHINUS_INVALID_MESH = 6,        ///< no faces, a coordinate that is not finite, an index out of range
    ECHINUS_INVALID_OPTIONS = 7,     ///< an option outside the range that its declaration states
    ECHINUS_INVALID_SCENE = 8,       ///< a scene with an unknown key, a missing one or a value out of range
    ECHINUS_DIVERGED = 9,            ///< a simulation whose positions are not finite or have left all bounds
    ECHINUS_INVALID_ARGUMENT =
        100, ///< NULL, a wrong size or stride, an index out of range, a map of another kind
    ECHINUS_OUT_OF_MEMORY = 101, ///< memory did not suffice
    ECHINUS_INTERNAL = 102       ///< a fault of the library: please report it
} echinus_status;

/// The name of a status as it stands above, "ECHINUS_OK" for instance; "unknown status" for any other number.
ECHINUS_API const char* echinus_status_name(echinus_status status);

/// One sentence about the last call of this thread that failed: which file, face, byte or argument, what was
/// found and what was expected. Empty when none has failed. Stays until the next failure on this thread.
ECHINUS_API const char* echinus_last_error(void);

/// The version of the library that the program runs with, such as "0.2.0". ECHINUS_VERSION_STRING is that of
/// the header.
ECHINUS_API const char* echinus_version(void);

/// The vector instructions that batches use: "avx512", "avx2", "sse4", "neon" or "scalar". They affect speed
/// only.
ECHINUS_API const char* echinus_instruction_set(void);

/// The sets that this machine has, the widest first: the one of this number, or NULL beyond the last.
ECHINUS_API const char* echinus_available_instruction_set(size_t number);

/// Selects another set for the whole process, from the next query on. Any thread.
ECHINUS_API echinus_status echinus_use_instruction_set(const char* name);

// ---- Arrays ----

/// An array whose length only the library knows beforehand. The function that gives it names the type of its
/// elements.
typedef struct echinus_array echinus_array;

ECHINUS_API const void* echinus_array_data(const echinus_array* array);
/// The number of elements, not of bytes.
ECHINUS_API size_t echinus_array_count(const echinus_array* array);
ECHINUS_API void echinus_array_destroy(echinus_array* array);

// ---- Meshes ----

/// Triangles with common vertices, all indices in range and all coordinates that faces use finite.
typedef struct echinus_mesh echinus_mesh;

/// Copies vertices and faces. Nothing is repaired: echinus_mesh_inspect() reports faults.
/// @param faces  [3 face_count] vertex indices, counter-clockwise seen from outside
/// @return ECHINUS_INVALID_MESH without faces, or for an index out of range or a used vertex that is not
/// finite
ECHINUS_API echinus_status echinus_mesh_create(const float* vertices, size_t vertex_count,
                                               size_t vertex_stride, const uint32_t* faces, size_t face_count,
                                               echinus_mesh** mesh);

/// The same of vertices in double. Where floats could not hold the shape, the mesh has an origin.
/// @param vertices  [3 vertex_count]
ECHINUS_API echinus_status echinus_mesh_create_double(const double* vertices, size_t vertex_count,
                                                      const uint32_t* faces, size_t face_count,
                                                      echinus_mesh** mesh);

/// Reads OBJ, PLY, STL, OFF, glTF, GLB or 3DS, by the extension of the name. All meshes of the file are
/// joined, polygons are triangulated and equal positions are welded.
/// @return ECHINUS_UNREADABLE, ECHINUS_WRONG_FORMAT, ECHINUS_DAMAGED or ECHINUS_INVALID_MESH
ECHINUS_API echinus_status echinus_mesh_read(const char* path, echinus_mesh** mesh);

/// Writes OBJ, PLY (binary), STL (binary) or OFF, by the extension of the name. The file appears whole or not
/// at all.
/// @return ECHINUS_UNWRITABLE or ECHINUS_WRONG_FORMAT
ECHINUS_API echinus_status echinus_mesh_write(const echinus_mesh* mesh, const char* path);

/// A torus about the z axis, centred at the origin like the other two shapes.
/// @return ECHINUS_INVALID_OPTIONS unless 0 < minor_radius < major_radius, their sum is finite as a float,
/// and both counts are at least 3
ECHINUS_API echinus_status echinus_mesh_torus(double major_radius, double minor_radius,
                                              uint32_t major_segments, uint32_t minor_segments,
                                              echinus_mesh** mesh);
/// A sphere of meridians and parallels with its poles on the z axis.
/// @return ECHINUS_INVALID_OPTIONS unless radius > 0 and finite as a float, meridian_count >= 3 and
/// parallel_count >= 2
ECHINUS_API echinus_status echinus_mesh_sphere(double radius, uint32_t meridian_count,
                                               uint32_t parallel_count, echinus_mesh** mesh);
/// A box, each side cut into segments x segments squares of two faces.
/// @param size  [3] lengths of the edges
/// @return ECHINUS_INVALID_OPTIONS unless all lengths are positive and finite as floats, and segments >= 1
ECHINUS_API echinus_status echinus_mesh_box(const double* size, uint32_t segments, echinus_mesh** mesh);

ECHINUS_API void echinus_mesh_destroy(echinus_mesh* mesh);

ECHINUS_API size_t echinus_mesh_vertex_count(const echinus_mesh* mesh);
/// [3 vertex_count] x, y, z, relative to the origin
ECHINUS_API const float* echinus_mesh_vertices(const echinus_mesh* mesh);
/// [3] where the frame of the vertices begins in that of the file; 0 for most meshes
ECHINUS_API const double* echinus_mesh_origin(const echinus_mesh* mesh);
ECHINUS_API size_t echinus_mesh_face_count(const echinus_mesh* mesh);
/// [3 face_count]
ECHINUS_API const uint32_t* echinus_mesh_faces(const echinus_mesh* mesh);

#define ECHINUS_FIRST_FACE_COUNT 8

/// How often a fault occurs, and the first faces at which it does.
typedef struct echinus_fault {
    uint64_t count;
    uint32_t first_face_count; ///< how many of the following are set
    uint32_t first_faces[ECHINUS_FIRST_FACE_COUNT];
    uint32_t reserved; ///< 0
} echinus_fault;

/// Vertices are distinguished by index, but those of edges that are not balanced count as one where they are
/// no farther apart than 2^-21 of the radius, as they do for maps.
typedef struct echinus_mesh_report {
    size_t size;
    uint64_t face_count;
    uint64_t vertex_count;
    uint64_t component_count; ///< sets of faces joined by common vertices
    int32_t closed;           ///< every edge is balanced: equally many faces run along it in each direction
    int32_t manifold;         ///< at most two faces at each edge, and one fan of faces at each vertex
    echinus_fault border_edges;
    echinus_fault nonmanifold_edges;
    echinus_fault misoriented_edges;
    echinus_fault duplicate_faces;
    echinus_fault degenerate_faces;
    double signed_volume; ///< positive where faces turn outwards; of limited meaning when not closed
    double centre[3];     ///< of the smallest sphere that encloses all vertices used by faces
    double radius;
    /// The step of float at the largest coordinate, where all coordinates are floats and half of this step
    /// exceeds a step of a map's lattice; otherwise 0. Finer detail is lost.
    double rounding_step;
    int32_t orientable; ///< faces can be turned so that all edges with two faces are balanced
    int32_t reserved;   ///< 0
} echinus_mesh_report;

/// Points in double as floats relative to an origin. Without a handle; any thread.
/// @param points  [3 count]
/// @param origin  [3] of a mesh, a map or tetrahedra
/// @param local   [3 count] out
ECHINUS_API echinus_status echinus_to_local(const double* points, size_t count, const double* origin,
                                            float* local);

/// @param report  out; its size is set
ECHINUS_API echinus_status echinus_mesh_inspect(const echinus_mesh* mesh, echinus_mesh_report* report);

// Options: repair. By bindings/generate_options from bindings/options.toml: edit that.
/// The steps that a repair may take. All off by default. None opens a closed mesh.
typedef struct echinus_repair_options {
    size_t size;
    /// Of faces with the same three vertices drop opposite ones in pairs, and of the rest keep the first
    int32_t drop_duplicate_faces;
    /// Where two pairs of faces fill the same quadrilateral, each along its own diagonal, drop one pair
    int32_t drop_doubled_patches;
    /// Turn round closed parts whose faces look inwards; cavities stay cavities
    int32_t flip_inside_out;
    /// 0
    int32_t reserved;
    /// Fill holes whose border has at most so many edges, with the triangles of least area. The rim of a
    /// sheet, whose filling would have more than a third of the sheet's area, is no hole (0 to 256)
    uint32_t max_hole_edges;
    /// Drop faces with the solid on both sides, a patch of neighbours at a time, where no edge that stays is
    /// less balanced for it: an engine in the body of a car
    int32_t drop_inner_faces;
    /// Make solids of the parts that are not closed, so thick, half of it on either side; 0: none (not
    /// negative)
    double sheet_thickness;
    /// Join vertices at the edges of holes that are no farther apart than weld_distance, and fill holes that
    /// are no wider
    int32_t close_seams;
    /// Drop faces without area at the edges of holes, unless they fill a seam
    int32_t drop_loose_slivers;
    /// Turn faces so that neighbours agree, in parts that are closed by themselves
    int32_t orient_faces;
    /// 0
    int32_t reserved_2;
    /// How wide seams may be; at most the radius of the bounding sphere, and at least 2^-21 of it counts,
    /// within which maps take two vertices for one (not negative)
    double weld_distance;
} echinus_repair_options;

ECHINUS_API void echinus_repair_options_init(echinus_repair_options* options, size_t size);
// End of options.

typedef struct echinus_repair_report {
    size_t size;
    uint64_t duplicate_faces_dropped;
    uint64_t doubled_patch_faces_dropped;
    uint64_t components_flipped;
    uint64_t holes_closed; ///< before components are flipped
    uint64_t holes_left;   ///< with more edges, or rims of sheets; 0 unless holes were to be closed
    uint64_t inner_faces_dropped;
    uint64_t sheets_thickened;
    uint64_t faces_added;     ///< to fill seams, to close holes and to thicken sheets
    uint64_t vertices_welded; ///< in whose place faces refer to others now
    uint64_t slivers_dropped; ///< loose ones, and faces that lost their area by welding
    uint64_t faces_turned;    ///< so that neighbours agree
    uint64_t seams_filled;    ///< holes without width
} echinus_repair_report;

/// A repaired copy of a mesh. Faces keep their order, new ones come after them. Vertices stay as they are but
/// for those of sheets that are thickened.
/// @param report         out, its size is set; or NULL
/// @param dropped_faces  out, uint32_t: numbers of the dropped faces in the given mesh, ascending; those that
///                       closed a hole have the numbers after the mesh's; or NULL
/// @return ECHINUS_INVALID_MESH; ECHINUS_INVALID_OPTIONS for more edges than 256, or a thickness or a weld
/// distance that does not suit the mesh
ECHINUS_API echinus_status echinus_mesh_repair(const echinus_mesh* mesh,
                                               const echinus_repair_options* options, echinus_mesh** repaired,
                                               echinus_repair_report* report, echinus_array** dropped_faces);

/// A copy in which vertices at equal positions are joined and those that no face uses are dropped.
ECHINUS_API echinus_status echinus_mesh_weld(const echinus_mesh* mesh, echinus_mesh** welded);

/// Generalised winding number of a point, by brute force over all faces: for tests.
/// @param point  [3]
ECHINUS_API echinus_status echinus_mesh_winding_number(const echinus_mesh* mesh, const double* point,
                                                       double* winding_number);
/// Distance from a point to the nearest point of the surface, by brute force over all faces: for tests.
/// @param point  [3]
ECHINUS_API echinus_status echinus_mesh_unsigned_distance(const echinus_mesh* mesh, const double* point,
                                                          double* distance);

/// Which faces of two meshes intersect; touching counts. Decided exactly.
/// @param pairs  out, uint32_t[2]: a face of a and a face of b, ascending
ECHINUS_API echinus_status echinus_mesh_intersecting_pairs(const echinus_mesh* a, const echinus_mesh* b,
                                                           echinus_array** pairs);
/// Which faces of one mesh intersect beyond the vertices and edges that they share. Decided exactly.
/// @param pairs  out, uint32_t[2]: two faces, ascending
ECHINUS_API echinus_status echinus_mesh_self_intersecting_pairs(const echinus_mesh* mesh,
                                                                echinus_array** pairs);

// ---- Maps: build, look at ----

/// An exact map, a distance map, or a structure of the caller's own behind two functions.
typedef struct echinus_map echinus_map;

typedef enum echinus_map_kind {
    ECHINUS_MAP_EXACT = 1,
    ECHINUS_MAP_DISTANCE = 2,
    ECHINUS_MAP_CUSTOM = 3
} echinus_map_kind;

/// Which places are inside, by the winding number of the surface around them.
typedef enum echinus_inside_rule {
    ECHINUS_INSIDE_NONZERO = 0, ///< every winding number but 0
    ECHINUS_INSIDE_PARITY = 1   ///< an odd winding number: a part within a part is a hole
} echinus_inside_rule;

/// Where the rays of a map start.
typedef enum echinus_centre_choice {
    ECHINUS_CENTRE_BOUNDING_SPHERE = 0, ///< the centre of the smallest enclosing sphere
    ECHINUS_CENTRE_SEARCH = 1           ///< the place that promises the better map; some twenty coarse builds
} echinus_centre_choice;

// Options: exact_map. By bindings/generate_options from bindings/options.toml: edit that.
typedef struct echinus_exact_map_options {
    size_t size;
    /// Each octant of directions has divisions^2 cells; 0: chosen by the mesh (0 to 512)
    uint32_t divisions;
    /// Threads that build the map; 0: all cores. The map does not depend on it
    uint32_t thread_count;
    /// The finest map that takes no more; 0: no limit. Not together with a number of cells (0 to 4e9 bytes)
    uint64_t byte_budget;
    /// The inside where parts of the model overlap: their union, or where an odd number of them is
    echinus_inside_rule rule;
    /// Where rays start: the centre of the bounding sphere, or a place searched for short lists
    echinus_centre_choice centre;
    /// False: open surfaces are built sooner, by up to 0.2 s, and the same answers take up to eight times as
    /// long: for maps that last for a frame
    int32_t find_certain_gaps;
    /// 0
    uint32_t reserved;
} echinus_exact_map_options;

ECHINUS_API void echinus_exact_map_options_init(echinus_exact_map_options* options, size_t size);
// End of options.

/// Builds an exact map: inside or outside in integer arithmetic, and the true nearest point of the surface.
/// The same bytes for any number of threads.
/// @param options  or NULL for the defaults
/// @return ECHINUS_INVALID_MESH also when the bounding radius lies outside [1e-15, 1e15];
/// ECHINUS_INVALID_OPTIONS
ECHINUS_API echinus_status echinus_map_build_exact(const echinus_mesh* mesh,
                                                   const echinus_exact_map_options* options,
                                                   echinus_map** map);

/// How a distance map divides the directions around its centre.
typedef enum echinus_direction_grid {
    ECHINUS_GRID_SPHERICAL = 0,
    ECHINUS_GRID_OCTAHEDRAL = 1,
    ECHINUS_GRID_CUBE = 2,
    ECHINUS_GRID_ELLIPSOIDAL = 3
} echinus_direction_grid;

/// How vertices that linear interpolation between samples misses are corrected for.
typedef enum echinus_vertex_correction {
    ECHINUS_CORRECTION_NONE = 0,
    ECHINUS_CORRECTION_PAPER = 1,
    ECHINUS_CORRECTION_SIGNED = 2
} echinus_vertex_correction;

/// How one distance is stored.
typedef enum echinus_entry_format {
    ECHINUS_ENTRY_FLOAT32 = 0,
    ECHINUS_ENTRY_UNORM16 = 1
} echinus_entry_format;

/// The axis of the mesh that the poles of a grid lie on.
typedef enum echinus_pole_axis {
    ECHINUS_POLE_X = 0,
    ECHINUS_POLE_Y = 1,
    ECHINUS_POLE_Z = 2
} echinus_pole_axis;

// Options: distance_map. By bindings/generate_options from bindings/options.toml: edit that.
typedef struct echinus_distance_map_options {
    size_t size;
    /// How directions are divided
    echinus_direction_grid grid;
    /// Spherical and ellipsoidal grid: samples of longitude (4 to 8192)
    uint32_t longitude_count;
    /// Spherical and ellipsoidal grid: samples of colatitude (4 to 8192)
    uint32_t colatitude_count;
    /// Octahedral grid and cube: into how many parts each edge is cut (4 to 4096)
    uint32_t divisions;
    /// How vertices between the samples are corrected for
    echinus_vertex_correction correction;
    /// How a distance is stored; unorm16 takes half the bytes and is off by at most 7.6e-6 R, on octahedral
    /// and ellipsoidal grids 1.4e-5 R
    echinus_entry_format entry_format;
    /// Spherical and ellipsoidal grid: axis of the mesh through the poles of the directions, where samples
    /// crowd
    echinus_pole_axis pole_axis;
    /// Where rays start: the centre of the bounding sphere, or a place searched for few wrong answers beside
    /// the surface
    echinus_centre_choice centre;
    /// Threads that build the map; 0: all cores. The map does not depend on it
    uint32_t thread_count;
    /// 0
    uint32_t reserved;
} echinus_distance_map_options;

ECHINUS_API void echinus_distance_map_options_init(echinus_distance_map_options* options, size_t size);
// End of options.

/// Builds a distance map: sorted distances along a grid of rays, interpolated; fast, and wrong in places.
/// @param options  or NULL for the defaults
ECHINUS_API echinus_status echinus_map_build_distance(const echinus_mesh* mesh,
                                                      const echinus_distance_map_options* options,
                                                      echinus_map** map);

ECHINUS_API void echinus_map_destroy(echinus_map* map);

typedef struct echinus_map_info {
    size_t size;
    echinus_map_kind kind;
    float centre[3];      ///< where the rays start, local; 0 for a custom map, like all that follows
    float radius;         ///< every vertex of the mesh lies within it
    uint32_t face_count;  ///< of the mesh
    uint64_t byte_count;  ///< of all that queries read
    uint64_t source_hash; ///< identifies the mesh and the options that the map was built from
    double origin[3];     ///< of the local frame, in the frame of the mesh's file
} echinus_map_info;

/// @param info  out; its size is set
ECHINUS_API echinus_status echinus_map_describe(const echinus_map* map, echinus_map_info* info);

typedef struct echinus_exact_map_statistics {
    size_t size;
    uint32_t face_count;
    uint32_t dropped_faces; ///< without area on the lattice: they count for distances only
    uint32_t longest_list;  ///< most faces of one band
    float mean_list;
    float expected_tests;       ///< faces that a query near the surface looks at
    float certain_share;        ///< of the bounding sphere's volume: answers known beforehand; 1 if closed
    float uncertain_directions; ///< share of directions along which an answer is computed somewhere
    uint32_t reserved;          ///< 0
} echinus_exact_map_statistics;

/// The findings of the build of an exact map.
ECHINUS_API echinus_status echinus_map_exact_statistics(const echinus_map* map,
                                                        echinus_exact_map_statistics* statistics);

typedef struct echinus_distance_map_statistics {
    size_t size;
    uint32_t face_count;
    uint32_t dropped_faces;
    uint32_t max_entries;       ///< of one direction
    uint32_t corrected_entries; ///< moved by the vertex correction
    uint32_t clamped_entries;   ///< corrections that were cut short
    float wrong_parity_share;   ///< of directions that see a hole; 0 when the mesh is closed
} echinus_distance_map_statistics;

/// The findings of the build of a distance map.
ECHINUS_API echinus_status echinus_map_distance_statistics(const echinus_map* map,
                                                           echinus_distance_map_statistics* statistics);

/// The surface of a map as a mesh, in the local frame: the mesh on the lattice of an exact map, or the layers
/// that a distance map interpolates.
/// @param classes  out, uint32_t [face_count]: the longest list that contains the face (exact map), or its
/// layer
///                 (distance map); or NULL
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
/// The map that echinus_map_build_exact() would build of these vertices. Memory of the map before is used
/// again if that map was destroyed.
ECHINUS_API echinus_status echinus_map_builder_rebuild(echinus_map_builder* builder, const float* vertices,
                                                       size_t vertex_count, size_t vertex_stride,
                                                       echinus_map** map);
ECHINUS_API void echinus_map_builder_destroy(echinus_map_builder* builder);

// ---- Map files ----

/// Writes a map file. It appears whole or not at all.
/// @return ECHINUS_UNWRITABLE; ECHINUS_INVALID_ARGUMENT for a custom map
ECHINUS_API echinus_status echinus_map_save(const echinus_map* map, const char* path);

/// The bytes of a map file.
/// @param bytes  out, unsigned char
ECHINUS_API echinus_status echinus_map_serialise(const echinus_map* map, echinus_array** bytes);

/// Maps a file into memory, verifies it and reads it in place. The file may be replaced or removed meanwhile,
/// but must not be overwritten in place.
/// @return ECHINUS_UNREADABLE, ECHINUS_WRONG_FORMAT, ECHINUS_UNSUPPORTED_VERSION or ECHINUS_DAMAGED
ECHINUS_API echinus_status echinus_map_load(const char* path, echinus_map** map);

/// A map that reads bytes of the caller in place, after it verified them.
/// @param bytes    at an address that is a multiple of 8; unchanged until release is called
/// @param release  called with `context` once the map and all simulations that use it are gone, from the
///                 thread that destroys the last of them; or NULL. Not called if this call fails
/// @param context  the caller's own, or NULL
/// @param name     stands for the path in errors
ECHINUS_API echinus_status echinus_map_view(const void* bytes, size_t byte_count,
                                            void (*release)(void* context), void* context, const char* name,
                                            echinus_map** map);

// ---- Custom maps ----

struct echinus_contact;

/// A structure of the caller's own that colliders ask in place of a map. Points are x, y, z, one after the
/// other, in its own frame. Any number of threads may call at once. The functions must not leave by an
/// exception or longjmp.
typedef struct echinus_custom_map {
    size_t size;
    void* context; ///< is passed to the functions
    /// @param inside  [count] out: 1 inside, 0 outside
    void (*contains)(void* context, const float* points, size_t count, uint8_t* inside);
    /// A contact for each particle that is inside, or outside and no farther from the surface than the
    /// margin.
    /// @param contacts  [count] out: every element must be written
    void (*contacts)(void* context, const float* points, size_t count, float margin,
                     struct echinus_contact* contacts);
    /// Called once the map and all simulations that use it are gone; or NULL. Not called where the map was
    /// not made.
    void (*release)(void* context);
} echinus_custom_map;

/// @param custom  its size is set; copied
ECHINUS_API echinus_status echinus_map_from_custom(const echinus_custom_map* custom, echinus_map** map);

// ---- Queries of maps, in the local frame ----
//
// NaN or infinity in a point: outside, no contact, nothing met. A call takes up to 120 KB of the stack.
// Batches are several times as fast as calls for single points, and give the same bits. Custom maps are asked
// through colliders: here they are ECHINUS_INVALID_ARGUMENT.

/// The part of a triangle that the nearest point lies on.
typedef enum echinus_feature {
    ECHINUS_FEATURE_UNKNOWN = 0,
    ECHINUS_FEATURE_FACE = 1,
    ECHINUS_FEATURE_EDGE = 2,
    ECHINUS_FEATURE_VERTEX = 3
} echinus_feature;

/// The answer for one particle. Without a contact: point is the particle, depth and normal are 0, face is -1.
typedef struct echinus_contact {
    float point[3];  ///< where the push-out leads
    float normal[3]; ///< unit, out of the solid
    float depth;     ///< distance to point: positive inside, negative outside
    int32_t face;    ///< of the mesh; -1 where it is not known
    uint8_t inside;
    uint8_t certain; ///< 0 where the mesh is open and its winding number within 0.1 of where the side turns
    uint8_t feature; ///< an echinus_feature
} echinus_contact;

/// Which points are inside.
/// @param inside  [count] out: 1 inside, 0 outside
ECHINUS_API echinus_status echinus_map_contains(const echinus_map* map, const float* points, size_t count,
                                                size_t stride, uint32_t thread_count, uint8_t* inside);

/// Which points are inside, and whether that is certain. One point after the other, on one thread.
/// @param inside   [count] out
/// @param certain  [count] out: 0 where the mesh is open and its winding number within 0.1 of where the side
/// turns
ECHINUS_API echinus_status echinus_map_classify(const echinus_map* map, const float* points, size_t count,
                                                size_t stride, uint8_t* inside, uint8_t* certain);

/// Inside or not, how deep, and which way out.
/// @param margin    points outside get a contact too when the surface is at most this far; not negative
/// @param contacts  [count] out
ECHINUS_API echinus_status echinus_map_contacts(const echinus_map* map, const float* points, size_t count,
                                                size_t stride, float margin, uint32_t thread_count,
                                                echinus_contact* contacts);

/// How far each point is from the surface, however far that is: negative inside, positive outside, the
/// opposite of depth. Where it is 0, the sign bit tells the side. Only exact maps can tell. NaN in a point
/// gives NaN, infinity gives infinity, and a gradient of 0.
/// @param distances  [count] out
/// @param gradients  [3 count] out: unit vectors along which the distance grows fastest; or NULL
ECHINUS_API echinus_status echinus_map_signed_distance(const echinus_map* map, const float* points,
                                                       size_t count, size_t stride, uint32_t thread_count,
                                                       float* distances, float* gradients);

/// How often the surface goes around each point, counted with sign: a whole number where it is closed, else
/// the generalised winding number. Only exact maps can tell. NaN in a point gives NaN, infinity 0.
/// @param tolerance        the numbers may be off by this much, but not to the other side of a half; not
///                         negative, and 0 counts as 1e-8
/// @param winding_numbers  [count] out
ECHINUS_API echinus_status echinus_map_winding_number(const echinus_map* map, const float* points,
                                                      size_t count, size_t stride, float tolerance,
                                                      uint32_t thread_count, float* winding_numbers);

/// Where a particle that moves along a segment first meets the surface.
typedef struct echinus_sweep_hit {
    float fraction;   ///< of the segment; 1 without a crossing
    float point[3];   ///< where it meets the surface; the end of the segment without a crossing
    float normal[3];  ///< of the face, out of the solid; 0 without a crossing
    int32_t face;     ///< -1 without a crossing
    uint8_t entering; ///< the crossing leads from outside to inside
} echinus_sweep_hit;

/// The first crossing of each segment. Only exact maps can tell.
/// @param hits  [count] out
ECHINUS_API echinus_status echinus_map_sweep(const echinus_map* map, const float* from, size_t from_stride,
                                             const float* to, size_t to_stride, size_t count,
                                             echinus_sweep_hit* hits);

// ---- Triangles against the surface of an exact map, in the local frame ----
//
// Triangles are nine floats, corner after corner; their stride is a multiple of 4 and at least 36; 0 stands
// for 36. A triangle with two equal corners is an edge, one with three a point. One with a corner that is not
// finite is nowhere.

/// Which triangles have a point in common with the surface.
/// @param intersecting  [count] out: 0 or 1
ECHINUS_API echinus_status echinus_map_intersects(const echinus_map* map, const float* triangles,
                                                  size_t count, size_t stride, uint8_t* intersecting);

typedef struct echinus_clearance {
    float distance; ///< never more than the true one
    int32_t face;   ///< that is so far; -1 where none is within the farthest distance
} echinus_clearance;

/// How far each triangle is from the surface.
/// @param farthest    beyond it nothing is looked for; not negative, may be infinite
/// @param clearances  [count] out
ECHINUS_API echinus_status echinus_map_clearance(const echinus_map* map, const float* triangles, size_t count,
                                                 size_t stride, float farthest,
                                                 echinus_clearance* clearances);

typedef struct echinus_triangle_sweep_hit {
    float fraction; ///< of the way; until there the triangle does not meet the surface
    int32_t face;   ///< that it comes to; -1 where it meets none
} echinus_triangle_sweep_hit;

/// Where triangles whose corners move along straight lines first come to the surface. Ways that begin or end
/// farther from the map's centre than 10^11 of its radii are not followed: they meet nothing.
/// @param hits  [count] out
ECHINUS_API echinus_status echinus_map_sweep_triangles(const echinus_map* map, const float* from,
                                                       size_t from_stride, const float* to, size_t to_stride,
                                                       size_t count, echinus_triangle_sweep_hit* hits);

/// The faces that come within reach of each triangle of a mesh.
/// @param triangles  [3 triangle_count] vertex indices
/// @param reach      not negative; 0: faces that touch
/// @param offsets    out, uint32_t [triangle_count + 1]: where the list of each triangle begins
/// @param faces      out, uint32_t: list after list, each ascending
ECHINUS_API echinus_status echinus_map_faces_within(const echinus_map* map, const float* vertices,
                                                    size_t vertex_count, size_t vertex_stride,
                                                    const uint32_t* triangles, size_t triangle_count,
                                                    float reach, uint32_t thread_count,
                                                    echinus_array** offsets, echinus_array** faces);

// ---- Colliders ----

/// Rotate, then translate.
typedef struct echinus_pose {
    double rotation[4]; ///< unit quaternion w, x, y, z, to 1e-4
    double translation[3];
} echinus_pose;

/// The rotation by an angle about an axis, counter-clockwise seen against the axis.
/// @param axis      [3] of any length but zero; finite
/// @param rotation  [4] out: w, x, y, z
ECHINUS_API echinus_status echinus_rotation_about(const double* axis, double angle_rad, double* rotation);

/// A map in the world: a plain value of the caller's. Its map must outlive its use, except in a simulation,
/// which keeps what it needs. In a row of colliders all have the size of the first.
typedef struct echinus_collider {
    size_t size;
    const echinus_map* map;
    echinus_pose pose;
    double scale[3];            ///< along the axes of the map, before the pose; not 0, finite
    double linear_velocity[3];  ///< of the pose's translation, units per second
    double angular_velocity[3]; ///< about the pose's translation, world axes, radians per second
} echinus_collider;

/// A collider at rest in the map's own frame.
ECHINUS_API void echinus_collider_init(echinus_collider* collider, size_t size, const echinus_map* map);

/// As echinus_map_contains(), in the world, on one thread, for maps of every kind.
ECHINUS_API echinus_status echinus_collider_contains(const echinus_collider* collider, const float* points,
                                                     size_t count, size_t stride, uint8_t* inside);

/// As echinus_map_contacts(), in the world, on one thread, for maps of every kind.
ECHINUS_API echinus_status echinus_collider_contacts(const echinus_collider* collider, const float* points,
                                                     size_t count, size_t stride, float margin,
                                                     echinus_contact* contacts);

/// Where particles first meet a collider that moves while they move, from the previous pose to its present
/// one. `point` is where the point of the surface that was met lies now. Distance maps and custom maps meet
/// nothing.
ECHINUS_API echinus_status echinus_collider_sweep(const echinus_collider* collider,
                                                  const echinus_pose* previous, const float* from,
                                                  size_t from_stride, const float* to, size_t to_stride,
                                                  size_t count, echinus_sweep_hit* hits);

/// The velocity of the collider's material at a point, units per second.
/// @param point     [3]
/// @param velocity  [3] out
ECHINUS_API echinus_status echinus_collider_velocity_at(const echinus_collider* collider, const double* point,
                                                        double* velocity);

/// The pose of a collider a time later.
/// @param seconds  finite
ECHINUS_API echinus_status echinus_collider_pose_after(const echinus_collider* collider, double seconds,
                                                       echinus_pose* pose);

/// Where a collider is at a time.
typedef struct echinus_pose_key {
    double time; ///< seconds
    echinus_pose pose;
} echinus_pose_key;

/// The pose at a time: from key to key straight, and about one axis the shorter way round, both evenly;
/// before the first key and after the last it is theirs.
/// @param keys  [key_count], at least one; their times ascend, and poses are finite
/// @param pose  out
ECHINUS_API echinus_status echinus_pose_at(const echinus_pose_key* keys, size_t key_count, double seconds,
                                           echinus_pose* pose);

/// The vertices of a model over time, in samples at equal distances. Never changes.
typedef struct echinus_vertex_cache echinus_vertex_cache;

/// Copies the samples.
/// @param samples         [3 vertex_count sample_count] in the model's own frame; at least one sample of one
///                        vertex
/// @param start_time      of the first sample, seconds
/// @param sample_seconds  from one sample to the next; positive
ECHINUS_API echinus_status echinus_vertex_cache_create(const float* samples, size_t sample_count,
                                                       size_t vertex_count, double start_time,
                                                       double sample_seconds, echinus_vertex_cache** cache);
/// Reads a PC2 point cache, or a folder of OBJ files, one for each frame in the order of their names.
/// @param mesh               the model, as echinus_mesh_read() gives it
/// @param frames_per_second  positive
/// @return as echinus_mesh_read(); ECHINUS_INVALID_MESH also when the number of vertices, or a face in a
/// folder, is not the model's
ECHINUS_API echinus_status echinus_vertex_cache_read(const char* path, const echinus_mesh* mesh,
                                                     double frames_per_second, echinus_vertex_cache** cache);
ECHINUS_API void echinus_vertex_cache_destroy(echinus_vertex_cache* cache);

typedef struct echinus_vertex_cache_info {
    size_t size;
    uint64_t sample_count;
    uint64_t vertex_count;
    double start_time;
    double sample_seconds;
    const float* samples; ///< [3 vertex_count sample_count]; valid as long as the cache
} echinus_vertex_cache_info;

/// @param info  out; its size is set
ECHINUS_API echinus_status echinus_vertex_cache_describe(const echinus_vertex_cache* cache,
                                                         echinus_vertex_cache_info* info);
/// The vertices at a time: straight from sample to sample; before the first and after the last they rest.
/// @param vertices  [3 vertex_count] out
ECHINUS_API echinus_status echinus_vertex_cache_at(const echinus_vertex_cache* cache, double seconds,
                                                   float* vertices);

// ---- Tetrahedra: solids cut into them (docs/tetrahedra.md) ----

/// A body of tetrahedra that share vertices. Each is positive, and two that share a face lie on either side
/// of it: what is not so is refused. Never changes.
typedef struct echinus_tetrahedra echinus_tetrahedra;

/// Copies vertices and tetrahedra.
/// @param tetrahedra  [4 tetrahedron_count] vertices a, b, c, d: a, b, c turn counter-clockwise seen from d
/// @return ECHINUS_INVALID_MESH, naming the first tetrahedron or vertex at fault; signs are exact
ECHINUS_API echinus_status echinus_tetrahedra_create(const float* vertices, size_t vertex_count,
                                                     size_t vertex_stride, const uint32_t* tetrahedra,
                                                     size_t tetrahedron_count, echinus_tetrahedra** body);

/// The changes made for a file's body to be valid.
typedef struct echinus_tetrahedra_file_report {
    size_t size;
    uint64_t turned_tetrahedra; ///< that were negative: the order of corners is a file's convention
    uint64_t dropped_vertices;  ///< that no tetrahedron uses
} echinus_tetrahedra_file_report;

/// Reads .msh (Gmsh 2.2 and 4.1), .vtk (legacy, an unstructured grid) or TetGen's .node with .ele, either of
/// which names the pair.
/// @param report  out, its size is set; or NULL
/// @return ECHINUS_UNREADABLE, ECHINUS_WRONG_FORMAT, ECHINUS_DAMAGED or ECHINUS_INVALID_MESH
ECHINUS_API echinus_status echinus_tetrahedra_read(const char* path, echinus_tetrahedra** body,
                                                   echinus_tetrahedra_file_report* report);
/// Writes .msh (Gmsh 2.2) or .vtk, by the extension of the name. The file appears whole or not at all.
/// @return ECHINUS_UNWRITABLE or ECHINUS_WRONG_FORMAT
ECHINUS_API echinus_status echinus_tetrahedra_write(const echinus_tetrahedra* body, const char* path);

/// A box around the origin, of cuboids cut into five tetrahedra each. Vertex (i, j, k), counted along x, y
/// and z, has the index (k * (segments[1] + 1) + j) * (segments[0] + 1) + i.
/// @param size      [3] lengths of the edges
/// @param segments  [3] cuboids along each axis, 1 to 512
ECHINUS_API echinus_status echinus_tetrahedra_box(const double* size, const uint32_t* segments,
                                                  echinus_tetrahedra** body);

// Options: tetrahedralize. By bindings/generate_options from bindings/options.toml: edit that.
typedef struct echinus_tetrahedralize_options {
    size_t size;
    /// The edge of the lattice's cubes, in the model's unit. Either this or count; 0: the other (not
    /// negative)
    double lattice_size;
    /// About so many tetrahedra: the size is found by trying
    uint64_t count;
    /// More tetrahedra are refused
    uint64_t most_tetrahedra;
    /// Threads that work on it; 0: all cores. The result does not depend on it
    uint32_t thread_count;
    /// 0
    uint32_t reserved;
} echinus_tetrahedralize_options;

ECHINUS_API void echinus_tetrahedralize_options_init(echinus_tetrahedralize_options* options, size_t size);
// End of options.

typedef struct echinus_tetrahedralize_report {
    size_t size;
    double lattice_size;
    uint64_t removed_tetrahedra; ///< left out where parts would have met in no more than an edge or a vertex
} echinus_tetrahedralize_report;

/// Fills what an exact map says is inside with tetrahedra, by isosurface stuffing. The boundary is closed,
/// manifold and does not intersect itself; the extreme dihedral angles that were found are 9.3 and 161.7
/// degrees.
/// @param report  out, its size is set; or NULL
/// @return ECHINUS_INVALID_OPTIONS; ECHINUS_INVALID_MESH when no tetrahedron of that size fits into the
/// model; ECHINUS_INVALID_ARGUMENT for a map of another kind
ECHINUS_API echinus_status echinus_tetrahedralize(const echinus_map* model,
                                                  const echinus_tetrahedralize_options* options,
                                                  echinus_tetrahedra** body,
                                                  echinus_tetrahedralize_report* report);

ECHINUS_API void echinus_tetrahedra_destroy(echinus_tetrahedra* body);

ECHINUS_API size_t echinus_tetrahedra_vertex_count(const echinus_tetrahedra* body);
/// [3 vertex_count] x, y, z
ECHINUS_API const float* echinus_tetrahedra_vertices(const echinus_tetrahedra* body);
/// [3] as of a mesh
ECHINUS_API const double* echinus_tetrahedra_origin(const echinus_tetrahedra* body);
ECHINUS_API size_t echinus_tetrahedra_count(const echinus_tetrahedra* body);
/// [4 count]
ECHINUS_API const uint32_t* echinus_tetrahedra_indices(const echinus_tetrahedra* body);

typedef struct echinus_tetrahedra_report {
    size_t size;
    uint64_t tetrahedron_count;
    uint64_t vertex_count; ///< that tetrahedra use
    double volume;         ///< of all
    double least_volume;   ///< of one tetrahedron
    double shortest_edge;
    double longest_edge;
    double least_angle_deg; ///< between two faces of a tetrahedron, in degrees
    double greatest_angle_deg;
} echinus_tetrahedra_report;

/// @param report  out; its size is set
ECHINUS_API echinus_status echinus_tetrahedra_inspect(const echinus_tetrahedra* body,
                                                      echinus_tetrahedra_report* report);

/// The faces that belong to one tetrahedron only, outward, with all vertices of the body.
ECHINUS_API echinus_status echinus_tetrahedra_boundary(const echinus_tetrahedra* body, echinus_mesh** mesh);

/// How far the boundary of a body and the surface of a model are apart, at samples on both.
typedef struct echinus_boundary_distance {
    size_t size;
    double mean_to_model;
    double greatest_to_model;
    double mean_to_boundary;
    double greatest_to_boundary;
} echinus_boundary_distance;

/// @param distance  out; its size is set
/// @return ECHINUS_INVALID_ARGUMENT for a map of another kind than an exact one
ECHINUS_API echinus_status echinus_tetrahedra_measure_distance(const echinus_tetrahedra* body,
                                                               const echinus_map* model,
                                                               uint32_t thread_count,
                                                               echinus_boundary_distance* distance);

/// Where points lie in a body, so that they go along with it: a finer mesh, for instance. Never changes.
typedef struct echinus_embedding echinus_embedding;

/// Finds the tetrahedron that each point lies in, or else the nearest one, and the point's weights there.
/// @param points  [count] finite
/// @return ECHINUS_INVALID_MESH when a point is not finite
ECHINUS_API echinus_status echinus_embedding_create(const echinus_tetrahedra* body, const float* points,
                                                    size_t count, size_t stride, uint32_t thread_count,
                                                    echinus_embedding** embedding);
ECHINUS_API void echinus_embedding_destroy(echinus_embedding* embedding);
/// The number of points.
ECHINUS_API size_t echinus_embedding_count(const echinus_embedding* embedding);
/// Where the points are once the body's vertices have moved.
/// @param positions       [position_count] of the body's vertices, of which there are so many
/// @param points          [3 count] out; does not overlap the positions
/// @return ECHINUS_INVALID_ARGUMENT for another number of positions
ECHINUS_API echinus_status echinus_embedding_carry(const echinus_embedding* embedding, const float* positions,
                                                   size_t position_count, size_t position_stride,
                                                   uint32_t thread_count, float* points);

// ---- Deformables ----

typedef enum echinus_stick_kind {
    ECHINUS_STICK_STRUCTURAL = 0,
    ECHINUS_STICK_SHEAR = 1,
    ECHINUS_STICK_BENDING = 2
} echinus_stick_kind;
#define ECHINUS_STICK_KIND_COUNT 3

/// Pulls or pushes two particles to a distance.
typedef struct echinus_stick {
    uint32_t a, b;
    float rest_length; ///< not negative
    uint8_t kind;      ///< an echinus_stick_kind
    uint8_t reserved[3];
} echinus_stick;

/// Fixes a particle to a collider of a simulation.
typedef struct echinus_attachment {
    uint32_t particle;
    uint32_t collider; ///< index in the simulation's colliders
} echinus_attachment;

/// A particle and a collider of a simulation that do not collide. Faces and edges of the particle pass
/// through that collider, too.
typedef struct echinus_collision_filter {
    uint32_t particle;
    uint32_t collider; ///< index in the simulation's colliders
} echinus_collision_filter;

/// Elastic material between four particles, for ECHINUS_SOLVER_NEWTON; echinus_deformable_soft_body()
/// computes them.
typedef struct echinus_elastic_tetrahedron {
    uint32_t particles[4];
    float gradients[3][3]; ///< at rest: rows of the inverse of the matrix with columns b - a, c - a and d - a
    float volume;          ///< at rest; positive
    float mu, lambda;      ///< the Lame parameters: mu positive, lambda not negative
    float damping;         ///< viscosity over mu, seconds
} echinus_elastic_tetrahedron;

/// Particles and what holds them together, in world units.
typedef struct echinus_deformable echinus_deformable;

/// The parts of a deformable, as arrays.
typedef struct echinus_deformable_arrays {
    size_t size;
    size_t particle_count;
    const float* positions;          ///< [3 particle_count]
    const float* previous_positions; ///< [3 particle_count] one frame ago at these velocities; NULL: at rest
    const float* inverse_masses;     ///< [particle_count] 0 for a pinned particle; NULL: 1 for all
    const echinus_stick* sticks; ///< in the order in which they are relaxed; of Newton's cloth only threads
    size_t stick_count;
    const uint32_t* faces; ///< [3 face_count]
    size_t face_count;
    const echinus_attachment* attachments; ///< of pinned particles, at most one of each
    size_t attachment_count;
    const echinus_elastic_tetrahedron* tetrahedra;
    size_t tetrahedron_count;
    const echinus_collision_filter* filters;
    size_t filter_count;
} echinus_deformable_arrays;

/// Copies the arrays. Whether they fit together is checked when a simulation is made of them.
/// @param arrays  zero but for its size and what it has
ECHINUS_API echinus_status echinus_deformable_create(const echinus_deformable_arrays* arrays,
                                                     echinus_deformable** deformable);

// Options: cloth. By bindings/generate_options from bindings/options.toml: edit that.
/// A rectangular sheet: columns along x, rows along y, particle row * column_count + column.
typedef struct echinus_cloth_options {
    size_t size;
    /// Particles along x; in all at most 2^24 (2 to 8388608)
    uint32_t column_count;
    /// Particles along y. The particle (row, column) has the number row * column_count + column (2 to
    /// 8388608)
    uint32_t row_count;
    /// Along x (positive)
    double width;
    /// Along y (positive)
    double height;
    /// Where the middle of the sheet starts
    echinus_pose pose;
    /// [pin_count] particles that never move
    const uint32_t* pins;
    size_t pin_count;
} echinus_cloth_options;

ECHINUS_API void echinus_cloth_options_init(echinus_cloth_options* options, size_t size);
// End of options.

/// A rectangular sheet of cloth.
/// @param options  or NULL for the defaults
ECHINUS_API echinus_status echinus_deformable_cloth(const echinus_cloth_options* options,
                                                    echinus_deformable** deformable);

// Options: mesh_cloth. By bindings/generate_options from bindings/options.toml: edit that.
typedef struct echinus_mesh_cloth_options {
    size_t size;
    /// A vertex starts at position + rotation * (scale * vertex)
    echinus_pose pose;
    /// Factor of size, before the pose (1e-9 to 1e9)
    double scale;
    /// [3 rest_vertex_count] the shape at rest, where it is not that of the mesh: as many as the mesh has, or
    /// none
    const float* rest_vertices;
    size_t rest_vertex_count;
    /// [2 thread_edge_count] edges without faces: threads and needles
    const uint32_t* thread_edges;
    size_t thread_edge_count;
    /// [pin_count] vertices that never move
    const uint32_t* pins;
    size_t pin_count;
    /// [attachment_count] vertices that move with a collider, and the number of that collider in the
    /// simulation
    const echinus_attachment* attachments;
    size_t attachment_count;
} echinus_mesh_cloth_options;

ECHINUS_API void echinus_mesh_cloth_options_init(echinus_mesh_cloth_options* options, size_t size);
// End of options.

/// A cloth whose particles are the vertices of a mesh.
/// @param options  or NULL for the defaults
/// @return ECHINUS_INVALID_MESH, naming a face, edge or vertex at fault; ECHINUS_INVALID_OPTIONS
ECHINUS_API echinus_status echinus_deformable_cloth_of_mesh(const echinus_mesh* mesh,
                                                            const echinus_mesh_cloth_options* options,
                                                            echinus_deformable** deformable);

// Options: soft_body. By bindings/generate_options from bindings/options.toml: edit that.
/// The matter of a soft body, and where it starts; in SI units with metres, kilograms and seconds.
typedef struct echinus_soft_body_options {
    size_t size;
    /// Water has 1000 kg/m^3 (1e-9 to 1e15 mass/length^3)
    double density;
    /// Stiffness; soft tissue has 1e3 to 1e5 Pa (1e-9 to 1e15 mass/(length s^2))
    double young_modulus;
    /// Towards 0.5 the volume is kept (0 to 0.4999)
    double poisson_ratio;
    /// Viscosity over the shear modulus (0 to 1e9 s)
    double damping;
    /// A vertex starts at position + rotation * (scale * vertex)
    echinus_pose pose;
    /// Factor of size, before the pose (1e-9 to 1e9)
    double scale;
    /// [pin_count] vertices that never move
    const uint32_t* pins;
    size_t pin_count;
    /// [attachment_count] vertices that move with a collider, and the number of that collider in the
    /// simulation
    const echinus_attachment* attachments;
    size_t attachment_count;
} echinus_soft_body_options;

ECHINUS_API void echinus_soft_body_options_init(echinus_soft_body_options* options, size_t size);
// End of options.

/// A body at rest, whose particles are the vertices of the tetrahedra and whose faces their boundary.
/// @param options  or NULL for the defaults
/// @return ECHINUS_INVALID_MESH when no tetrahedron uses a vertex; ECHINUS_INVALID_OPTIONS
ECHINUS_API echinus_status echinus_deformable_soft_body(const echinus_tetrahedra* body,
                                                        const echinus_soft_body_options* options,
                                                        echinus_deformable** deformable);

/// Several deformables as one, the particles of one part after those of the other: with self_collision they
/// collide with each other.
/// @param parts  [part_count]
/// @return ECHINUS_INVALID_OPTIONS, naming the part, when one names a particle that it does not have
ECHINUS_API echinus_status echinus_deformable_combine(const echinus_deformable* const* parts,
                                                      size_t part_count, echinus_deformable** deformable);

/// The same deformable with all masses times a factor, finite and positive. ECHINUS_SOLVER_NEWTON weighs
/// cloth by its density in the options of the simulation.
ECHINUS_API echinus_status echinus_deformable_with_masses_times(const echinus_deformable* deformable,
                                                                double factor, echinus_deformable** result);

/// The same deformable, of which nothing collides with a collider. As a part of what
/// echinus_deformable_combine() makes, it is a filter by pair.
/// @param collider  index in the simulation's colliders
ECHINUS_API echinus_status echinus_deformable_passing_through(const echinus_deformable* deformable,
                                                              uint32_t collider, echinus_deformable** result);

/// @param arrays  out, its size is set; its pointers are valid as long as the deformable
ECHINUS_API echinus_status echinus_deformable_read(const echinus_deformable* deformable,
                                                   echinus_deformable_arrays* arrays);

ECHINUS_API void echinus_deformable_destroy(echinus_deformable* deformable);

// ---- Simulations ----

/// How a deformable moves.
typedef enum echinus_solver {
    ECHINUS_SOLVER_NEWTON = 0,  ///< as a continuous material in SI units
    ECHINUS_SOLVER_JAKOBSEN = 1 ///< by the paper: sticks and particles that collide, no surfaces
} echinus_solver;

/// In place of a thickness: it is chosen by the library.
#define ECHINUS_THICKNESS_CHOSEN (-1.0)

// Options: simulation. By bindings/generate_options from bindings/options.toml: edit that.
/// SimulationOptions in simulation.hpp tells how much each member costs.
typedef struct echinus_simulation_options {
    size_t size;
    /// Seconds per frame. The paper's solver needs smaller ones: half of it takes twice the time there and
    /// leaves a quarter of the stretch (1e-9 to 1e9 s)
    double time_step;
    /// Newton: a continuous material in SI units; jakobsen: sticks and particles that collide, and nothing
    /// else, as the paper has it
    echinus_solver solver;
    /// Jakobsen only: relaxations per frame, each of all sticks and then of all contacts; more cost time and
    /// leave less stretch (1 to 1e6)
    uint32_t iteration_count;
    /// Newton only: at most so many steps of Newton's method in a frame; fewer where it has converged (1 to
    /// 1000)
    uint32_t newton_step_count;
    /// For how many frames in a row all particles have to be slow and near one place (1 to 1e9)
    uint32_t rest_frame_count;
    /// How far a particle at rest may be from its place (0 to 1e9)
    double rest_distance;
    /// How fast a particle at rest may be at the end of a frame (at least 0 length/s)
    double rest_speed;
    /// Where down is. A model whose y is up needs [0, -9.81, 0] (-1e9 to 1e9 length/s^2)
    double gravity[3];
    /// Jakobsen only: share of the velocity that is lost per frame; another time_step makes another drag (0
    /// to 1)
    double drag;
    /// Jakobsen only: share of a stick's error that one relaxation removes, of structural, shear and bending
    /// sticks (0 to 1.99)
    double stiffness[ECHINUS_STICK_KIND_COUNT];
    /// Distance that the deformable keeps from colliders, by default half the mean length of structural
    /// sticks at rest (0 to 1e9), or ECHINUS_THICKNESS_CHOSEN
    double thickness;
    /// Distance that layers keep from each other, with self_collision; near small faces less. By default the
    /// thickness (0 to 1e9), or ECHINUS_THICKNESS_CHOSEN
    double self_thickness;
    /// Coulomb's coefficient between cloth and model; 0 is ice (0 to 1e9)
    double friction;
    /// A particle farther than this from the middle of where all began ends the simulation as diverged; 0: 10
    /// 000 times the extent at the start (0 to 1e30)
    double bound;
    /// Rescue particles that would pass through an exact map
    int32_t keep_free;
    /// Accept exact maps of open meshes, for which nothing is promised. Surface collision needs no such
    /// permission
    int32_t allow_open_colliders;
    /// Faces and edges keep off the model, too: none of them intersects it at the end of a frame, within
    /// limits
    int32_t surface_collision;
    /// Nor do two faces of what deforms intersect; needs surface_collision
    int32_t self_collision;
    /// A start that intersects, or is inside the model, is parted before the first frame instead of refused;
    /// needs surface_collision
    int32_t untangle;
    /// Threads that compute a frame; 0: all cores. The same bits with any number (0 to 1024)
    uint32_t thread_count;
    /// Newton only, as the four that follow: mass of the cloth per area (1e-6 to 1e6 kg/m^2)
    double density;
    /// Force per width against stretching of warp and weft (1e-6 to 1e9 N/m)
    double stretch_stiffness;
    /// Force per width against shear between them (0 to 1e9 N/m)
    double shear_stiffness;
    /// Moment per width and curvature against folding (0 to 1e6 N m)
    double bending_stiffness;
    /// Viscosity of the cloth over its stiffness (0 to 1e6 s)
    double damping;
    /// Newton only: a step of Newton's method has converged if the energy that it gains could move particles
    /// no farther than this in the root mean square; share of the mean edge length (0 to 1)
    double newton_tolerance;
    /// Newton only: resistance of still air, the rate at which a velocity decays that nothing keeps up; 0 is
    /// a vacuum (0 to 1e6 1/s)
    double air_drag;
    /// Velocity of the air; needs wind_rate (-1e9 to 1e9 length/s)
    double wind[3];
    /// Of the air's velocity across a face, along its normal, particles take on so much per second: the
    /// higher, the lighter the cloth. 0: no air. Without wind the air is at rest and brakes (0 to 1e9 1/s)
    double wind_rate;
    /// Newton only: pressure inside the closed pieces of cloth, beyond that around them; constant, as that of
    /// a pump (0 to 1e9 N/m^2)
    double pressure;
} echinus_simulation_options;

ECHINUS_API void echinus_simulation_options_init(echinus_simulation_options* options, size_t size);
// End of options.

/// A deformable among colliders. The same input gives the same positions bit for bit.
typedef struct echinus_simulation echinus_simulation;

/// Copies the deformable and keeps what it needs of the maps: all arguments may go afterwards.
/// @param colliders  [collider_count]
/// @param options    or NULL for the defaults
/// @return ECHINUS_INVALID_OPTIONS, naming what is at fault; ECHINUS_INVALID_ARGUMENT also for more colliders
/// than memory can hold
ECHINUS_API echinus_status echinus_simulation_create(const echinus_deformable* deformable,
                                                     const echinus_collider* colliders, size_t collider_count,
                                                     const echinus_simulation_options* options,
                                                     echinus_simulation** simulation);

/// An independent copy in the present state.
ECHINUS_API echinus_status echinus_simulation_copy(const echinus_simulation* simulation,
                                                   echinus_simulation** copy);

ECHINUS_API void echinus_simulation_destroy(echinus_simulation* simulation);

/// All that decides how a simulation goes on, but for what it was made of (docs/saved_states.md).
/// @param state  out, unsigned char
ECHINUS_API echinus_status echinus_simulation_save_state(const echinus_simulation* simulation,
                                                         echinus_array** state);
/// Another simulation, made of the same as the one given, that goes on from a saved state with the same bits.
/// The one given stays as it is.
/// @param bytes  [byte_count]; checked before use, whatever they are
/// @return ECHINUS_WRONG_FORMAT, ECHINUS_UNSUPPORTED_VERSION or ECHINUS_DAMAGED for bytes that are no state
/// of this version; ECHINUS_INVALID_OPTIONS for a state of another simulation, saying what differs
ECHINUS_API echinus_status echinus_simulation_restored(const echinus_simulation* simulation,
                                                       const void* bytes, size_t byte_count,
                                                       echinus_simulation** restored);

/// Computes one frame.
/// @return ECHINUS_DIVERGED, naming the frame; from then on the simulation can only be read
ECHINUS_API echinus_status echinus_simulation_step(echinus_simulation* simulation);

ECHINUS_API size_t echinus_simulation_particle_count(const echinus_simulation* simulation);
/// [3 particle_count] x, y, z of all particles now: the address stays the same as long as the simulation
/// lives, and each step writes there.
ECHINUS_API const float* echinus_simulation_positions(const echinus_simulation* simulation);
/// All arrays of the deformable in its present state.
/// @param arrays  out, its size is set; its pointers are valid as long as the simulation
ECHINUS_API echinus_status echinus_simulation_read(const echinus_simulation* simulation,
                                                   echinus_deformable_arrays* arrays);

/// Frames computed so far.
ECHINUS_API uint32_t echinus_simulation_frame(const echinus_simulation* simulation);
/// Has the rest condition held for the required number of frames?
ECHINUS_API int32_t echinus_simulation_at_rest(const echinus_simulation* simulation);
/// Speed of the fastest particle in the last frame, units per second; infinite before the first.
ECHINUS_API double echinus_simulation_largest_speed(const echinus_simulation* simulation);
/// XXH64 of the bits of all positions and previous positions.
ECHINUS_API uint64_t echinus_simulation_state_hash(const echinus_simulation* simulation);

/// Times and counts since the simulation began. Times are not part of the result.
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
    uint64_t squeezed_count;
} echinus_simulation_profile;

/// @param profile  out; its size is set
ECHINUS_API echinus_status echinus_simulation_read_profile(const echinus_simulation* simulation,
                                                           echinus_simulation_profile* profile);

/// Of the structural sticks, how far their lengths are from those at rest at the end of the last frame, as a
/// share of these; 0.01 is 1 %, and 0 where there are no such sticks. Under ECHINUS_SOLVER_JAKOBSEN it is
/// what relaxations have left undone.
/// @param root_mean_square, largest  [1] out
ECHINUS_API echinus_status echinus_simulation_residual(const echinus_simulation* simulation,
                                                       double* root_mean_square, double* largest);

/// The options as given, with the thickness in force.
/// @param options  out; its size is set
ECHINUS_API echinus_status echinus_simulation_read_options(const echinus_simulation* simulation,
                                                           echinus_simulation_options* options);

ECHINUS_API size_t echinus_simulation_collider_count(const echinus_simulation* simulation);
/// A collider in its present pose.
/// @param collider  out, its size is set; its map is valid as long as the simulation, and for a collider that
///                  deforms it is that of its present vertices until the collider is read again
ECHINUS_API echinus_status echinus_simulation_read_collider(const echinus_simulation* simulation,
                                                            size_t index, echinus_collider* collider);

/// Steers a collider: it keeps these velocities until they are set again.
/// @param linear, angular  [3] finite
ECHINUS_API echinus_status echinus_simulation_set_collider_velocity(echinus_simulation* simulation,
                                                                    size_t index, const double* linear,
                                                                    const double* angular);

/// The next frame leads the collider to this pose, evenly and the shorter way round, and leaves it there.
/// Until the next call it stands still.
ECHINUS_API echinus_status echinus_simulation_set_collider_pose(echinus_simulation* simulation, size_t index,
                                                                const echinus_pose* pose);

/// A collider follows the keys: each frame leads it to where echinus_pose_at() has it at the frame's end. It
/// does so from where it is, so begin it there. Without keys it stands still.
/// @param keys  [key_count]; their times ascend, in seconds since the simulation began
/// @return ECHINUS_INVALID_OPTIONS, naming the key
ECHINUS_API echinus_status echinus_simulation_set_collider_keyframes(echinus_simulation* simulation,
                                                                     size_t index,
                                                                     const echinus_pose_key* keys,
                                                                     size_t key_count);

/// The next frame leads the vertices of a collider here, each on a straight way; then they rest. Needs an
/// exact map and options.surface_collision; the map is built anew in this call.
/// @param vertices  [vertex_count] in the model's own frame, as many and in the order of the mesh that its
/// map
///                  was built of
/// @return ECHINUS_INVALID_OPTIONS; then nothing has changed
ECHINUS_API echinus_status echinus_simulation_set_collider_vertices(echinus_simulation* simulation,
                                                                    size_t index, const float* vertices,
                                                                    size_t vertex_count,
                                                                    size_t vertex_stride);

/// Each frame leads the vertices of a collider to where echinus_vertex_cache_at() has them at the frame's
/// end. The cache may go afterwards.
/// @return as above
ECHINUS_API echinus_status echinus_simulation_set_collider_cache(echinus_simulation* simulation, size_t index,
                                                                 const echinus_vertex_cache* cache);

/// The load that the deformable put on a collider in the last frame by contact and friction, as its mean over
/// the frame; 0 before the first, and always under ECHINUS_SOLVER_JAKOBSEN.
/// @param force   [3] out, N
/// @param torque  [3] out, N m, about the pose's translation, as it moves
ECHINUS_API echinus_status echinus_simulation_load_on(const echinus_simulation* simulation, size_t index,
                                                      double* force, double* torque);

/// The next frames move a collider freely from its present velocities: a rigid body of uniform density, moved
/// by gravity and by contact with the deformable. Needs an exact map of a closed mesh and
/// ECHINUS_SOLVER_NEWTON.
/// @param mass  kg, positive and finite
/// @return ECHINUS_INVALID_OPTIONS; then nothing has changed
ECHINUS_API echinus_status echinus_simulation_set_collider_free(echinus_simulation* simulation, size_t index,
                                                                double mass);

/// In place of the number of a collider or of a particle.
#define ECHINUS_NONE UINT32_MAX

/// A contact that pushed in the last frame: of a particle, an edge or a face of the deformable with a
/// collider, or of two of its own.
typedef struct echinus_contact_point {
    double position[3];    ///< on the deformable, at the end of the frame; world coordinates
    double normal[3];      ///< unit, towards the deformable; towards its first part where both are its own
    double gap;            ///< at the end of the frame; positive
    double normal_impulse; ///< on the deformable (its first part) along the normal in the frame, N s
    double friction_impulse[3]; ///< the same across the normal, N s
    uint32_t collider;          ///< ECHINUS_NONE: the contact is of the deformable with itself
    /// Of the first part, and then of the second one if it is the deformable's own, too: a vertex and the
    /// three of a face, or two and two of edges. ECHINUS_NONE where there are fewer.
    uint32_t particles[4];
} echinus_contact_point;

/// Whether the frames that follow record the contacts that push; off at the beginning. Not part of a saved
/// state.
ECHINUS_API echinus_status echinus_simulation_record_contacts(echinus_simulation* simulation, int32_t is_on);

/// The contacts that were recorded in the last frame. Their impulses divided by the time step sum to the load
/// on each collider, except for the loads of attached particles and of truncated ones. None under
/// ECHINUS_SOLVER_JAKOBSEN.
/// @param points  out, echinus_contact_point
ECHINUS_API echinus_status echinus_simulation_contact_points(const echinus_simulation* simulation,
                                                             echinus_array** points);

/// Gives a particle a velocity, from which the next frame goes on. A pinned particle stays.
/// @param velocity  [3] finite, units per second
ECHINUS_API echinus_status echinus_simulation_set_particle_velocity(echinus_simulation* simulation,
                                                                    size_t particle, const double* velocity);

/// Wind for the time of one frame.
/// @param wind  [3] of the air, finite, units per second
/// @param rate  per second: the higher, the lighter the cloth; finite, not negative
ECHINUS_API echinus_status echinus_simulation_blow(echinus_simulation* simulation, const double* wind,
                                                   double rate);

// ---- Collision for a solver of one's own (docs/own_solver.md) ----

// Options: particle_collision. By bindings/generate_options from bindings/options.toml: edit that.
typedef struct echinus_particle_collision_options {
    size_t size;
    /// Coulomb's coefficient between particle and model; 0 is ice (0 to 1e9)
    double friction;
    /// Accept exact maps of open meshes, for which nothing is promised
    int32_t allow_open_colliders;
    /// Threads that share a step; 0: all cores. The same bits with any number (0 to 1024)
    uint32_t thread_count;
} echinus_particle_collision_options;

ECHINUS_API void echinus_particle_collision_options_init(echinus_particle_collision_options* options,
                                                         size_t size);
// End of options.

/// Keeps the particles of any solver out of models: particle_collision.hpp.
typedef struct echinus_particle_collision echinus_particle_collision;

/// Keeps what it needs of the maps: all arguments may go afterwards.
/// @param colliders  [collider_count] where they stand; their velocities do not count
/// @param thickness  the distance that particles keep from the surface; not negative
/// @param options    or NULL for the defaults
/// @return as echinus_simulation_create()
ECHINUS_API echinus_status echinus_particle_collision_create(
    const echinus_collider* colliders, size_t collider_count, double thickness,
    const echinus_particle_collision_options* options, echinus_particle_collision** collision);
/// May be NULL.
ECHINUS_API void echinus_particle_collision_destroy(echinus_particle_collision* collision);

/// The solver's next step leads a collider there, evenly and the shorter way round; then it rests.
ECHINUS_API echinus_status echinus_particle_collision_set_collider_pose(echinus_particle_collision* collision,
                                                                        size_t index,
                                                                        const echinus_pose* pose);
/// The collider is there from now on: nothing is swept on the way.
ECHINUS_API echinus_status echinus_particle_collision_place_collider(echinus_particle_collision* collision,
                                                                     size_t index, const echinus_pose* pose);

/// Of one collider, in place of the options' friction.
ECHINUS_API echinus_status echinus_particle_collision_set_collider_friction(
    echinus_particle_collision* collision, size_t index, double friction);

/// Corrects the particles after a step of the solver, and moves the colliders. No NaN harms it: see
/// ParticleCollision::correct().
/// @param previous_positions  [3 particle_count] where the step began
/// @param positions       [3 particle_count] in: where the solver has put them. Out: corrected
/// @param velocities      [3 particle_count] in and out, units per second; or NULL
/// @param inverse_masses  [particle_count] 0 for pinned particles; or NULL: all are pushed
/// @param seconds         that the step took; positive
/// @param corrected       out: [corrected_count] the particles that were corrected, ascending; until the
///                        next call; or NULL
/// @param corrected_count out; or NULL
ECHINUS_API echinus_status echinus_particle_collision_correct(
    echinus_particle_collision* collision, const float* previous_positions, float* positions,
    float* velocities, const float* inverse_masses, size_t particle_count, double seconds,
    const uint32_t** corrected, size_t* corrected_count);

/// How often a particle has ended a step inside an exact map, or behind its surface, though it was outside.
ECHINUS_API uint64_t echinus_particle_collision_lost_count(const echinus_particle_collision* collision);

// Options: surface_collision. By bindings/generate_options from bindings/options.toml: edit that.
typedef struct echinus_surface_collision_options {
    size_t size;
    /// Coulomb's coefficient; 0 is ice (0 to 1e9)
    double friction;
    /// Distance that layers keep from each other; near small faces less. By default the thickness (0 to 1e9),
    /// or ECHINUS_THICKNESS_CHOSEN
    double self_thickness;
    /// Faces do not meet each other either
    int32_t self_collision;
    /// A start that intersects, or is inside the model, is parted instead of refused
    int32_t untangle;
    /// Threads that share a step; 0: all cores. The same bits with any number (0 to 1024)
    uint32_t thread_count;
    /// 0
    uint32_t reserved;
} echinus_surface_collision_options;

ECHINUS_API void echinus_surface_collision_options_init(echinus_surface_collision_options* options,
                                                        size_t size);
// End of options.

/// Keeps the faces that join the particles of any solver off models and off each other:
/// surface_collision.hpp.
typedef struct echinus_surface_collision echinus_surface_collision;

/// Copies the arrays and keeps what it needs of the maps.
/// @param positions  [3 particle_count] where the particles begin: no faces meet there, but see untangle
/// @param faces      [3 face_count] of those particles; at least one
/// @param colliders  [collider_count] where they stand; their velocities do not count
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

/// As echinus_particle_collision_set_collider_pose().
ECHINUS_API echinus_status echinus_surface_collision_set_collider_pose(echinus_surface_collision* collision,
                                                                       size_t index,
                                                                       const echinus_pose* pose);

/// Corrects the particles after a step of the solver, which began where the last one ended, and moves the
/// colliders.
/// @param positions       [3 particle_count] in: where the solver has put them. Out: corrected
/// @param velocities      [3 particle_count] in and out, units per second; or NULL
/// @param particle_count  as the collision has
/// @param seconds         that the step took; positive
/// @param corrected       out: [corrected_count] the particles that were corrected, ascending; until the
///                        next call; or NULL
/// @param corrected_count out; or NULL
ECHINUS_API echinus_status echinus_surface_collision_correct(echinus_surface_collision* collision,
                                                             float* positions, float* velocities,
                                                             size_t particle_count, double seconds,
                                                             const uint32_t** corrected,
                                                             size_t* corrected_count);

/// [3 particle_count] where the particles are, and nothing meets: the address stays the same.
ECHINUS_API const float* echinus_surface_collision_positions(const echinus_surface_collision* collision);
/// Pairs of parts of faces for which no room was proven, summed over all steps; 0: no faces meet.
ECHINUS_API uint64_t echinus_surface_collision_unresolved_count(const echinus_surface_collision* collision);

// ---- Scenes: simulations as JSON (docs/scenes.md) ----

typedef struct echinus_scene echinus_scene;

/// @return ECHINUS_UNREADABLE or ECHINUS_INVALID_SCENE, naming the key at fault
ECHINUS_API echinus_status echinus_scene_read(const char* path, echinus_scene** scene);

/// The same from text.
/// @param name  stands for the path in errors; files of the scene are looked for in its folder, if it has one
ECHINUS_API echinus_status echinus_scene_parse(const char* json, const char* name, echinus_scene** scene);

ECHINUS_API void echinus_scene_destroy(echinus_scene* scene);

/// The frame at which the simulation is to end at the latest.
ECHINUS_API uint32_t echinus_scene_frame_limit(const echinus_scene* scene);

/// Reads or generates the meshes of a scene, repairs its models as it says, builds their maps and makes the
/// simulation. Files are looked for in the folders, then in the scene's folder and in ../models beside
/// it.
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
