#include "mesh_io/line_scanner.hpp"
#include "mesh_io/readers.hpp"

#include <algorithm>
#include <array>
#include <limits>

// The format: Wavefront Technologies, "Advanced Visualizer", appendix B1, "Object Files". Reads vertices,
// faces and lines; ignores the other statements.

namespace echinus {

namespace {

constexpr std::array<std::string_view, 39> kOtherStatements{
    "vt",         "vn",        "vp",    "p",     "o",      "g",   "s",    "mg",   "mtllib",   "usemtl",
    "maplib",     "usemap",    "bevel", "lod",   "cstype", "deg", "bmat", "step", "curv",     "curv2",
    "surf",       "parm",      "trim",  "hole",  "scrv",   "sp",  "end",  "con",  "c_interp", "d_interp",
    "shadow_obj", "trace_obj", "ctech", "stech", "csh",    "cdc", "bzp",  "bsp",  "res"};

class ObjReader {
  public:
    explicit ObjReader(const MeshSource& source) : scanner_(source, LineScanner::Continuation::Backslash) {}

    PolygonMesh read() {
        while (scanner_.next_line()) read_statement();
        if (mesh_.vertices.size() > std::numeric_limits<std::uint32_t>::max())
            scanner_.fail(ErrorCode::InvalidMesh, "there are more than 2^32 vertices");
        require_largest_index();
        return std::move(mesh_);
    }

  private:
    void read_statement() {
        const std::string_view keyword = scanner_.next_word();
        if (keyword == "v")
            read_vertex();
        else if (keyword == "f" || keyword == "fo") // version 3 reads fo, of earlier versions, as f
            read_face();
        else if (keyword == "l")
            read_line();
        else if (keyword == "call")
            scanner_.fail(
                ErrorCode::WrongFormat,
                "'call' includes statements from another file, which is not read; insert them in its place");
        else if (std::find(kOtherStatements.begin(), kOtherStatements.end(), keyword) ==
                 kOtherStatements.end())
            scanner_.fail(ErrorCode::WrongFormat, in_quotes(keyword) + " is not a statement of an OBJ file");
        else
            require_nothing_swallowed(keyword);
    }

    /// A weight or a colour may follow.
    void read_vertex() {
        mesh_.vertices.push_back(scanner_.next_position());
        require_nothing_swallowed("v");
    }

    /// If a name ends with a backslash, as a Windows path may, the next statement would become part of it.
    void require_nothing_swallowed(std::string_view keyword) {
        constexpr std::array<std::string_view, 4> kRead{"v", "f", "fo", "l"};
        if (!scanner_.is_joined()) return;
        while (!scanner_.at_end_of_line())
            if (const auto word = scanner_.next_word();
                std::find(kRead.begin(), kRead.end(), word) != kRead.end())
                scanner_.fail(
                    ErrorCode::Damaged,
                    in_quotes(keyword) +
                        " continues on the next line, as the backslash at its end says, but there " +
                        in_quotes(word) + " follows; remove the backslash");
    }

    void read_face() {
        std::uint32_t corner_count = 0;
        for (; !scanner_.at_end_of_line(); ++corner_count)
            mesh_.corners.push_back(vertex_index(scanner_.next_word()));
        if (corner_count < 3)
            scanner_.fail(ErrorCode::WrongFormat,
                          "a face needs at least 3 vertices, not " + std::to_string(corner_count));
        mesh_.corner_counts.push_back(corner_count);
    }

    /// A line with k corners gives k - 1 polygons with two corners.
    void read_line() {
        for (std::uint32_t last = vertex_index(scanner_.next_word()); !scanner_.at_end_of_line();) {
            const std::uint32_t next = vertex_index(scanner_.next_word());
            mesh_.corners.insert(mesh_.corners.end(), {last, next});
            mesh_.corner_counts.push_back(2);
            last = next;
        }
    }

    /// The vertex index of a corner v, v/vt, v//vn or v/vt/vn, which counts from 1, or is negative and counts
    /// back from the latest vertex.
    std::uint32_t vertex_index(std::string_view corner) {
        const std::string_view digits = corner.substr(0, corner.find('/'));
        std::int64_t number = 0;
        if (!parse_integer(digits, number)) scanner_.fail_expecting("a vertex number", corner);
        const std::int64_t index =
            number < 0 ? static_cast<std::int64_t>(mesh_.vertices.size()) + number : number - 1;
        if (number == 0 || index < 0 || index > std::numeric_limits<std::uint32_t>::max())
            scanner_.fail(ErrorCode::InvalidMesh,
                          "there is no vertex " + std::to_string(number) + "; " +
                              (number < 0 ? "-1 is the latest of the " +
                                                std::to_string(mesh_.vertices.size()) + " before"
                                          : "they are numbered from 1"));
        if (index > largest_index_) {
            largest_index_ = index;
            line_of_largest_ = scanner_.line_number();
        }
        return static_cast<std::uint32_t>(index);
    }

    /// Called at the end, since a face may precede its vertices.
    void require_largest_index() const {
        if (largest_index_ >= static_cast<std::int64_t>(mesh_.vertices.size()))
            scanner_.fail_at(line_of_largest_, ErrorCode::InvalidMesh,
                             "the statement refers to vertex " + std::to_string(largest_index_ + 1) +
                                 ", but the file has only " + std::to_string(mesh_.vertices.size()) +
                                 " vertices");
    }

    LineScanner scanner_;
    PolygonMesh mesh_;
    std::int64_t largest_index_ = -1;
    std::size_t line_of_largest_ = 0;
};

} // namespace

PolygonMesh read_obj(const MeshSource& source) {
    return ObjReader(source).read();
}

} // namespace echinus
