#include "mesh_io/byte_reader.hpp"
#include "mesh_io/line_scanner.hpp"
#include "mesh_io/readers.hpp"

#include <array>

// The format: "The StL Format" of 3D Systems, text and binary. Normals and attributes are ignored.

namespace echinus {

namespace {

constexpr std::size_t kHeadSize = 80;
constexpr std::size_t kBytesBeforeFaces = kHeadSize + sizeof(std::uint32_t);
constexpr std::size_t kBytesPerFace = 50; // normal and three corners of three floats, and two bytes

void add_face(PolygonMesh& mesh, const std::array<Vec3f, 3>& corners) {
    for (const Vec3f& corner : corners) {
        mesh.corners.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
        mesh.vertices.push_back(corner);
    }
    mesh.corner_counts.push_back(3);
}

std::uint64_t promised_face_count(const MeshSource& source) {
    return ByteReader(source, kHeadSize, ByteOrder::LittleEndian).next<std::uint32_t>();
}

std::uint64_t promised_size(const MeshSource& source) {
    return kBytesBeforeFaces + kBytesPerFace * promised_face_count(source);
}

/// Many programs also begin binary files with the word solid; only the size distinguishes them.
bool has_size_of_binary(const MeshSource& source) {
    return source.bytes.size() >= kBytesBeforeFaces && source.bytes.size() == promised_size(source);
}

PolygonMesh read_binary(const MeshSource& source) {
    ByteReader bytes(source, kBytesBeforeFaces, ByteOrder::LittleEndian);
    PolygonMesh mesh;
    while (bytes.bytes_left() > 0) {
        std::array<Vec3f, 3> corners;
        bytes.skip(3 * sizeof(float)); // the normal
        for (Vec3f& corner : corners)
            for (float* coordinate : {&corner.x, &corner.y, &corner.z}) *coordinate = bytes.next<float>();
        bytes.skip(2);
        if (!std::all_of(corners.begin(), corners.end(), is_finite<float>))
            source.fail(ErrorCode::InvalidMesh, "face " + std::to_string(mesh.corner_counts.size()) +
                                                    " has a coordinate that is not finite");
        add_face(mesh, corners);
    }
    return mesh;
}

void require_words(LineScanner& scanner, std::initializer_list<std::string_view> words) {
    for (const std::string_view expected : words) {
        const std::string_view word = scanner.next_word();
        if (word != expected) scanner.fail_expecting(in_quotes(expected), word);
    }
}

/// From after the line "facet normal ..." to "endfacet".
void read_facet(LineScanner& scanner, PolygonMesh& mesh) {
    std::array<Vec3f, 3> corners;
    scanner.require_line("'outer loop'");
    require_words(scanner, {"outer", "loop"});
    for (Vec3f& corner : corners) {
        scanner.require_line("a vertex");
        require_words(scanner, {"vertex"});
        for (float* coordinate : {&corner.x, &corner.y, &corner.z}) *coordinate = scanner.next_coordinate();
    }
    scanner.require_line("'endloop'");
    require_words(scanner, {"endloop"});
    scanner.require_line("'endfacet'");
    require_words(scanner, {"endfacet"});
    add_face(mesh, corners);
}

PolygonMesh read_text(const MeshSource& source) {
    LineScanner scanner(source);
    PolygonMesh mesh;
    while (scanner.next_line()) {
        require_words(scanner, {"solid"}); // the rest of the line is its name
        for (;;) {
            scanner.require_line("'facet' or 'endsolid'");
            const std::string_view keyword = scanner.next_word();
            if (keyword == "endsolid") break;
            if (keyword != "facet") scanner.fail_expecting("'facet' or 'endsolid'", keyword);
            read_facet(scanner, mesh);
        }
    }
    return mesh;
}

/// @param found  the size of the file in words
[[noreturn]] void refuse_size(const MeshSource& source, const std::string& found) {
    source.fail(ErrorCode::Damaged, "the head of a binary STL promises " +
                                        std::to_string(promised_face_count(source)) + " faces in " +
                                        std::to_string(promised_size(source)) + " bytes, but the file has " +
                                        found);
}

[[noreturn]] void refuse(const MeshSource& source) {
    if (source.bytes.size() < kBytesBeforeFaces)
        source.fail(ErrorCode::WrongFormat, "neither 'solid', with which a text STL begins, nor the " +
                                                std::to_string(kBytesBeforeFaces) +
                                                " bytes with which a binary one does were found");
    refuse_size(source, std::to_string(source.bytes.size()));
}

bool begins_as_text(std::string_view bytes) {
    bytes.remove_prefix(std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size()));
    return bytes.starts_with("solid");
}

} // namespace

void require_beginning_of_stl(const MeshSource& beginning) {
    if (!begins_as_text(beginning.bytes) && beginning.bytes.size() > promised_size(beginning))
        refuse_size(beginning, "more");
}

PolygonMesh read_stl(const MeshSource& source) {
    if (has_size_of_binary(source)) return read_binary(source);
    if (begins_as_text(source.bytes)) return read_text(source);
    refuse(source);
}

} // namespace echinus
