#include "mesh_io/line_scanner.hpp"
#include "mesh_io/readers.hpp"

#include <limits>

// The format: "Object File Format" of Geomview (https://www.geomview.org/docs/html/OFF.html), as text. Each
// vertex and each face has a line; normals, colours and texture coordinates that follow on it are ignored. If
// the number of lines differs from the number of vertices and faces, the numbers of a vertex and the corners
// of a face may continue on the next line.

namespace echinus {

namespace {

std::string promised(const char* kind, std::size_t index, std::size_t count) {
    return std::string(kind) + " " + std::to_string(index + 1) + " of " + std::to_string(count);
}

class OffReader {
  public:
    explicit OffReader(const MeshSource& source) : source_(source), scanner_(source) {}

    PolygonMesh read() {
        scanner_.require_line("the word OFF");
        scanner_.read_across_lines();
        read_keyword();
        const std::size_t vertex_count = scanner_.next_count("the number of vertices");
        const std::size_t face_count = scanner_.next_count("the number of faces");
        skip_edge_count();
        begin_body(vertex_count + face_count);
        // No memory is reserved, since the counts may be wrong, whereas the lines exist.
        for (std::size_t i = 0; i < vertex_count; ++i) read_vertex(promised("vertex", i, vertex_count));
        for (std::size_t i = 0; i < face_count; ++i) read_face(promised("face", i, face_count));
        scanner_.read_within_lines();
        if (scanner_.next_line())
            scanner_.fail(ErrorCode::Damaged, "the file continues after the " + std::to_string(face_count) +
                                                  " faces that its header declares");
        return std::move(mesh_);
    }

  private:
    /// [ST][C][N][4][n]OFF, which may be one word with the number of vertices, as in the files of ModelNet.
    /// Geomview accepts files without it.
    void read_keyword() {
        const std::string_view keyword = scanner_.next_word();
        std::int64_t number = 0;
        if (parse_integer(keyword, number)) return scanner_.give_back(keyword);
        std::string_view rest = keyword;
        const auto take = [&](std::string_view letters) {
            const bool found = rest.starts_with(letters);
            if (found) rest.remove_prefix(letters.size());
            return found;
        };
        if (take("ST")) surplus_count_ += 2;
        if (take("C")) surplus_count_ += 4;
        if (take("N")) surplus_count_ += 3;
        is_homogeneous_ = take("4");
        const bool states_dimension = take("n");
        if (lower_case(rest.substr(0, 3)) != "off" ||
            (rest.size() > 3 && !parse_integer(rest.substr(3), number)))
            scanner_.fail_expecting("OFF, COFF, NOFF or the like", keyword, ErrorCode::WrongFormat);
        scanner_.give_back(rest.substr(3));
        if (states_dimension) require_three_dimensions();
        require_text();
    }

    void require_three_dimensions() {
        const std::size_t dimension = scanner_.next_count("the number of dimensions");
        if (dimension != 3 || is_homogeneous_)
            scanner_.fail(ErrorCode::WrongFormat, "vertices have " + std::to_string(dimension) +
                                                      (is_homogeneous_ ? " + 1" : "") +
                                                      " coordinates; only those of three are read");
    }

    void require_text() {
        if (scanner_.at_end_of_line()) return;
        const std::string_view word = scanner_.next_word();
        if (lower_case(word) == "binary")
            scanner_.fail(ErrorCode::WrongFormat, "binary OFF is not read; save the mesh as text");
        scanner_.give_back(word);
    }

    /// The number of edges is often missing; it may also have a line of its own, because no vertex consists
    /// of a single number.
    void skip_edge_count() {
        if (!scanner_.at_end_of_line()) {
            scanner_.next_count("the number of edges");
            return;
        }
        LineScanner ahead(source_, scanner_.offset(), scanner_.line_number() + 1);
        if (!ahead.next_line()) return;
        ahead.next_word();
        if (ahead.at_end_of_line()) scanner_.next_count("the number of edges");
    }

    void begin_body(std::size_t element_count) {
        const std::size_t line_count = scanner_.count_lines_left();
        one_line_each_ = line_count == element_count;
        if (one_line_each_)
            scanner_.read_within_lines();
        else
            scanner_.read_across_lines(", where numbers are read across lines, as " +
                                       std::to_string(line_count) +
                                       " lines follow the header, but it declares " +
                                       std::to_string(element_count) + " vertices and faces");
    }

    void begin_element(const std::string& what) {
        if (one_line_each_ || scanner_.at_end_of_line()) scanner_.require_line(what);
    }

    void read_vertex(const std::string& what) {
        begin_element(what);
        const Vec3d p = scanner_.next_position();
        const double divisor = is_homogeneous_ ? scanner_.next_coordinate() : 1;
        mesh_.vertices.emplace_back(p.x / divisor, p.y / divisor, p.z / divisor);
        if (!is_finite(Vec3f(mesh_.vertices.back())))
            scanner_.fail(ErrorCode::InvalidMesh, "the vertex is not finite as floats");
        for (std::size_t i = 0; !one_line_each_ && i < surplus_count_; ++i) scanner_.skip_number();
    }

    /// Numbers may be wrapped over lines, but the rest of a face's line is its colour.
    void read_face(const std::string& what) {
        begin_element(what);
        const std::size_t corner_count = scanner_.next_count("the number of the face's corners");
        for (std::size_t corner = 0; corner < corner_count; ++corner)
            mesh_.corners.push_back(scanner_.next_vertex_index(mesh_.vertices.size()));
        mesh_.corner_counts.push_back(static_cast<std::uint32_t>(corner_count));
        scanner_.skip_rest_of_line();
    }

    const MeshSource& source_;
    LineScanner scanner_;
    PolygonMesh mesh_;
    bool is_homogeneous_ = false;   // a fourth coordinate divides the others
    std::size_t surplus_count_ = 0; // numbers of a vertex after its position
    bool one_line_each_ = false;
};

} // namespace

PolygonMesh read_off(const MeshSource& source) {
    return OffReader(source).read();
}

} // namespace echinus
