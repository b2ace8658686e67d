// Meshes from polygons and from files in memory, and all faults of a mesh.

#include "interface.hpp"
#include "mesh/faces.hpp"
#include "mesh/local_frame.hpp"
#include "mesh_io/readers.hpp"

#include <echinus/error.hpp>

namespace echinus::wasm {

namespace {

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

/// Every fault of a mesh with its place, for drawing.
struct Faults {
    std::vector<std::uint32_t> border, nonmanifold, misoriented; ///< two vertices of each edge
    std::vector<std::uint32_t> duplicate, degenerate;            ///< faces
};

Faults find_faults(const TriangleMesh& mesh) {
    require_valid(mesh);
    Faults faults;
    const auto add = [](std::vector<std::uint32_t>& edges, const EdgeUse& use) {
        edges.push_back(use.low);
        edges.push_back(use.high);
    };
    const std::vector<EdgeUse> edge_uses = sorted_edge_uses(mesh);
    for_each_edge(edge_uses, [&](std::span<const EdgeUse> uses) {
        if (uses.size() == 1) add(faults.border, uses[0]);
        if (uses.size() > 2) add(faults.nonmanifold, uses[0]);
        if (uses.size() == 2 && !is_balanced(uses)) add(faults.misoriented, uses[0]);
    });
    faults.duplicate = find_duplicate_faces(mesh);
    faults.degenerate = find_degenerate_faces(mesh);
    return faults;
}

} // namespace

ECHINUS_EXPORT(wasm_mesh_from_polygons)
echinus_status wasm_mesh_from_polygons(const float* vertices, std::uint32_t vertex_count,
                                       const std::uint32_t* corners, std::uint32_t corner_count,
                                       const std::uint32_t* corner_counts, std::uint32_t polygon_count,
                                       echinus_mesh** result) {
    return make(__func__, result, [&] {
        const std::vector<Vec3f> points = points_from(vertices, vertex_count, 0, "vertices");
        const PolygonMesh polygons{std::vector<Vec3d>(points.begin(), points.end()),
                                   {corners, corners + corner_count},
                                   {corner_counts, corner_counts + polygon_count}};
        require_corners(polygons);
        TriangleMesh mesh = triangulate(polygons, {"the polygons", {}});
        move_to_origin({}, mesh); // no origin: the caller's coordinates are floats already
        require_valid(mesh);
        return mesh;
    });
}

ECHINUS_EXPORT(wasm_mesh_from_bytes)
echinus_status wasm_mesh_from_bytes(const char* bytes, std::uint32_t byte_count, const char* name,
                                    echinus_mesh** result) {
    return make(__func__, result, [&] { return read_mesh_bytes({name, {bytes, byte_count}}); });
}

ECHINUS_EXPORT(wasm_mesh_faults)
echinus_status wasm_mesh_faults(const echinus_mesh* mesh, echinus_array** border, echinus_array** nonmanifold,
                                echinus_array** misoriented, echinus_array** duplicate,
                                echinus_array** degenerate) {
    return guarded(__func__, [&] {
        Faults faults = find_faults(mesh->value);
        put_arrays({border, nonmanifold, misoriented, duplicate, degenerate},
                   {array_of(std::move(faults.border)), array_of(std::move(faults.nonmanifold)),
                    array_of(std::move(faults.misoriented)), array_of(std::move(faults.duplicate)),
                    array_of(std::move(faults.degenerate))});
    });
}

} // namespace echinus::wasm
