#include "mesh_io/readers.hpp"

#include <limits>
#include <string>

// The format: the manual of TetGen, chapter "File Formats"
// (https://wias-berlin.de/software/tetgen/fformats.html): a .node file with the points and an .ele file with
// the tetrahedra. The number of the first point, 0 or 1, is the number from which both files count.
// Attributes, markers and regions are ignored.

namespace echinus {

namespace {

void require_number(LineScanner& scanner, std::int64_t expected, const char* what) {
    const std::int64_t number = scanner.next_integer(what);
    if (number != expected)
        scanner.fail(ErrorCode::Damaged, std::string(what) + " should be " + std::to_string(expected) +
                                             ", not " + std::to_string(number));
}

/// @returns the number of the first point
std::int64_t read_nodes(const MeshSource& source, TetrahedraInFile& mesh) {
    LineScanner scanner(source);
    scanner.require_line("the number of points");
    const std::size_t point_count = scanner.next_count("the number of points");
    require_number(scanner, 3, "the dimension");
    std::int64_t first = 0;
    for (std::size_t i = 0; i < point_count; ++i) {
        scanner.require_line("point " + std::to_string(i + 1) + " of " + std::to_string(point_count));
        if (i == 0) {
            first = scanner.next_integer("a point's number");
            if (first != 0 && first != 1)
                scanner.fail(ErrorCode::Damaged,
                             "points are numbered from 0 or 1, not from " + std::to_string(first));
        } else {
            require_number(scanner, first + static_cast<std::int64_t>(i), "the point's number");
        }
        mesh.vertices.push_back(scanner.next_position());
    }
    return first;
}

std::uint32_t next_corner(LineScanner& scanner, std::int64_t first, std::size_t point_count) {
    const std::int64_t number = scanner.next_integer("a point's number");
    // Compared before the subtraction, which could overflow.
    if (number < first || static_cast<std::uint64_t>(number - first) >= point_count)
        scanner.fail(ErrorCode::InvalidMesh, "the tetrahedron refers to point " + std::to_string(number) +
                                                 ", but there are " + std::to_string(point_count) +
                                                 " points, numbered from " + std::to_string(first));
    return static_cast<std::uint32_t>(number - first);
}

} // namespace

TetrahedraInFile read_tetgen(const MeshSource& nodes, const MeshSource& elements) {
    TetrahedraInFile mesh;
    const std::int64_t first = read_nodes(nodes, mesh);
    LineScanner scanner(elements);
    scanner.require_line("the number of tetrahedra");
    const std::size_t count = scanner.next_count("the number of tetrahedra");
    if (const std::size_t corner_count = scanner.next_count("the number of corners"); corner_count != 4)
        scanner.fail(ErrorCode::WrongFormat, "tetrahedra of four points are read, not of " +
                                                 std::to_string(corner_count) + "; run TetGen without -o2");
    for (std::size_t i = 0; i < count; ++i) {
        scanner.require_line("tetrahedron " + std::to_string(i + 1) + " of " + std::to_string(count));
        require_number(scanner, first + static_cast<std::int64_t>(i), "the tetrahedron's number");
        Tetrahedron& corners = mesh.tetrahedra.emplace_back();
        for (std::uint32_t& corner : corners) corner = next_corner(scanner, first, mesh.vertices.size());
    }
    if (scanner.next_line())
        scanner.fail(ErrorCode::Damaged, "the file continues after the " + std::to_string(count) +
                                             " tetrahedra that its header declares");
    return mesh;
}

} // namespace echinus
