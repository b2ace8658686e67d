#include "files/mapped_file.hpp"
#include "mesh_io/line_scanner.hpp"
#include "mesh_io/mesh_source.hpp"
#include "mesh_io/readers.hpp"
#include "mesh_io/scene_guards.hpp"

#include <echinus/mesh_io.hpp>

#include <span>

namespace echinus {

namespace {

/// Control characters in the first line are refused. A binary PLY file, too, begins with lines of text.
void require_beginning_of_text(const MeshSource& beginning) {
    LineScanner(beginning).next_line();
}

struct Format {
    std::string_view ending;
    PolygonMesh (*read)(const MeshSource&);
    void (*require_beginning)(const MeshSource&);
};

constexpr Format kFormats[] = {
    {".obj", read_obj, require_beginning_of_text},    {".off", read_off, require_beginning_of_text},
    {".ply", read_ply, require_beginning_of_text},    {".stl", read_stl, require_beginning_of_stl},
    {".gltf", read_scene, require_beginning_of_gltf}, {".glb", read_scene, require_beginning_of_glb},
    {".3ds", read_scene, require_beginning_of_3ds}};

const Format& format_of(const MeshSource& source) {
    const std::string ending = lower_case_ending(source.name);
    for (const Format& format : kFormats)
        if (format.ending == ending) return format;
    source.fail(
        ErrorCode::WrongFormat,
        "meshes are read from files that end in .obj, .ply, .stl, .off, .gltf, .glb or .3ds, not in " +
            in_quotes(ending));
}

} // namespace

void require_beginning(const MeshSource& beginning) {
    format_of(beginning).require_beginning(beginning);
}

TriangleMesh read_mesh(const MeshSource& source) {
    if (source.bytes.empty()) source.fail(ErrorCode::Damaged, "the file is empty");
    const TriangleMesh mesh = triangulate(format_of(source).read(source), source);
    if (mesh.faces.empty()) source.fail(ErrorCode::InvalidMesh, "the file has no faces");
    return weld(mesh);
}

TriangleMesh read_mesh(const std::filesystem::path& path) {
    const auto source = [&](std::span<const std::byte> bytes) {
        return MeshSource{path.string(), {reinterpret_cast<const char*>(bytes.data()), bytes.size()}};
    };
    const MappedFile file(path, [&](auto beginning) { require_beginning(source(beginning)); });
    return read_mesh(source(file.bytes()));
}

} // namespace echinus
