#include "files/mapped_file.hpp"
#include "mesh_io/ending.hpp"
#include "mesh_io/readers.hpp"

#include <echinus/mesh_io.hpp>

namespace echinus {

namespace {

PolygonMesh read_polygons(const MeshSource& source) {
    const std::string ending = lower_case_ending(source.name);
    if (ending == ".obj") return read_obj(source);
    if (ending == ".off") return read_off(source);
    if (ending == ".ply") return read_ply(source);
    if (ending == ".stl") return read_stl(source);
    if (ending == ".gltf" || ending == ".glb" || ending == ".3ds") return read_scene(source);
    source.fail(
        ErrorCode::WrongFormat,
        "meshes are read from files that end in .obj, .ply, .stl, .off, .gltf, .glb or .3ds, not in " +
            in_quotes(ending));
}

} // namespace

TriangleMesh read_mesh(const MeshSource& source) {
    if (source.bytes.empty()) source.fail(ErrorCode::Damaged, "the file is empty");
    const TriangleMesh mesh = triangulate(read_polygons(source), source);
    if (mesh.faces.empty()) source.fail(ErrorCode::InvalidMesh, "the file has no faces");
    return weld(mesh);
}

TriangleMesh read_mesh(const std::filesystem::path& path) {
    const MappedFile file(path);
    const auto bytes = file.bytes();
    return read_mesh(MeshSource{path.string(), {reinterpret_cast<const char*>(bytes.data()), bytes.size()}});
}

} // namespace echinus
