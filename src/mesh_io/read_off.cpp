#include "mesh_io/line_scanner.hpp"
#include "mesh_io/readers.hpp"

#include <limits>

// The format: "Object File Format" of Geomview (https://www.geomview.org/docs/html/OFF.html). Colours,
// normals and texture coordinates follow the position on a vertex's line, and colours the indices on a face's
// line; they are ignored.

namespace echinus {

namespace {

/// OFF, or OFF with the letters for texture coordinates, colours and normals before it.
void require_off_keyword(LineScanner& scanner) {
    const std::string_view keyword = scanner.next_word();
    std::string_view extras = keyword;
    for (const std::string_view letters : {"ST", "C", "N"})
        if (extras.starts_with(letters)) extras.remove_prefix(letters.size());
    if (extras != "OFF")
        scanner.fail_expecting("OFF, COFF, NOFF or the like", keyword, ErrorCode::WrongFormat);
}

std::size_t next_count(LineScanner& scanner, const char* what) {
    const std::int64_t count = scanner.next_integer(what);
    if (count < 0 || count >= std::numeric_limits<std::uint32_t>::max())
        scanner.fail(ErrorCode::Damaged, "there cannot be " + std::to_string(count) + " of them");
    return static_cast<std::size_t>(count);
}

void read_face(LineScanner& scanner, PolygonMesh& mesh) {
    const std::size_t corner_count = next_count(scanner, "the number of the face's corners");
    for (std::size_t corner = 0; corner < corner_count; ++corner)
        mesh.corners.push_back(scanner.next_vertex_index(mesh.vertices.size()));
    mesh.corner_counts.push_back(static_cast<std::uint32_t>(corner_count));
}

std::string promised(const char* kind, std::size_t index, std::size_t count) {
    return std::string(kind) + " " + std::to_string(index + 1) + " of " + std::to_string(count);
}

} // namespace

PolygonMesh read_off(const MeshSource& source) {
    LineScanner scanner(source);
    scanner.require_line("the word OFF");
    require_off_keyword(scanner);
    if (scanner.at_end_of_line()) scanner.require_line("the number of vertices");
    const std::size_t vertex_count = next_count(scanner, "the number of vertices");
    const std::size_t face_count = next_count(scanner, "the number of faces");

    // Nothing is reserved: the counts may be false, but the lines exist.
    PolygonMesh mesh;
    for (std::size_t vertex = 0; vertex < vertex_count; ++vertex) {
        scanner.require_line(promised("vertex", vertex, vertex_count));
        const float x = scanner.next_coordinate();
        const float y = scanner.next_coordinate();
        const float z = scanner.next_coordinate();
        mesh.vertices.emplace_back(x, y, z);
    }
    for (std::size_t face = 0; face < face_count; ++face) {
        scanner.require_line(promised("face", face, face_count));
        read_face(scanner, mesh);
    }
    if (scanner.next_line())
        scanner.fail(ErrorCode::Damaged, "the file goes on after the " + std::to_string(face_count) +
                                             " faces that its head promises");
    return mesh;
}

} // namespace echinus
