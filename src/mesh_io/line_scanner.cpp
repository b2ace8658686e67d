#include "mesh_io/line_scanner.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <string>

namespace echinus {

namespace {

constexpr std::string_view kBlanks = " \t\v\f\r\n\\"; // the last three inside a continued line only

std::string_view without_plus(std::string_view word) {
    if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
    return word;
}

#ifdef __cpp_lib_to_chars

template <typename Number>
std::from_chars_result read_number(std::string_view word, Number& value) {
    return std::from_chars(word.data(), word.data() + word.size(), value);
}

#else // libc++ before 20, as Emscripten has it: strtof and strtod of musl round correctly and know no locale

/// Would std::from_chars begin to read here? Beyond it, strtof reads blanks, a plus and hexadecimal numbers.
bool begins_like_a_number(std::string_view word) {
    if (!word.empty() && word[0] == '-') word.remove_prefix(1);
    const bool is_hexadecimal = word.size() > 1 && (word[1] == 'x' || word[1] == 'X');
    return !word.empty() && !is_hexadecimal && word[0] != '+' &&
           kBlanks.find(word[0]) == std::string_view::npos;
}

template <typename Number>
std::from_chars_result read_number(std::string_view word, Number& value) {
    if constexpr (std::is_integral_v<Number>) {
        return std::from_chars(word.data(), word.data() + word.size(), value);
    } else {
        if (!begins_like_a_number(word)) return {word.data(), std::errc::invalid_argument};
        const std::string text(word); // with a zero at its end
        char* end = nullptr;
        errno = 0;
        if constexpr (std::is_same_v<Number, float>)
            value = std::strtof(text.c_str(), &end);
        else
            value = std::strtod(text.c_str(), &end);
        const bool is_lost = value == 0 || std::isinf(value); // not just rounded to a small number
        return {word.data() + (end - text.c_str()),
                errno == ERANGE && is_lost ? std::errc::result_out_of_range : std::errc{}};
    }
}

#endif

template <typename Number>
std::errc parse_whole(std::string_view word, Number& value) {
    word = without_plus(word);
    const auto [end, error] = read_number(word, value);
    return error == std::errc{} && end != word.data() + word.size() ? std::errc::invalid_argument : error;
}

} // namespace

bool parse_float(std::string_view word, float& value) {
    const std::errc error = parse_whole(word, value);
    if (error != std::errc::result_out_of_range) return error == std::errc{};
    // Too large and too small look the same so far; as a double, 1e-50 is an ordinary number.
    double wide = 0;
    if (parse_whole(word, wide) != std::errc{}) wide = HUGE_VAL;
    value = std::abs(wide) < 1 ? static_cast<float>(wide) : HUGE_VALF;
    return true;
}

void LineScanner::take_line() {
    const std::string_view text = source_.bytes;
    line_number_ = next_number_;
    const std::size_t begin = next_;
    for (bool continued = true; continued;) {
        const std::size_t end = std::min(text.find_first_of("\r\n", next_), text.size());
        continued = end > begin && end < text.size() && text[end - 1] == '\\';
        rest_ = text.substr(begin, end - begin);
        const bool is_pair = text.substr(end, 2) == "\r\n";
        next_ = std::min(end + (is_pair ? 2 : 1), text.size());
        ++next_number_;
    }
}

void LineScanner::require_text() const {
    const auto is_control = [](char c) {
        return static_cast<unsigned char>(c) < ' ' && kBlanks.find(c) == std::string_view::npos;
    };
    if (std::any_of(rest_.begin(), rest_.end(), is_control))
        fail(ErrorCode::WrongFormat, "the line has control characters, so the file is no text");
}

bool LineScanner::next_line() {
    while (next_ < source_.bytes.size()) {
        take_line();
        require_text();
        rest_ = rest_.substr(0, rest_.find('#'));
        if (!at_end_of_line()) return true;
    }
    return false;
}

void LineScanner::require_line(const std::string& what) {
    if (!next_line()) source_.fail(ErrorCode::Damaged, "the file ends where " + what + " was expected");
}

bool LineScanner::at_end_of_line() {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(kBlanks), rest_.size()));
    return rest_.empty();
}

std::string_view LineScanner::next_word() {
    if (at_end_of_line()) return {};
    const std::string_view word = rest_.substr(0, rest_.find_first_of(kBlanks));
    rest_.remove_prefix(word.size());
    return word;
}

float LineScanner::next_coordinate() {
    const std::string_view word = next_word();
    float value = 0;
    if (!parse_float(word, value)) fail_expecting("a coordinate", word);
    if (!std::isfinite(value))
        fail(ErrorCode::InvalidMesh, "the coordinate " + in_quotes(word) + " is not finite as a float");
    return value;
}

std::int64_t LineScanner::next_integer(const std::string& what) {
    const std::string_view word = next_word();
    std::int64_t value = 0;
    if (parse_whole(word, value) != std::errc{}) fail_expecting(what, word);
    return value;
}

std::uint32_t LineScanner::next_vertex_index(std::size_t vertex_count) {
    const std::int64_t index = next_integer("a vertex number");
    if (index < 0 || static_cast<std::uint64_t>(index) >= vertex_count)
        fail(ErrorCode::InvalidMesh, "the face refers to vertex " + std::to_string(index) +
                                         ", but there are " + std::to_string(vertex_count) +
                                         " vertices, numbered from 0");
    return static_cast<std::uint32_t>(index);
}

void LineScanner::fail_expecting(const std::string& what, std::string_view word, ErrorCode code) const {
    fail(code, what + " was expected, not " + (word.empty() ? "the end of the line" : in_quotes(word)));
}

void LineScanner::fail(ErrorCode code, const std::string& what) const {
    fail_at(line_number_, code, what);
}

void LineScanner::fail_at(std::size_t line_number, ErrorCode code, const std::string& what) const {
    source_.fail(code, "line " + std::to_string(line_number) + ": " + what);
}

} // namespace echinus
