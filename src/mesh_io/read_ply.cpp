#include "mesh_io/line_scanner.hpp"
#include "mesh_io/mesh_source.hpp"
#include "mesh_io/readers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace echinus {

// The format: Greg Turk, "The PLY Polygon File Format" (1994). Reads the position of each `vertex`, the list
// of corners of each `face`, and the strips of triangles of `tristrips`; ignores other properties and
// elements.

namespace {

enum class PlyType : std::uint8_t { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float32, Float64 };

enum class PlyFormat : std::uint8_t { Text, LittleEndian, BigEndian };

struct PlyProperty {
    std::string name;
    PlyType type{};
    std::optional<PlyType> count_type; ///< of a list
};

struct PlyElement {
    std::string name;
    std::size_t count = 0;
    std::vector<PlyProperty> properties;
};

struct PlyHeader {
    PlyFormat format{};
    std::vector<PlyElement> elements;

    /// The number of elements with this name in the file.
    std::size_t count_of(const std::string& name) const;
    std::size_t element_count() const; ///< of all names
};

/// Accepts both the names of the first description and later ones.
PlyType type_named(std::string_view word, const LineScanner& scanner) {
    using enum PlyType;
    static constexpr std::array<std::pair<std::string_view, PlyType>, 16> kTypes{{{"char", Int8},
                                                                                  {"uchar", Uint8},
                                                                                  {"short", Int16},
                                                                                  {"ushort", Uint16},
                                                                                  {"int", Int32},
                                                                                  {"uint", Uint32},
                                                                                  {"float", Float32},
                                                                                  {"double", Float64},
                                                                                  {"int8", Int8},
                                                                                  {"uint8", Uint8},
                                                                                  {"int16", Int16},
                                                                                  {"uint16", Uint16},
                                                                                  {"int32", Int32},
                                                                                  {"uint32", Uint32},
                                                                                  {"float32", Float32},
                                                                                  {"float64", Float64}}};
    const auto* const found =
        std::find_if(kTypes.begin(), kTypes.end(), [&](const auto& type) { return type.first == word; });
    if (found == kTypes.end())
        scanner.fail(ErrorCode::Damaged, in_quotes(word) + " is not a type of a property");
    return found->second;
}

/// The first word of the next line that is not a comment.
std::string_view next_keyword(LineScanner& scanner, const char* expected) {
    for (;;) {
        scanner.require_line(expected);
        const std::string_view keyword = scanner.next_word();
        if (keyword != "comment" && keyword != "obj_info") return keyword;
    }
}

PlyFormat read_format(LineScanner& scanner) {
    const std::string_view keyword = next_keyword(scanner, "the line 'format'");
    const std::string_view word = scanner.next_word();
    const std::string_view version = scanner.next_word();
    if (keyword == "format" && version == "1.0") {
        if (word == "ascii") return PlyFormat::Text;
        if (word == "binary_little_endian") return PlyFormat::LittleEndian;
        if (word == "binary_big_endian") return PlyFormat::BigEndian;
    }
    scanner.fail(
        ErrorCode::WrongFormat,
        "'format' with ascii, binary_little_endian or binary_big_endian and version 1.0 was expected");
}

PlyElement read_element(LineScanner& scanner) {
    PlyElement element;
    element.name = scanner.next_word();
    const std::int64_t count = scanner.next_integer("the number of elements");
    if (count < 0 || count > std::int64_t{0xFFFFFFFF})
        scanner.fail(ErrorCode::Damaged, "there cannot be " + std::to_string(count) + " of them");
    element.count = static_cast<std::size_t>(count);
    return element;
}

PlyProperty read_property(LineScanner& scanner) {
    PlyProperty property;
    std::string_view word = scanner.next_word();
    if (word == "list") {
        property.count_type = type_named(scanner.next_word(), scanner);
        word = scanner.next_word();
    }
    property.type = type_named(word, scanner);
    property.name = scanner.next_word();
    if (property.name.empty()) scanner.fail(ErrorCode::Damaged, "the property has no name");
    if (property.count_type && *property.count_type >= PlyType::Float32)
        scanner.fail(ErrorCode::Damaged, "the length of a list cannot be a floating-point number");
    return property;
}

std::size_t PlyHeader::count_of(const std::string& name) const {
    std::size_t count = 0;
    for (const PlyElement& element : elements)
        if (element.name == name) count += element.count;
    return count;
}

std::size_t PlyHeader::element_count() const {
    std::size_t count = 0;
    for (const PlyElement& element : elements) count += element.count;
    return count;
}

/// Reads up to and including the line end_header.
/// @throws Error WrongFormat or Damaged
PlyHeader read_ply_header(LineScanner& scanner) {
    scanner.require_line("the word ply");
    if (scanner.next_word() != "ply") scanner.fail(ErrorCode::WrongFormat, "the word ply was expected");
    PlyHeader header;
    header.format = read_format(scanner);
    for (;;) {
        const std::string_view keyword = next_keyword(scanner, "'end_header'");
        if (keyword == "end_header") return header;
        if (keyword == "element")
            header.elements.push_back(read_element(scanner));
        else if (keyword == "property" && !header.elements.empty())
            header.elements.back().properties.push_back(read_property(scanner));
        else
            scanner.fail(ErrorCode::Damaged,
                         in_quotes(keyword) + " has no meaning here in the header of a PLY file");
    }
}

/// The elements as text. Each has a line, on which further numbers may follow, as some programs write them;
/// if the number of lines differs from the number of elements, their numbers are read across lines.
class TextBody {
  public:
    TextBody(LineScanner& scanner, std::size_t element_count) : scanner_(scanner) {
        const std::size_t line_count = scanner.count_lines_left();
        one_line_each_ = line_count == element_count;
        if (!one_line_each_)
            scanner.read_across_lines(
                ", where numbers are read across lines, as " + std::to_string(line_count) +
                " lines follow the header, but it declares " + std::to_string(element_count) + " elements");
    }

    void begin_element(const std::string& what) {
        if (one_line_each_ || scanner_.at_end_of_line()) scanner_.require_line(what);
    }
    double coordinate(PlyType) { return scanner_.next_coordinate(); }
    std::int64_t integer(PlyType) { return scanner_.next_integer("an integer"); }
    void skip(PlyType) { scanner_.skip_number(); }
    bool at_end() { return (one_line_each_ || scanner_.at_end_of_line()) && !scanner_.next_line(); }
    [[noreturn]] void fail(ErrorCode code, const std::string& what) const { scanner_.fail(code, what); }

  private:
    LineScanner& scanner_;
    bool one_line_each_ = false;
};

/// The elements as bytes without gaps.
class BinaryBody {
  public:
    BinaryBody(const MeshSource& source, ByteReader bytes) : source_(source), bytes_(bytes) {}

    void begin_element(const std::string&) {}
    double coordinate(PlyType type) {
        const double value = number(type);
        if (!std::isfinite(static_cast<float>(value)))
            fail(ErrorCode::InvalidMesh, "a coordinate is not finite as a float");
        return value;
    }
    std::int64_t integer(PlyType type) {
        const double value = number(type);
        const auto rounded = static_cast<std::int64_t>(std::abs(value) < 1e15 ? value : -1);
        if (static_cast<double>(rounded) != value) fail(ErrorCode::Damaged, "an integer was expected");
        return rounded;
    }
    void skip(PlyType type) { number(type); }
    /// A line break may follow, or padding of the last block.
    bool at_end() const {
        constexpr std::string_view kFilling{" \r\n\0\x1a", 5};
        return source_.bytes.substr(bytes_.offset()).find_first_not_of(kFilling) == std::string_view::npos;
    }
    [[noreturn]] void fail(ErrorCode code, const std::string& what) const {
        source_.fail(code, what + ", before byte " + std::to_string(bytes_.offset()));
    }

  private:
    /// Every type of number fits into a double.
    double number(PlyType type) {
        switch (type) {
        case PlyType::Int8:
            return bytes_.next<std::int8_t>();
        case PlyType::Uint8:
            return bytes_.next<std::uint8_t>();
        case PlyType::Int16:
            return bytes_.next<std::int16_t>();
        case PlyType::Uint16:
            return bytes_.next<std::uint16_t>();
        case PlyType::Int32:
            return bytes_.next<std::int32_t>();
        case PlyType::Uint32:
            return bytes_.next<std::uint32_t>();
        case PlyType::Float32:
            return double{bytes_.next<float>()};
        case PlyType::Float64:
            break;
        }
        return bytes_.next<double>();
    }

    const MeshSource& source_;
    ByteReader bytes_;
};

template <typename Body>
std::size_t list_length(Body& body, const PlyProperty& list) {
    const std::int64_t length = body.integer(*list.count_type);
    if (length < 0) body.fail(ErrorCode::Damaged, "a list has a negative length");
    return static_cast<std::size_t>(length);
}

template <typename Body>
void skip_property(Body& body, const PlyProperty& property) {
    const std::size_t count = property.count_type ? list_length(body, property) : 1;
    for (std::size_t i = 0; i < count; ++i) body.skip(property.type);
}

template <typename Body>
void read_vertex(Body& body, const PlyElement& element, PolygonMesh& mesh) {
    Vec3d p;
    for (const PlyProperty& property : element.properties) {
        double* const coordinate = property.name == "x"   ? &p.x
                                   : property.name == "y" ? &p.y
                                   : property.name == "z" ? &p.z
                                                          : nullptr;
        if (coordinate != nullptr && !property.count_type)
            *coordinate = body.coordinate(property.type);
        else
            skip_property(body, property);
    }
    mesh.vertices.emplace_back(p);
}

/// The corners of a face, or of strips of triangles.
bool is_list_of_corners(const PlyProperty& property) {
    return property.count_type && (property.name == "vertex_indices" || property.name == "vertex_index");
}

/// The index of a corner of the next face.
template <typename Body>
std::uint32_t checked_corner(const Body& body, std::int64_t index, std::size_t vertex_count,
                             const PolygonMesh& mesh) {
    if (index < 0 || static_cast<std::uint64_t>(index) >= vertex_count)
        body.fail(ErrorCode::InvalidMesh, "face " + std::to_string(mesh.corner_counts.size()) +
                                              " refers to vertex " + std::to_string(index) +
                                              ", but there are " + std::to_string(vertex_count) +
                                              " vertices, numbered from 0");
    return static_cast<std::uint32_t>(index);
}

template <typename Body>
void read_corners(Body& body, const PlyProperty& list, std::size_t vertex_count, PolygonMesh& mesh) {
    const std::size_t corner_count = list_length(body, list);
    for (std::size_t corner = 0; corner < corner_count; ++corner)
        mesh.corners.push_back(checked_corner(body, body.integer(list.type), vertex_count, mesh));
    mesh.corner_counts.push_back(static_cast<std::uint32_t>(corner_count));
}

/// Strips of triangles, with -1 between them: each corner after the second of a strip makes a triangle with
/// the two before it, and the orientation of every second triangle is reversed. Triangles that have a corner
/// twice only connect parts of a strip.
template <typename Body>
void read_strips(Body& body, const PlyProperty& list, std::size_t vertex_count, PolygonMesh& mesh) {
    std::array<std::uint32_t, 2> last{};
    std::size_t corner_count = 0; // in the present strip
    for (std::size_t left = list_length(body, list); left > 0; --left) {
        const std::int64_t index = body.integer(list.type);
        if (index == -1) {
            corner_count = 0;
            continue;
        }
        const std::uint32_t corner = checked_corner(body, index, vertex_count, mesh);
        if (++corner_count > 2 && last[0] != last[1] && last[0] != corner && last[1] != corner) {
            const bool is_turned = corner_count % 2 == 0;
            mesh.corners.insert(mesh.corners.end(),
                                {last[is_turned ? 1 : 0], last[is_turned ? 0 : 1], corner});
            mesh.corner_counts.push_back(3);
        }
        last = {last[1], corner};
    }
}

template <typename Body>
void read_element(Body& body, const PlyElement& element, std::size_t vertex_count, PolygonMesh& mesh) {
    if (element.name == "vertex") return read_vertex(body, element, mesh);
    for (const PlyProperty& property : element.properties)
        if (element.name == "face" && is_list_of_corners(property))
            read_corners(body, property, vertex_count, mesh);
        else if (element.name == "tristrips" && is_list_of_corners(property))
            read_strips(body, property, vertex_count, mesh);
        else
            skip_property(body, property);
}

template <typename Body>
PolygonMesh read_body(Body&& body, const PlyHeader& header) {
    PolygonMesh mesh;
    const std::size_t vertex_count = header.count_of("vertex");
    for (const PlyElement& element : header.elements)
        for (std::size_t i = 0; i < element.count; ++i) {
            body.begin_element(element.name + " " + std::to_string(i + 1) + " of " +
                               std::to_string(element.count));
            read_element(body, element, vertex_count, mesh);
        }
    if (!body.at_end())
        body.fail(ErrorCode::Damaged, "the file continues after the elements that its header declares");
    return mesh;
}

void require_coordinates(const PlyElement& vertices, const MeshSource& source) {
    for (const char* axis : {"x", "y", "z"})
        if (std::none_of(
                vertices.properties.begin(), vertices.properties.end(),
                [&](const PlyProperty& property) { return property.name == axis && !property.count_type; }))
            source.fail(ErrorCode::Damaged, std::string("the vertices have no property ") + axis);
}

/// Elements without properties have no bytes, so their number could be arbitrary; positions need all three
/// axes.
void require_sense(const PlyHeader& header, const MeshSource& source) {
    for (const PlyElement& element : header.elements) {
        if (element.properties.empty() && element.count > 0)
            source.fail(ErrorCode::Damaged, "the element " + in_quotes(element.name) + " has no properties");
        if (element.name == "vertex") require_coordinates(element, source);
        if ((element.name == "face" || element.name == "tristrips") && element.count > 0 &&
            std::none_of(element.properties.begin(), element.properties.end(), is_list_of_corners))
            source.fail(ErrorCode::Damaged, "the element " + in_quotes(element.name) +
                                                " has no list vertex_indices or vertex_index");
    }
}

/// The offset at which the bytes begin. A byte after the header may look like the second half of a line
/// break, but does not belong to it if the other lines end with \r alone.
std::size_t end_of_header(const LineScanner& scanner, std::string_view bytes) {
    const std::size_t first_end = bytes.find_first_of("\r\n");
    const bool lines_end_with_cr = bytes[first_end] == '\r' && bytes[first_end + 1] != '\n';
    const bool took_pair = bytes.substr(0, scanner.offset()).ends_with("\r\n");
    return scanner.offset() - (lines_end_with_cr && took_pair ? 1 : 0);
}

} // namespace

PolygonMesh read_ply(const MeshSource& source) {
    LineScanner scanner(source);
    const PlyHeader header = read_ply_header(scanner);
    require_sense(header, source);
    if (header.format == PlyFormat::Text) return read_body(TextBody(scanner, header.element_count()), header);
    const ByteOrder order =
        header.format == PlyFormat::LittleEndian ? ByteOrder::LittleEndian : ByteOrder::BigEndian;
    return read_body(BinaryBody(source, ByteReader(source, end_of_header(scanner, source.bytes), order)),
                     header);
}

} // namespace echinus
