#include "mesh_io/ply_header.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace echinus {

namespace {

/// Both the names of the first description and those that came later.
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
        scanner.fail(ErrorCode::Damaged, in_quotes(word) + " is no type of a property");
    return found->second;
}

/// The first word of the next line that is no comment.
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

} // namespace

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
                         in_quotes(keyword) + " has no meaning here in the head of a PLY file");
    }
}

} // namespace echinus
