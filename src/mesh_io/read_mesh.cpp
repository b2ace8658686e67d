#include "files/read_file.hpp"
#include "mesh_io/line_scanner.hpp"
#include "mesh_io/mesh_source.hpp"
#include "mesh_io/readers.hpp"

#include <echinus/mesh_io.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

namespace {

/// Refuses control characters in the first line. Even a binary PLY file begins with lines of text.
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

PolygonMesh read_polygons(const MeshSource& source) {
    if (source.bytes.empty()) source.fail(ErrorCode::Damaged, "the file is empty");
    return format_of(source).read(source);
}

/// The polygons with two corners.
std::vector<std::array<std::uint32_t, 2>> edges_of(const PolygonMesh& polygons) {
    std::vector<std::array<std::uint32_t, 2>> edges;
    std::size_t begin = 0;
    for (const std::uint32_t count : polygons.corner_counts) {
        if (count == 2) edges.push_back({polygons.corners[begin], polygons.corners[begin + 1]});
        begin += count;
    }
    return edges;
}

/// The result of `read` for the file's bytes.
template <typename Read>
auto read_from(const std::filesystem::path& path, const Read& read) {
    const auto source = [&](std::span<const std::byte> bytes) {
        return MeshSource{path.string(), {reinterpret_cast<const char*>(bytes.data()), bytes.size()}};
    };
    const std::vector<std::byte> bytes =
        read_file(path, [&](auto beginning) { require_beginning(source(beginning)); });
    return read(source(bytes));
}

} // namespace

void require_beginning(const MeshSource& beginning) {
    format_of(beginning).require_beginning(beginning);
}

TriangleMesh read_mesh(const MeshSource& source) {
    const TriangleMesh mesh = triangulate(read_polygons(source), source);
    if (mesh.faces.empty()) source.fail(ErrorCode::InvalidMesh, "the file has no faces");
    return weld(mesh);
}

MeshAndEdges read_mesh_and_edges(const MeshSource& source) {
    const PolygonMesh polygons = read_polygons(source);
    TriangleMesh joined = triangulate(polygons, source);
    const std::size_t face_count = joined.faces.size();
    // weld() keeps only the vertices of faces, so edges are passed to it as faces without area.
    for (const auto& [a, b] : edges_of(polygons)) joined.faces.push_back({a, b, b});
    if (joined.faces.empty()) source.fail(ErrorCode::InvalidMesh, "the file has neither faces nor lines");
    MeshAndEdges result{.mesh = weld(joined), .edges = {}};
    std::vector<Triangle>& faces = result.mesh.faces;
    for (std::size_t i = face_count; i < faces.size(); ++i)
        result.edges.push_back({faces[i][0], faces[i][1]});
    faces.resize(face_count);
    return result;
}

TriangleMesh read_mesh(const std::filesystem::path& path) {
    return read_from(path, [](const MeshSource& source) { return read_mesh(source); });
}

MeshAndEdges read_mesh_and_edges(const std::filesystem::path& path) {
    return read_from(path, [](const MeshSource& source) { return read_mesh_and_edges(source); });
}

} // namespace echinus
