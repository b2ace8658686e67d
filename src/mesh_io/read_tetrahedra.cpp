#include "files/read_file.hpp"
#include "mesh_io/tetrahedra_readers.hpp"
#include "tetrahedra/mend.hpp"

#include <span>
#include <utility>

namespace echinus {

namespace {

MeshSource source_of(const std::filesystem::path& path, std::span<const std::byte> bytes) {
    return {path.string(), {reinterpret_cast<const char*>(bytes.data()), bytes.size()}};
}

void require_content(const MeshSource& source) {
    if (source.bytes.empty()) source.fail(ErrorCode::Damaged, "the file is empty");
}

TetrahedraFile read_pair(std::filesystem::path path) {
    const std::filesystem::path nodes_path = path.replace_extension(".node");
    const std::filesystem::path elements_path = path.replace_extension(".ele");
    const std::vector<std::byte> node_bytes = read_file(nodes_path), element_bytes = read_file(elements_path);
    const MeshSource nodes = source_of(nodes_path, node_bytes);
    const MeshSource elements = source_of(elements_path, element_bytes);
    require_content(nodes);
    require_content(elements);
    return finish_tetrahedra(read_tetgen(nodes, elements), elements);
}

} // namespace

TetrahedraFile finish_tetrahedra(TetrahedraInFile read, const MeshSource& source) {
    if (read.tetrahedra.empty()) source.fail(ErrorCode::InvalidMesh, "the file has no tetrahedra");
    TetrahedralMesh mesh = local_body(read.vertices, std::move(read.tetrahedra));
    TetrahedraFile file;
    file.turned_tetrahedra = turn_negative(mesh);
    try {
        require_valid_tetrahedra(mesh);
    } catch (const Error& error) {
        source.fail(error.code(), error.what());
    }
    file.dropped_vertices = drop_unused_vertices(mesh);
    file.mesh = std::move(mesh);
    return file;
}

TetrahedraFile read_tetrahedra(const MeshSource& source) {
    require_content(source);
    return finish_tetrahedra(lower_case_ending(source.name) == ".msh" ? read_msh(source) : read_vtk(source),
                             source);
}

TetrahedraFile read_tetrahedra(const std::filesystem::path& path) {
    const std::string ending = lower_case_ending(path);
    if (ending == ".node" || ending == ".ele") return read_pair(path);
    if (ending != ".msh" && ending != ".vtk")
        throw Error(ErrorCode::WrongFormat,
                    path.string() +
                        ": tetrahedra are read from files that end in .msh, .vtk, .node or .ele, not in " +
                        in_quotes(ending));
    const std::vector<std::byte> bytes = read_file(path, [&](std::span<const std::byte> beginning) {
        // Both kinds begin with a line of text.
        LineScanner(source_of(path, beginning)).next_line();
    });
    return read_tetrahedra(source_of(path, bytes));
}

} // namespace echinus
