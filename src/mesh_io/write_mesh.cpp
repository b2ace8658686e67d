#include "files/atomic_file.hpp"
#include "mesh_io/encode.hpp"
#include "mesh_io/mesh_source.hpp"

#include <echinus/error.hpp>
#include <echinus/mesh_io.hpp>

namespace echinus {

namespace {

using Encode = std::string (*)(const TriangleMesh&);

Encode encoder_for(const std::filesystem::path& path) {
    const std::string ending = lower_case_ending(path);
    if (ending == ".obj") return encode_obj;
    if (ending == ".off") return encode_off;
    if (ending == ".ply") return encode_ply;
    if (ending == ".stl") return encode_stl;
    throw Error(ErrorCode::WrongFormat, path.string() +
                                            ": meshes are written to files that end in .obj, .ply, "
                                            ".stl or .off, not in '" +
                                            ending + "'");
}

} // namespace

void write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh) {
    const Encode encode = encoder_for(path);
    require_valid(mesh);
    write_file(path, encode(mesh));
}

void write_mesh_and_edges(const std::filesystem::path& path, const MeshAndEdges& drawn) {
    if (drawn.edges.empty()) return write_mesh(path, drawn.mesh);
    if (encoder_for(path) != encode_obj)
        throw Error(ErrorCode::WrongFormat,
                    path.string() + ": edges without faces are written to files that end in .obj");
    TriangleMesh joined = drawn.mesh;
    for (const auto& [a, b] : drawn.edges) joined.faces.push_back({a, b, b});
    require_valid(joined);
    write_file(path, encode_obj(drawn.mesh) + encode_obj_lines(drawn.edges));
}

} // namespace echinus
