#include "mesh_io/line_scanner.hpp"
#include "mesh_io/mesh_source.hpp"
#include "mesh_io/readers.hpp"

#include <algorithm>
#include <array>

// The format: "The StL Format" of 3D Systems, text and binary. Normals, colours and attributes are ignored.

namespace echinus {

namespace {

constexpr std::size_t kHeadSize = 80;
constexpr std::size_t kBytesBeforeFaces = kHeadSize + sizeof(std::uint32_t);
constexpr std::size_t kBytesPerFace = 50; // normal and three corners of three floats, and two bytes

void add_face(PolygonMesh& mesh, const std::array<Vec3d, 3>& corners) {
    for (const Vec3d& corner : corners) {
        mesh.corners.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
        mesh.vertices.push_back(corner);
    }
    mesh.corner_counts.push_back(3);
}

// ---- Bytes ----

std::uint64_t promised_face_count(const MeshSource& source) {
    return ByteReader(source, kHeadSize, ByteOrder::LittleEndian).next<std::uint32_t>();
}

std::uint64_t promised_size(const MeshSource& source) {
    return kBytesBeforeFaces + kBytesPerFace * promised_face_count(source);
}

/// Also recognises binary files that begin with the word solid and look like text.
bool has_size_of_binary(const MeshSource& source) {
    return source.bytes.size() >= kBytesBeforeFaces && source.bytes.size() == promised_size(source);
}

/// @param found  the rest of the sentence
[[noreturn]] void refuse_size(const MeshSource& source, const std::string& found) {
    source.fail(ErrorCode::Damaged, "the header of a binary STL declares " +
                                        std::to_string(promised_face_count(source)) + " faces in " +
                                        std::to_string(promised_size(source)) + " bytes, but " + found);
}

/// Some programs write bytes of their own after the faces, which are ignored, unless they may be faces: then
/// the number in the head is wrong, or another file was appended.
void require_harmless_tail(const MeshSource& source) {
    const MeshSource tail{source.name, source.bytes.substr(promised_size(source))};
    const std::size_t size = tail.bytes.size();
    if (size >= kBytesBeforeFaces && promised_size(tail) == size && promised_face_count(tail) > 0)
        refuse_size(source, "another binary STL follows; write each into a file of its own");
    const bool is_zero = tail.bytes.find_first_not_of('\0') == std::string_view::npos;
    if (size % kBytesPerFace == 0 ? !is_zero : promised_face_count(source) == 0)
        refuse_size(source, std::to_string(size) + " more follow, room for " +
                                std::to_string(size / kBytesPerFace) + " faces; write the file again");
}

PolygonMesh read_binary(const MeshSource& source) {
    if (source.bytes.size() < promised_size(source))
        refuse_size(source, "the file has " + std::to_string(source.bytes.size()));
    require_harmless_tail(source);
    ByteReader bytes(source, kBytesBeforeFaces, ByteOrder::LittleEndian);
    PolygonMesh mesh;
    for (std::uint64_t left = promised_face_count(source); left > 0; --left) {
        std::array<Vec3d, 3> corners;
        bytes.skip(3 * sizeof(float)); // the normal
        for (Vec3d& corner : corners)
            for (double* coordinate : {&corner.x, &corner.y, &corner.z}) *coordinate = bytes.next<float>();
        bytes.skip(2);
        if (!std::all_of(corners.begin(), corners.end(), is_finite<double>))
            source.fail(ErrorCode::InvalidMesh, "face " + std::to_string(mesh.corner_counts.size()) +
                                                    " has a coordinate that is not finite");
        add_face(mesh, corners);
    }
    return mesh;
}

// ---- Text ----

/// Words may be in lower, upper or mixed case; `end loop` is read as `endloop`, and `outerloop` as `outer
/// loop`.
class TextReader {
  public:
    explicit TextReader(const MeshSource& source) : scanner_(source) { scanner_.read_across_lines(); }

    PolygonMesh read() {
        while (scanner_.next_line()) {
            require("solid", take_keyword());
            scanner_.skip_rest_of_line(); // its name
            while (read_facet()) {
            }
        }
        return std::move(mesh_);
    }

  private:
    /// False at the end of the solid.
    bool read_facet() {
        const std::string keyword = next_keyword("'facet' or 'endsolid'");
        if (keyword == "endsolid") {
            scanner_.skip_rest_of_line(); // its name
            return false;
        }
        if (keyword != "facet") scanner_.fail_expecting("'facet' or 'endsolid'", keyword);
        require_keyword("outerloop");
        std::array<Vec3d, 3> corners;
        for (Vec3d& corner : corners) {
            require_keyword("vertex");
            corner = scanner_.next_position();
        }
        require_keyword("endloop");
        require_keyword("endfacet");
        add_face(mesh_, corners);
        return true;
    }

    void require(std::string_view expected, std::string_view found) const {
        if (found != expected) scanner_.fail_expecting(in_quotes(expected), found);
    }
    void require_keyword(std::string_view expected) { require(expected, next_keyword(in_quotes(expected))); }

    /// The next keyword of the line, on which all other words are normals and colours, or else the first word
    /// of the next line.
    std::string next_keyword(const std::string& expected) {
        constexpr std::array<std::string_view, 6> kKeywords{"facet",   "outerloop", "vertex",
                                                            "endloop", "endfacet",  "endsolid"};
        while (!scanner_.at_end_of_line())
            if (std::string word = take_keyword();
                std::find(kKeywords.begin(), kKeywords.end(), word) != kKeywords.end())
                return word;
        scanner_.require_line(expected);
        return take_keyword();
    }

    std::string take_keyword() {
        std::string word = lower_case(scanner_.next_word());
        if (word == "end" || word == "outer") word += lower_case(scanner_.next_word());
        return word;
    }

    LineScanner scanner_;
    PolygonMesh mesh_;
};

// ---- Text or bytes ----

/// Whether the bytes of the head, or of a shorter file, could be text.
bool has_head_of_text(std::string_view bytes) {
    const std::string_view head = bytes.substr(0, kBytesBeforeFaces);
    return std::none_of(head.begin(), head.end(),
                        [](char c) { return static_cast<unsigned char>(c) < ' ' && (c < '\t' || c > '\r'); });
}

/// Many programs also begin binary files with the word solid.
bool begins_as_text(const MeshSource& source) {
    std::string_view bytes = text_of(source);
    if (bytes.size() >= kBytesBeforeFaces && !has_head_of_text(bytes)) return false;
    bytes.remove_prefix(std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size()));
    return lower_case(bytes.substr(0, 5)) == "solid";
}

void require_head_of_binary(const MeshSource& source) {
    if (source.bytes.size() < kBytesBeforeFaces || has_head_of_text(source.bytes))
        source.fail(ErrorCode::WrongFormat,
                    "the file begins neither with 'solid', as a text STL does, nor with "
                    "the " +
                        std::to_string(kBytesBeforeFaces) + " bytes of a binary one");
}

} // namespace

void require_beginning_of_stl(const MeshSource& beginning) {
    if (begins_as_text(beginning)) return;
    require_head_of_binary(beginning);
    if (promised_face_count(beginning) == 0 && beginning.bytes.size() > kBytesBeforeFaces)
        refuse_size(beginning, "the file has more");
}

PolygonMesh read_stl(const MeshSource& source) {
    if (has_size_of_binary(source)) return read_binary(source);
    if (begins_as_text(source)) return TextReader(source).read();
    require_head_of_binary(source);
    return read_binary(source);
}

} // namespace echinus
