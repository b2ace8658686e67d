#include "mesh_io/line_scanner.hpp"

#include "geometry/whole_numbers.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>
#include <utility>

namespace echinus {

namespace {

constexpr std::string_view kBlanks = " \t\v\f";
/// Programs for DOS and for tapes fill up the last block of a text with these.
constexpr std::string_view kPadding{"\0\x1a \t\v\f\r\n", 8};

constexpr bool is_control(char c) {
    return static_cast<unsigned char>(c) < ' ' && kBlanks.find(c) == std::string_view::npos;
}

/// Is the # at this position part of 1.#INF, 1.#IND, 1.#QNAN or 1.#SNAN, which Microsoft's libraries wrote
/// for infinity and NaN, or of a shorter form, which resulted from rounding them (1.#J, 1.#R, 1.#QO)?
bool is_in_number(std::string_view line, std::size_t hash) {
    return hash >= 2 && line.substr(hash - 2, 2) == "1." && hash + 1 < line.size() &&
           std::string_view("IQSJR").find(line[hash + 1]) != std::string_view::npos;
}

std::string_view without_comment(std::string_view line) {
    std::size_t hash = line.find('#');
    while (hash != std::string_view::npos && is_in_number(line, hash)) hash = line.find('#', hash + 1);
    return line.substr(0, hash);
}

std::string_view without_plus(std::string_view word) {
    if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
    return word;
}

#ifdef __cpp_lib_to_chars

template <typename Number>
std::from_chars_result read_number(std::string_view word, Number& value) {
    return std::from_chars(word.data(), word.data() + word.size(), value);
}

#else // libc++ before 20, as in Emscripten: strtof and strtod of musl round correctly and ignore the locale

/// Would std::from_chars begin to read here? strtof also accepts blanks, a plus and hexadecimal numbers.
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
        const std::string text(word); // terminated by a zero
        char* end = nullptr;
        errno = 0;
        if constexpr (std::is_same_v<Number, float>)
            value = std::strtof(text.c_str(), &end);
        else
            value = std::strtod(text.c_str(), &end);
        // ERANGE is also set for small numbers that are only rounded.
        const bool is_lost = value == 0 || std::isinf(value);
        return {word.data() + (end - text.c_str()),
                errno == ERANGE && is_lost ? std::errc::result_out_of_range : std::errc{}};
    }
}

#endif

template <typename Number>
std::errc parse_whole(std::string_view word, Number& value) {
    const auto [end, error] = read_number(word, value);
    return error == std::errc{} && end != word.data() + word.size() ? std::errc::invalid_argument : error;
}

/// The value of a number beyond the range of double: 0 if the exponent says so. A word with very many digits
/// could be either, and counts as too large.
double out_of_range(std::string_view word) {
    constexpr std::size_t kMostDigits = 64;
    const bool is_small = word.size() <= kMostDigits && word.find_first_of("eE") != std::string_view::npos &&
                          word.find('-', word.find_first_of("eE")) != std::string_view::npos;
    return is_small ? 0 : HUGE_VAL;
}

/// A number in text that is very close to the midpoint between two floats may be rounded to that midpoint as
/// a double, and then to the farther float. So a double whose last bits are those of a midpoint is compared
/// with the float that the word gives directly.
double rounding_to_nearest_float(std::string_view word, double value) {
    constexpr std::uint64_t kZeroInMiddles = (std::uint64_t{1} << 28) - 1;
    if ((echinus::bit_cast<std::uint64_t>(value) & kZeroInMiddles) != 0) return value;
    float nearest = 0;
    if (parse_whole(word, nearest) != std::errc{} || nearest == static_cast<float>(value)) return value;
    return std::nextafter(value, double{nearest});
}

std::string expectation(const std::string& what, std::string_view word) {
    return what + " was expected, not " + (word.empty() ? "the end of the line" : in_quotes(word));
}

/// Explains why a word that looks like a number to a person is not one.
std::string remedy_for(std::string_view word) {
    const bool has_digits = word.find_first_of("0123456789") != std::string_view::npos;
    if (has_digits && word.find(',') != std::string_view::npos)
        return "; numbers have a decimal point and blanks between them, no commas";
    if (has_digits && word.find_first_of("dD") != std::string_view::npos)
        return "; exponents are written with an e";
    return {};
}

} // namespace

bool parse_number(std::string_view word, double& value) {
    word = without_plus(word);
    if (const std::size_t hash = word.find('#'); hash != std::string_view::npos) {
        value = std::numeric_limits<double>::quiet_NaN();
        return is_in_number(word, hash) && word.find_first_not_of("-0123456789") == hash - 1;
    }
    const std::errc error = parse_whole(word, value);
    if (error == std::errc::result_out_of_range)
        value = out_of_range(word);
    else if (error == std::errc{})
        value = rounding_to_nearest_float(word, value);
    return error == std::errc{} || error == std::errc::result_out_of_range;
}

bool parse_integer(std::string_view word, std::int64_t& value) {
    return parse_whole(without_plus(word), value) == std::errc{};
}

/// The text of the next line of the file, without its comment. Advances past the line.
std::string_view LineScanner::take_line() {
    const std::string_view text = source_.bytes;
    const std::string_view rest = text.substr(next_);
    const auto end =
        static_cast<std::size_t>(std::find_if(rest.begin(), rest.end(), is_control) - rest.begin());
    const std::string_view behind = rest.substr(end);
    const std::size_t number = next_number_++;
    if (behind.starts_with("\r\n")) {
        next_ += end + 2;
    } else if (behind.starts_with('\n') || behind.starts_with('\r')) {
        next_ += end + 1;
    } else if (next_ + end > 0 && behind.find_first_not_of(kPadding) == std::string_view::npos) {
        next_ = text.size();
    } else {
        fail_at(number, ErrorCode::WrongFormat,
                std::string("the line has control characters, so the file is not text") +
                    (behind[0] == '\0' ? ", or it is UTF-16, which must be saved as UTF-8" : ""));
    }
    return without_comment(rest.substr(0, end));
}

/// Takes the next line of the file, without the backslash at its end; returns false if it has none.
bool LineScanner::take_continued_line() {
    const std::size_t begin = next_;
    rest_ = take_line();
    // A comment is cut off, so a backslash before it is not the line's last character in the file.
    const std::size_t end = begin + rest_.size();
    const bool is_continued = rest_.ends_with('\\') && source_.bytes.substr(end, 1) != "#";
    if (is_continued) rest_.remove_suffix(1);
    return is_continued;
}

void LineScanner::take_joined_lines() {
    if (!take_continued_line()) return;
    bool is_continued = true;
    while (is_continued && next_ < source_.bytes.size()) {
        joined_.append(rest_).push_back(' ');
        is_continued = take_continued_line();
    }
    joined_.append(rest_);
    rest_ = joined_;
}

bool LineScanner::next_line() {
    while (next_ < source_.bytes.size()) {
        line_number_ = next_number_;
        joined_.clear();
        if (continuation_ == Continuation::Backslash)
            take_joined_lines();
        else
            rest_ = take_line();
        if (!at_end_of_line()) return true;
    }
    return false;
}

void LineScanner::require_line(const std::string& what) {
    if (!next_line()) source_.fail(ErrorCode::Damaged, "the file ends where " + what + " was expected");
}

std::size_t LineScanner::count_lines_left() const {
    LineScanner ahead(source_, next_, next_number_);
    std::size_t count = 0;
    while (ahead.next_line()) ++count;
    return count;
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

void LineScanner::give_back(std::string_view end) {
    rest_ = {end.data(), end.size() + rest_.size()};
}

void LineScanner::read_across_lines(std::string reason) {
    reads_across_lines_ = true;
    reason_ = std::move(reason);
}

void LineScanner::read_within_lines() {
    reads_across_lines_ = false;
    reason_.clear();
}

std::string_view LineScanner::next_number(const std::string& what) {
    if (reads_across_lines_ && at_end_of_line()) require_line(what);
    return next_word();
}

double LineScanner::next_coordinate() {
    const std::string_view word = next_number("a coordinate");
    double value = 0;
    if (!parse_number(word, value))
        fail(ErrorCode::Damaged, expectation("a coordinate", word) + remedy_for(word));
    if (!std::isfinite(static_cast<float>(value)))
        fail(ErrorCode::InvalidMesh, "the coordinate " + in_quotes(word) + " is not finite as a float");
    return value;
}

Vec3d LineScanner::next_position() {
    const double x = next_coordinate();
    const double y = next_coordinate();
    return {x, y, next_coordinate()};
}

void LineScanner::skip_number() {
    const std::string_view word = next_number("a number");
    double ignored = 0;
    if (!parse_number(word, ignored))
        fail(ErrorCode::Damaged, expectation("a number", word) + remedy_for(word));
}

std::int64_t LineScanner::next_integer(const std::string& what) {
    const std::string_view word = next_number(what);
    std::int64_t value = 0;
    if (!parse_integer(word, value)) fail_expecting(what, word);
    return value;
}

std::size_t LineScanner::next_count(const std::string& what) {
    const std::int64_t count = next_integer(what);
    if (count < 0 || count >= std::numeric_limits<std::uint32_t>::max())
        fail(ErrorCode::Damaged, what + " cannot be " + std::to_string(count));
    return static_cast<std::size_t>(count);
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
    fail(code, expectation(what, word));
}

void LineScanner::fail(ErrorCode code, const std::string& what) const {
    fail_at(line_number_, code, what);
}

void LineScanner::fail_at(std::size_t line_number, ErrorCode code, const std::string& what) const {
    source_.fail(code, "line " + std::to_string(line_number) + ": " + what + reason_);
}

} // namespace echinus
