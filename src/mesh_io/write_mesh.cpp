#include "mesh_io/write_mesh.hpp"

#include "files/atomic_file.hpp"
#include "files/read_file.hpp"
#include "mesh_io/line_scanner.hpp"
#include "mesh_io/mesh_source.hpp"
#include "mesh_io/readers.hpp"

#include <echinus/error.hpp>
#include <echinus/mesh_io.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <limits>
#include <map>
#include <string_view>
#include <utility>

namespace echinus {

namespace {

template <typename Number>
void append_text(std::string& text, Number value) {
    std::array<char, 32> digits;
    const auto result = std::to_chars(digits.data(), digits.data() + digits.size(), value);
    text.append(digits.data(), result.ptr);
}

/// "x y z"
template <typename Number>
void append_three(std::string& text, Number x, Number y, Number z) {
    append_text(text, x);
    text += ' ';
    append_text(text, y);
    text += ' ';
    append_text(text, z);
}

/// "x y z\n"
template <typename Number>
void append_line(std::string& text, Number x, Number y, Number z) {
    append_three(text, x, y, z);
    text += '\n';
}

template <typename Number>
void append_little_endian(std::string& bytes, Number value) {
    auto raw = std::bit_cast<std::array<char, sizeof(Number)>>(value);
    if constexpr (std::endian::native == std::endian::big) std::reverse(raw.begin(), raw.end());
    bytes.append(raw.data(), raw.size());
}

template <typename Number>
void append_little_endian(std::string& bytes, const Vec3<Number>& v) {
    for (const Number coordinate : {v.x, v.y, v.z}) append_little_endian(bytes, coordinate);
}

template <typename Mesh>
bool has_origin(const Mesh& mesh) {
    return mesh.origin != Vec3d{};
}

/// The coordinate in the frame of files: the number with the fewest decimals of those that give the same
/// float when they are read.
double in_file(float local, double origin) {
    const double exact = local + origin;
    for (int decimals = 0; decimals < std::numeric_limits<double>::max_digits10; ++decimals) {
        std::array<char, 32> digits;
        const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), exact,
                                       std::chars_format::scientific, decimals);
        double shorter = 0;
        parse_number(std::string_view(digits.data(), end.ptr - digits.data()), shorter);
        if (static_cast<float>(shorter - origin) == local) return shorter;
    }
    return exact;
}

Vec3d in_file(const Vec3f& local, const Vec3d& origin) {
    return {in_file(local.x, origin.x), in_file(local.y, origin.y), in_file(local.z, origin.z)};
}

/// Writes a position in the frame of files: as floats, or as doubles if the mesh has an origin.
template <typename Mesh, typename Write>
void write_position(const Mesh& mesh, const Vec3f& vertex, const Write& write) {
    if (has_origin(mesh))
        write(in_file(vertex, mesh.origin));
    else
        write(vertex);
}

template <typename Mesh, typename Write>
void for_each_position(const Mesh& mesh, const Write& write) {
    for (const Vec3f& vertex : mesh.vertices) write_position(mesh, vertex, write);
}

Vec3f unit_normal(const TriangleMesh& mesh, const Triangle& face) {
    const Vec3d a(mesh.vertices[face[0]]);
    const Vec3d normal = cross(Vec3d(mesh.vertices[face[1]]) - a, Vec3d(mesh.vertices[face[2]]) - a);
    const double size = length(normal);
    return size > 0 ? Vec3f(normal * (1 / size)) : Vec3f{};
}

} // namespace

std::string encode_obj(const TriangleMesh& mesh) {
    std::string text;
    for_each_position(mesh, [&](const auto& p) {
        text += "v ";
        append_line(text, p.x, p.y, p.z);
    });
    for (const Triangle& f : mesh.faces) {
        text += "f ";
        append_line(text, f[0] + 1ULL, f[1] + 1ULL, f[2] + 1ULL);
    }
    return text;
}

std::string encode_obj_lines(std::span<const std::array<std::uint32_t, 2>> edges) {
    std::string text;
    for (const auto& [a, b] : edges) {
        text += "l ";
        append_text(text, a + 1ULL);
        text += ' ';
        append_text(text, b + 1ULL);
        text += '\n';
    }
    return text;
}

std::string encode_moved_obj(const MeshSource& source, const TriangleMesh& before, const TriangleMesh& mesh) {
    if (mesh.vertices.size() != before.vertices.size())
        source.fail(ErrorCode::InvalidMesh, "the file has " + std::to_string(before.vertices.size()) +
                                                " vertices of faces, but the mesh that moved has " +
                                                std::to_string(mesh.vertices.size()));
    std::map<std::array<float, 3>, std::size_t> vertices; // at one position there is one vertex
    for (std::size_t v = 0; v < before.vertices.size(); ++v) {
        const auto& [x, y, z] = before.vertices[v];
        vertices[{x, y, z}] = v;
    }
    std::string text;
    const char* written = source.bytes.data(); // up to here
    LineScanner scanner(source, LineScanner::Continuation::Backslash);
    while (scanner.next_line()) {
        if (scanner.next_word() != "v") continue;
        if (scanner.is_joined())
            scanner.fail(ErrorCode::WrongFormat, "a vertex on several lines cannot be replaced");
        const std::string_view x = scanner.next_word(), y = scanner.next_word(), z = scanner.next_word();
        std::array<double, 3> position{};
        for (const auto& [word, value] : {std::pair{x, &position[0]}, {y, &position[1]}, {z, &position[2]}})
            if (!parse_number(word, *value)) scanner.fail_expecting("a coordinate", word);
        const Vec3f local(Vec3d{position[0], position[1], position[2]} - before.origin);
        const auto found = vertices.find({local.x, local.y, local.z});
        if (found == vertices.end()) continue; // no face has it
        text.append(written, x.data());
        write_position(mesh, mesh.vertices[found->second],
                       [&](const auto& p) { append_three(text, p.x, p.y, p.z); });
        written = z.data() + z.size();
    }
    return text.append(written, source.bytes.data() + source.bytes.size());
}

std::string encode_off(const TriangleMesh& mesh) {
    std::string text =
        "OFF\n" + std::to_string(mesh.vertices.size()) + " " + std::to_string(mesh.faces.size()) + " 0\n";
    for_each_position(mesh, [&](const auto& p) { append_line(text, p.x, p.y, p.z); });
    for (const Triangle& f : mesh.faces) {
        text += "3 ";
        append_line(text, f[0], f[1], f[2]);
    }
    return text;
}

std::string encode_painted_ply(const TriangleMesh& mesh, std::span<const Colour> vertex_colours,
                               std::span<const Colour> face_colours,
                               std::span<const std::array<std::uint32_t, 2>> edges) {
    const std::string property = std::string("\nproperty ") + (has_origin(mesh) ? "double " : "float ");
    const auto colour_properties = [](std::span<const Colour> colours) {
        return colours.empty() ? "" : "\nproperty uchar red\nproperty uchar green\nproperty uchar blue";
    };
    std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                        std::to_string(mesh.vertices.size()) + property + "x" + property + "y" + property +
                        "z" + colour_properties(vertex_colours) + "\nelement face " +
                        std::to_string(mesh.faces.size()) + "\nproperty list uchar uint vertex_indices" +
                        colour_properties(face_colours);
    if (!edges.empty())
        bytes +=
            "\nelement edge " + std::to_string(edges.size()) + "\nproperty int vertex1\nproperty int vertex2";
    bytes += "\nend_header\n";
    const auto append_colour = [&bytes](std::span<const Colour> colours, std::size_t i) {
        if (!colours.empty())
            for (const std::uint8_t share : colours[i]) append_little_endian(bytes, share);
    };
    std::size_t vertex = 0;
    for_each_position(mesh, [&](const auto& p) {
        append_little_endian(bytes, p);
        append_colour(vertex_colours, vertex++);
    });
    for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
        append_little_endian(bytes, std::uint8_t{3});
        for (const std::uint32_t corner : mesh.faces[face]) append_little_endian(bytes, corner);
        append_colour(face_colours, face);
    }
    for (const auto& edge : edges)
        for (const std::uint32_t end : edge) append_little_endian(bytes, end);
    return bytes;
}

std::string encode_ply(const TriangleMesh& mesh) {
    return encode_painted_ply(mesh, {}, {}, {});
}

namespace {

std::string encode_text_stl(const TriangleMesh& mesh) {
    std::string text = "solid\n";
    for (const Triangle& f : mesh.faces) {
        const Vec3f normal = unit_normal(mesh, f);
        text += "facet normal ";
        append_line(text, normal.x, normal.y, normal.z);
        text += "outer loop\n";
        for (const std::uint32_t vertex : f) {
            const Vec3d p = in_file(mesh.vertices[vertex], mesh.origin);
            text += "vertex ";
            append_line(text, p.x, p.y, p.z);
        }
        text += "endloop\nendfacet\n";
    }
    return text + "endsolid\n";
}

} // namespace

std::string encode_stl(const TriangleMesh& mesh) {
    if (has_origin(mesh)) return encode_text_stl(mesh); // the binary kind has floats only
    std::string bytes = "binary STL";
    bytes.resize(80, ' ');
    append_little_endian(bytes, static_cast<std::uint32_t>(mesh.faces.size()));
    for (const Triangle& f : mesh.faces) {
        append_little_endian(bytes, unit_normal(mesh, f));
        for (const std::uint32_t vertex : f) append_little_endian(bytes, mesh.vertices[vertex]);
        append_little_endian(bytes, std::uint16_t{0}); // attributes
    }
    return bytes;
}

std::string encode_msh(const TetrahedralMesh& mesh) {
    std::string text =
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" + std::to_string(mesh.vertices.size()) + "\n";
    std::size_t node = 0;
    for_each_position(mesh, [&](const auto& p) {
        append_text(text, ++node);
        text += ' ';
        append_line(text, p.x, p.y, p.z);
    });
    text += "$EndNodes\n$Elements\n" + std::to_string(mesh.tetrahedra.size()) + "\n";
    for (std::size_t number = 0; number < mesh.tetrahedra.size(); ++number) {
        append_text(text, number + 1);
        text += " 4 2 1 1"; // a tetrahedron with two tags: the physical and the geometrical entity
        for (const std::uint32_t vertex : mesh.tetrahedra[number]) {
            text += ' ';
            append_text(text, vertex + 1ULL);
        }
        text += '\n';
    }
    return text + "$EndElements\n";
}

std::string encode_vtk(const TetrahedralMesh& mesh) {
    const std::string count = std::to_string(mesh.tetrahedra.size());
    std::string text = "# vtk DataFile Version 3.0\ntetrahedra\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS " +
                       std::to_string(mesh.vertices.size()) + (has_origin(mesh) ? " double\n" : " float\n");
    for_each_position(mesh, [&](const auto& p) { append_line(text, p.x, p.y, p.z); });
    text += "CELLS " + count + " " + std::to_string(5 * mesh.tetrahedra.size()) + "\n";
    for (const Tetrahedron& corners : mesh.tetrahedra) {
        text += "4 ";
        append_text(text, corners[0]);
        text += ' ';
        append_line(text, corners[1], corners[2], corners[3]);
    }
    text += "CELL_TYPES " + count + "\n";
    for (std::size_t i = 0; i < mesh.tetrahedra.size(); ++i) text += "10\n"; // VTK_TETRA
    return text;
}

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

bool write_moved_mesh(const std::filesystem::path& path, const TriangleMesh& mesh,
                      const std::filesystem::path& original) {
    if (encoder_for(path) == encode_obj && lower_case_ending(original) == ".obj") {
        require_valid(mesh);
        const std::vector<std::byte> bytes = read_file(original);
        const MeshSource source{original.string(),
                                {reinterpret_cast<const char*>(bytes.data()), bytes.size()}};
        const std::string moved = encode_moved_obj(source, read_mesh(source), mesh);
        if (read_mesh(MeshSource{original.string(), moved}).faces == mesh.faces) {
            write_file(path, moved);
            return true;
        }
    }
    write_mesh(path, mesh);
    return false;
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

void write_tetrahedra(const std::filesystem::path& path, const TetrahedralMesh& mesh) {
    const std::string ending = lower_case_ending(path);
    if (ending != ".msh" && ending != ".vtk")
        throw Error(ErrorCode::WrongFormat, path.string() +
                                                ": tetrahedra are written to files that end in .msh or .vtk, "
                                                "not in " +
                                                in_quotes(ending));
    require_valid_tetrahedra(mesh);
    write_file(path, ending == ".msh" ? encode_msh(mesh) : encode_vtk(mesh));
}

} // namespace echinus
