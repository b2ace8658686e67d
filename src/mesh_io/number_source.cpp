#include "mesh_io/number_source.hpp"

#include <cmath>
#include <limits>

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

// ---- In words ----

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

// ---- In bytes ----

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

} // namespace echinus
