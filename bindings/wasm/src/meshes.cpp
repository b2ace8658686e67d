// Meshes: from arrays, files and shapes; reports, faults, repairs.

#include "arrays.hpp"
#include "interface.hpp"
#include "mesh/faces.hpp"
#include "mesh/local_frame.hpp"
#include "mesh_io/readers.hpp"

#include <echinus/error.hpp>
#include <echinus/intersections.hpp>
#include <echinus/mesh.hpp>

#include <algorithm>

namespace echinus::wasm {

namespace {

json to_json(const Fault& fault) {
    return {{"count", fault.count}, {"firstFaces", fault.first_faces}};
}

json to_json(const MeshReport& report) {
    const Vec3d& centre = report.bounding_sphere.centre;
    return {{"faceCount", report.face_count},
            {"vertexCount", report.vertex_count},
            {"componentCount", report.component_count},
            {"closed", report.closed},
            {"manifold", report.manifold},
            {"orientable", report.orientable},
            {"borderEdges", to_json(report.border_edges)},
            {"nonmanifoldEdges", to_json(report.nonmanifold_edges)},
            {"misorientedEdges", to_json(report.misoriented_edges)},
            {"duplicateFaces", to_json(report.duplicate_faces)},
            {"degenerateFaces", to_json(report.degenerate_faces)},
            {"signedVolume", report.signed_volume},
            {"boundingSphere",
             {{"centre", {centre.x, centre.y, centre.z}}, {"radius", report.bounding_sphere.radius}}},
            {"roundingStep", report.rounding_step}};
}

json to_json(const RepairReport& report) {
    return {{"duplicateFacesDropped", report.duplicate_faces_dropped},
            {"doubledPatchFacesDropped", report.doubled_patch_faces_dropped},
            {"componentsFlipped", report.components_flipped},
            {"holesClosed", report.holes_closed},
            {"holesLeft", report.holes_left},
            {"innerFacesDropped", report.inner_faces_dropped},
            {"sheetsThickened", report.sheets_thickened},
            {"facesAdded", report.faces_added},
            {"verticesWelded", report.vertices_welded},
            {"sliversDropped", report.slivers_dropped},
            {"facesTurned", report.faces_turned},
            {"seamsFilled", report.seams_filled}};
}

std::vector<Vec3f> vertices_at(const float* first, std::uint32_t count) {
    const auto* points = reinterpret_cast<const Vec3f*>(first);
    return {points, points + count};
}

/// The name's extension determines the format, as in mesh_io/read_mesh.cpp, but without glTF and
/// 3DS, which pages read with libraries of their own.
PolygonMesh read_polygons(const MeshSource& source) {
    const std::size_t dot = source.name.rfind('.');
    const std::string ending = dot == std::string::npos ? "" : lower_case(source.name.substr(dot));
    if (ending == ".obj") return read_obj(source);
    if (ending == ".off") return read_off(source);
    if (ending == ".ply") return read_ply(source);
    if (ending == ".stl") return read_stl(source);
    source.fail(ErrorCode::WrongFormat,
                "this module reads meshes from files that end in .obj, .ply, .stl or .off, not in " +
                    in_quotes(ending) + "; hand in others as vertices and faces");
}

TriangleMesh read_mesh_bytes(const MeshSource& source) {
    if (source.bytes.empty()) source.fail(ErrorCode::Damaged, "the file is empty");
    const TriangleMesh mesh = triangulate(read_polygons(source), source);
    if (mesh.faces.empty()) source.fail(ErrorCode::InvalidMesh, "the file has no faces");
    return weld(mesh);
}

/// @throws Error InvalidMesh
void require_corners(const PolygonMesh& polygons) {
    std::uint64_t corner_count = 0;
    for (const std::uint32_t count : polygons.corner_counts) corner_count += count;
    if (corner_count != polygons.corners.size())
        throw Error(ErrorCode::InvalidMesh, "the polygons' corner counts add up to " +
                                                std::to_string(corner_count) + ", but there are " +
                                                std::to_string(polygons.corners.size()) + " corners");
    for (std::size_t i = 0; i < polygons.corners.size(); ++i)
        if (polygons.corners[i] >= polygons.vertices.size())
            throw Error(ErrorCode::InvalidMesh, "corner " + std::to_string(i) + " is vertex " +
                                                    std::to_string(polygons.corners[i]) + ", but there are " +
                                                    std::to_string(polygons.vertices.size()) + " vertices");
}

/// Every fault of a mesh and its place, for drawing.
/// @return  two vertices for each border, nonmanifold and misoriented edge; duplicate and degenerate faces
Arrays find_faults(const TriangleMesh& mesh) {
    require_valid(mesh);
    Arrays faults;
    std::vector<std::uint32_t>& border = faults.numbers[0];
    std::vector<std::uint32_t>& nonmanifold = faults.numbers[1];
    std::vector<std::uint32_t>& misoriented = faults.numbers[2];
    const auto add = [](std::vector<std::uint32_t>& edges, const EdgeUse& use) {
        edges.push_back(use.low);
        edges.push_back(use.high);
    };
    const std::vector<EdgeUse> edge_uses = sorted_edge_uses(mesh);
    for_each_edge(edge_uses, [&](std::span<const EdgeUse> uses) {
        if (uses.size() == 1) add(border, uses[0]);
        if (uses.size() > 2) add(nonmanifold, uses[0]);
        if (uses.size() == 2 && !is_balanced(uses)) add(misoriented, uses[0]);
    });
    faults.numbers[3] = find_duplicate_faces(mesh);
    faults.numbers[4] = find_degenerate_faces(mesh);
    return faults;
}

/// Both faces of each pair in turn.
Arrays numbers_of(const std::vector<FacePair>& pairs) {
    Arrays result;
    for (const auto& [a, b] : pairs) result.numbers[0].insert(result.numbers[0].end(), {a, b});
    return result;
}

} // namespace

ECHINUS_EXPORT(mesh_make)
TriangleMesh* mesh_make(const float* vertices, std::uint32_t vertex_count, const std::uint32_t* faces,
                        std::uint32_t face_count) {
    return make_handle([&] {
        const auto* triangles = reinterpret_cast<const Triangle*>(faces);
        TriangleMesh mesh{vertices_at(vertices, vertex_count), {triangles, triangles + face_count}};
        require_valid(mesh);
        return mesh;
    });
}

ECHINUS_EXPORT(mesh_make_from_polygons)
TriangleMesh* mesh_make_from_polygons(const float* vertices, std::uint32_t vertex_count,
                                      const std::uint32_t* corners, std::uint32_t corner_count,
                                      const std::uint32_t* corner_counts, std::uint32_t polygon_count) {
    return make_handle([&] {
        const std::vector<Vec3f> points = vertices_at(vertices, vertex_count);
        const PolygonMesh polygons{std::vector<Vec3d>(points.begin(), points.end()),
                                   {corners, corners + corner_count},
                                   {corner_counts, corner_counts + polygon_count}};
        require_corners(polygons);
        TriangleMesh mesh = triangulate(polygons, {"the polygons", {}});
        move_to_origin({}, mesh); // floats are what they are
        require_valid(mesh);
        return mesh;
    });
}

ECHINUS_EXPORT(mesh_read)
TriangleMesh* mesh_read(const char* bytes, std::uint32_t byte_count, const char* name,
                        std::uint32_t name_size) {
    return make_handle([&] {
        return read_mesh_bytes({std::string(text_at(name, name_size)), text_at(bytes, byte_count)});
    });
}

ECHINUS_EXPORT(mesh_make_torus)
TriangleMesh* mesh_make_torus(double major_radius, double minor_radius, std::uint32_t major_segments,
                              std::uint32_t minor_segments) {
    return make_handle(
        [&] { return make_torus(major_radius, minor_radius, major_segments, minor_segments); });
}
ECHINUS_EXPORT(mesh_make_sphere)
TriangleMesh* mesh_make_sphere(double radius, std::uint32_t meridian_count, std::uint32_t parallel_count) {
    return make_handle([&] { return make_sphere(radius, meridian_count, parallel_count); });
}
ECHINUS_EXPORT(mesh_make_box)
TriangleMesh* mesh_make_box(double x, double y, double z, std::uint32_t segments) {
    return make_handle([&] { return make_box({x, y, z}, segments); });
}
ECHINUS_EXPORT(mesh_delete) void mesh_delete(TriangleMesh* mesh) {
    delete mesh;
}

ECHINUS_EXPORT(mesh_vertices) const Vec3f* mesh_vertices(const TriangleMesh* mesh) {
    return mesh->vertices.data();
}
ECHINUS_EXPORT(mesh_origin) const Vec3d* mesh_origin(const TriangleMesh* mesh) {
    return &mesh->origin;
}
ECHINUS_EXPORT(mesh_vertex_count) std::uint32_t mesh_vertex_count(const TriangleMesh* mesh) {
    return static_cast<std::uint32_t>(mesh->vertices.size());
}
ECHINUS_EXPORT(mesh_faces) const Triangle* mesh_faces(const TriangleMesh* mesh) {
    return mesh->faces.data();
}
ECHINUS_EXPORT(mesh_face_count) std::uint32_t mesh_face_count(const TriangleMesh* mesh) {
    return static_cast<std::uint32_t>(mesh->faces.size());
}

ECHINUS_EXPORT(mesh_report) Text* mesh_report(const TriangleMesh* mesh) {
    return make_json([&] { return to_json(inspect(*mesh)); });
}

ECHINUS_EXPORT(mesh_faults) Arrays* mesh_faults(const TriangleMesh* mesh) {
    return make_handle([&] { return find_faults(*mesh); });
}

ECHINUS_EXPORT(mesh_weld) TriangleMesh* mesh_weld(const TriangleMesh* mesh) {
    return make_handle([&] { return weld(*mesh); });
}

ECHINUS_EXPORT(mesh_repair)
RepairedMesh* mesh_repair(const TriangleMesh* mesh, bool duplicate_faces, bool doubled_patches,
                          bool inside_out, bool seams, bool slivers, bool orientation) {
    const RepairOptions options{.drop_duplicate_faces = duplicate_faces,
                                .drop_doubled_patches = doubled_patches,
                                .flip_inside_out = inside_out,
                                .close_seams = seams,
                                .drop_loose_slivers = slivers,
                                .orient_faces = orientation};
    return make_handle([&] { return repair(*mesh, options); });
}
/// Moves the mesh out.
ECHINUS_EXPORT(repaired_mesh) TriangleMesh* repaired_mesh(RepairedMesh* repaired) {
    return make_handle([&] { return std::move(repaired->mesh); });
}
ECHINUS_EXPORT(repaired_report) Text* repaired_report(const RepairedMesh* repaired) {
    return make_json([&] { return to_json(repaired->report); });
}
ECHINUS_EXPORT(repaired_delete) void repaired_delete(RepairedMesh* repaired) {
    delete repaired;
}

ECHINUS_EXPORT(mesh_intersecting_pairs)
Arrays* mesh_intersecting_pairs(const TriangleMesh* mesh, const TriangleMesh* other) {
    return make_handle([&] { return numbers_of(intersecting_pairs(*mesh, *other)); });
}
ECHINUS_EXPORT(mesh_self_intersecting_pairs)
Arrays* mesh_self_intersecting_pairs(const TriangleMesh* mesh) {
    return make_handle([&] { return numbers_of(self_intersecting_pairs(*mesh)); });
}

ECHINUS_EXPORT(mesh_winding_number)
double mesh_winding_number(const TriangleMesh* mesh, double x, double y, double z) {
    return winding_number(*mesh, {x, y, z});
}
ECHINUS_EXPORT(mesh_unsigned_distance)
double mesh_unsigned_distance(const TriangleMesh* mesh, double x, double y, double z) {
    return unsigned_distance(*mesh, {x, y, z});
}

} // namespace echinus::wasm
