#include "mesh_io/byte_reader.hpp"
#include "mesh_io/line_scanner.hpp"
#include "mesh_io/ply_header.hpp"
#include "mesh_io/readers.hpp"

#include <array>
#include <limits>

// The format: Greg Turk, "The PLY Polygon File Format" (1994). Reads the position of each `vertex` and the
// list of corners of each `face`; ignores other properties and elements.

namespace echinus {

namespace {

/// The elements as text: one line each.
class TextBody {
  public:
    explicit TextBody(LineScanner& scanner) : scanner_(scanner) {}

    void begin_element(const std::string& what) { scanner_.require_line(what); }
    float coordinate(PlyType) { return scanner_.next_coordinate(); }
    std::int64_t integer(PlyType) { return scanner_.next_integer("an integer"); }
    void skip(PlyType) {
        float ignored = 0;
        const std::string_view word = scanner_.next_word();
        if (!parse_float(word, ignored)) scanner_.fail_expecting("a number", word);
    }
    void end_element() {
        if (!scanner_.at_end_of_line())
            fail(ErrorCode::Damaged, "the line goes on with " + in_quotes(scanner_.next_word()));
    }
    bool at_end() { return !scanner_.next_line(); }
    [[noreturn]] void fail(ErrorCode code, const std::string& what) const { scanner_.fail(code, what); }

  private:
    LineScanner& scanner_;
};

/// The elements as bytes without gaps.
class BinaryBody {
  public:
    BinaryBody(const MeshSource& source, ByteReader bytes) : source_(source), bytes_(bytes) {}

    void begin_element(const std::string&) {}
    float coordinate(PlyType type) {
        const double value = number(type);
        const bool finite = std::abs(value) <= std::numeric_limits<float>::max();
        if (!finite) fail(ErrorCode::InvalidMesh, "a coordinate is not finite as a float");
        return static_cast<float>(value);
    }
    std::int64_t integer(PlyType type) {
        const double value = number(type);
        const auto rounded = static_cast<std::int64_t>(std::abs(value) < 1e15 ? value : -1);
        if (static_cast<double>(rounded) != value) fail(ErrorCode::Damaged, "an integer was expected");
        return rounded;
    }
    void skip(PlyType type) { number(type); }
    void end_element() {}
    bool at_end() const {
        const auto rest = source_.bytes.substr(bytes_.offset());
        return rest.find_first_not_of(" \r\n") == std::string_view::npos;
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
    Vec3f p;
    for (const PlyProperty& property : element.properties) {
        float* const coordinate = property.name == "x"   ? &p.x
                                  : property.name == "y" ? &p.y
                                  : property.name == "z" ? &p.z
                                                         : nullptr;
        if (coordinate != nullptr && !property.count_type)
            *coordinate = body.coordinate(property.type);
        else
            skip_property(body, property);
    }
    mesh.vertices.push_back(p);
}

template <typename Body>
void read_face(Body& body, const PlyElement& element, std::size_t vertex_count, PolygonMesh& mesh) {
    for (const PlyProperty& property : element.properties) {
        if (!property.count_type || (property.name != "vertex_indices" && property.name != "vertex_index")) {
            skip_property(body, property);
            continue;
        }
        const std::size_t corner_count = list_length(body, property);
        for (std::size_t corner = 0; corner < corner_count; ++corner) {
            const std::int64_t index = body.integer(property.type);
            if (index < 0 || static_cast<std::uint64_t>(index) >= vertex_count)
                body.fail(ErrorCode::InvalidMesh, "face " + std::to_string(mesh.corner_counts.size()) +
                                                      " refers to vertex " + std::to_string(index) +
                                                      ", but there are " + std::to_string(vertex_count) +
                                                      " vertices, numbered from 0");
            mesh.corners.push_back(static_cast<std::uint32_t>(index));
        }
        mesh.corner_counts.push_back(static_cast<std::uint32_t>(corner_count));
    }
}

template <typename Body>
PolygonMesh read_body(Body&& body, const PlyHeader& header, const MeshSource& source) {
    PolygonMesh mesh;
    const std::size_t vertex_count = header.count_of("vertex");
    for (const PlyElement& element : header.elements)
        for (std::size_t i = 0; i < element.count; ++i) {
            body.begin_element(element.name + " " + std::to_string(i + 1) + " of " +
                               std::to_string(element.count));
            if (element.name == "vertex")
                read_vertex(body, element, mesh);
            else if (element.name == "face")
                read_face(body, element, vertex_count, mesh);
            else
                for (const PlyProperty& property : element.properties) skip_property(body, property);
            body.end_element();
        }
    if (!body.at_end())
        source.fail(ErrorCode::Damaged, "the file goes on after the elements that its head promises");
    return mesh;
}

/// Elements without properties have no bytes, and their number could be any; positions need all three axes.
void require_sense(const PlyHeader& header, const MeshSource& source) {
    for (const PlyElement& element : header.elements) {
        if (element.properties.empty() && element.count > 0)
            source.fail(ErrorCode::Damaged, "the element " + in_quotes(element.name) + " has no properties");
        if (element.name != "vertex") continue;
        for (const char* axis : {"x", "y", "z"})
            if (std::none_of(element.properties.begin(), element.properties.end(),
                             [&](const PlyProperty& property) {
                                 return property.name == axis && !property.count_type;
                             }))
                source.fail(ErrorCode::Damaged, std::string("the vertices have no property ") + axis);
    }
}

} // namespace

PolygonMesh read_ply(const MeshSource& source) {
    LineScanner scanner(source);
    const PlyHeader header = read_ply_header(scanner);
    require_sense(header, source);
    if (header.format == PlyFormat::Text) return read_body(TextBody(scanner), header, source);
    const ByteOrder order =
        header.format == PlyFormat::LittleEndian ? ByteOrder::LittleEndian : ByteOrder::BigEndian;
    return read_body(BinaryBody(source, ByteReader(source, scanner.offset(), order)), header, source);
}

} // namespace echinus
