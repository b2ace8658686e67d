#include "files/read_file.hpp"
#include "mesh_io/readers.hpp"
#include "tetrahedra/mend.hpp"

#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace echinus {

namespace {

constexpr std::string_view kSeparators = " \t\r";

std::vector<std::string_view> words_of(std::string_view line) {
    std::vector<std::string_view> words;
    while (true) {
        line.remove_prefix(std::min(line.find_first_not_of(kSeparators), line.size()));
        if (line.empty()) return words;
        words.push_back(line.substr(0, line.find_first_of(kSeparators)));
        line.remove_prefix(words.back().size());
    }
}

} // namespace

Vec3d NumberSource::position(NumberType type) {
    const double x = coordinate(type);
    const double y = coordinate(type);
    return {x, y, coordinate(type)};
}

std::size_t NumberSource::count(NumberType type, const char* what) {
    const std::int64_t value = integer(type, what);
    if (value < 0 || value >= std::numeric_limits<std::uint32_t>::max())
        fail(ErrorCode::Damaged, std::string(what) + " cannot be " + std::to_string(value));
    return static_cast<std::size_t>(value);
}

std::vector<std::string_view> NumberSource::require_line(const std::string& what) {
    std::vector<std::string_view> words = next_line();
    if (words.empty()) fail(ErrorCode::Damaged, "the file ends where " + what + " was expected");
    return words;
}

// ---- Numbers as words ----

std::vector<std::string_view> TextNumbers::next_line() {
    std::vector<std::string_view> words;
    if (!scanner_.next_line()) return words;
    while (!scanner_.at_end_of_line()) words.push_back(scanner_.next_word());
    return words;
}

std::int64_t TextNumbers::integer(NumberType, const char* what) {
    return scanner_.next_integer(what);
}

double TextNumbers::coordinate(NumberType) {
    return scanner_.next_coordinate();
}

void TextNumbers::skip(std::size_t count, std::size_t) {
    for (; count > 0; --count) scanner_.skip_number();
}

void TextNumbers::skip_to_line(const std::string& word) {
    do scanner_.require_line(word);
    while (scanner_.next_word() != word);
}

// ---- Numbers as bytes ----

std::vector<std::string_view> BinaryNumbers::next_line() {
    constexpr std::size_t kLongest = 1024;
    while (bytes_.bytes_left() > 0) {
        const std::string_view rest = source_.bytes.substr(bytes_.offset());
        const std::string_view line = rest.substr(0, rest.find('\n'));
        if (line.size() > kLongest) fail(ErrorCode::Damaged, "a line of text was expected");
        bytes_.skip(std::min(line.size() + 1, rest.size()));
        std::vector<std::string_view> words = words_of(line);
        if (!words.empty()) return words;
    }
    return {};
}

std::int64_t BinaryNumbers::integer(NumberType type, const char*) {
    return type == NumberType::Int32 ? bytes_.next<std::int32_t>() : bytes_.next<std::int64_t>();
}

double BinaryNumbers::coordinate(NumberType type) {
    const double value = type == NumberType::Float32 ? double{bytes_.next<float>()} : bytes_.next<double>();
    if (!std::isfinite(static_cast<float>(value)))
        fail(ErrorCode::InvalidMesh, "a coordinate is not finite as a float");
    return value;
}

void BinaryNumbers::skip(std::size_t count, std::size_t size) {
    bytes_.skip(count * size); // below 2^35
}

void BinaryNumbers::skip_to_line(const std::string& word) {
    const std::size_t found = source_.bytes.find("\n" + word, bytes_.offset() - 1);
    if (found == std::string_view::npos)
        fail(ErrorCode::Damaged, "the line " + in_quotes(word) + " is missing after it");
    bytes_.skip(found - (bytes_.offset() - 1));
    next_line();
}

namespace {

MeshSource source_of(const std::filesystem::path& path, std::span<const std::byte> bytes) {
    return {path.string(), {reinterpret_cast<const char*>(bytes.data()), bytes.size()}};
}

void require_content(const MeshSource& source) {
    if (source.bytes.empty()) source.fail(ErrorCode::Damaged, "the file is empty");
}

TetrahedraFile read_pair(std::filesystem::path path) {
    const std::filesystem::path nodes_path = path.replace_extension(".node");
    const std::filesystem::path elements_path = path.replace_extension(".ele");
    const std::vector<std::byte> node_bytes = read_file(nodes_path), element_bytes = read_file(elements_path);
    const MeshSource nodes = source_of(nodes_path, node_bytes);
    const MeshSource elements = source_of(elements_path, element_bytes);
    require_content(nodes);
    require_content(elements);
    return finish_tetrahedra(read_tetgen(nodes, elements), elements);
}

} // namespace

TetrahedraFile finish_tetrahedra(TetrahedraInFile read, const MeshSource& source) {
    if (read.tetrahedra.empty()) source.fail(ErrorCode::InvalidMesh, "the file has no tetrahedra");
    TetrahedralMesh mesh = local_body(read.vertices, std::move(read.tetrahedra));
    TetrahedraFile file;
    file.turned_tetrahedra = turn_negative(mesh);
    try {
        require_valid_tetrahedra(mesh);
    } catch (const Error& error) {
        source.fail(error.code(), error.what());
    }
    file.dropped_vertices = drop_unused_vertices(mesh);
    file.mesh = std::move(mesh);
    return file;
}

TetrahedraFile read_tetrahedra(const MeshSource& source) {
    require_content(source);
    return finish_tetrahedra(lower_case_ending(source.name) == ".msh" ? read_msh(source) : read_vtk(source),
                             source);
}

TetrahedraFile read_tetrahedra(const std::filesystem::path& path) {
    const std::string ending = lower_case_ending(path);
    if (ending == ".node" || ending == ".ele") return read_pair(path);
    if (ending != ".msh" && ending != ".vtk")
        throw Error(ErrorCode::WrongFormat,
                    path.string() +
                        ": tetrahedra are read from files that end in .msh, .vtk, .node or .ele, not in " +
                        in_quotes(ending));
    const std::vector<std::byte> bytes = read_file(path, [&](std::span<const std::byte> beginning) {
        // Both kinds begin with a line of text.
        LineScanner(source_of(path, beginning)).next_line();
    });
    return read_tetrahedra(source_of(path, bytes));
}

} // namespace echinus
