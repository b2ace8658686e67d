#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace echinus {

/// The path that a UTF-8 string names. Windows would interpret the bytes in its old code page; here it does
/// so only if they are not valid UTF-8.
inline std::filesystem::path utf8_path(std::string_view text) {
#ifdef _WIN32
    try {
        return std::u8string(text.begin(), text.end());
    } catch (const std::filesystem::filesystem_error&) {
    }
#endif
    return text;
}

/// The text of a file, without the byte order mark of UTF-8 if it begins with one.
/// @param fail  is called with a clause, and must throw, if the mark indicates UTF-16 or UTF-32
template <typename Fail>
std::string_view utf8_text(std::string_view bytes, Fail&& fail) {
    using namespace std::string_view_literals;
    constexpr std::string_view kMarkOfUtf8 = "\xef\xbb\xbf";
    constexpr std::array<std::pair<std::string_view, const char*>, 4> kOtherMarks{{
        {"\xff\xfe\0\0"sv, "UTF-32"}, // before UTF-16, whose mark is the beginning of this one
        {"\0\0\xfe\xff"sv, "UTF-32"},
        {"\xff\xfe"sv, "UTF-16"},
        {"\xfe\xff"sv, "UTF-16"},
    }};
    for (const auto& [mark, encoding] : kOtherMarks)
        if (bytes.starts_with(mark))
            fail("the text is " + std::string(encoding) + "; save it as UTF-8 or ASCII");
    return bytes.starts_with(kMarkOfUtf8) ? bytes.substr(kMarkOfUtf8.size()) : bytes;
}

/// A number for use in a message: six significant digits, as a stream writes it. A stream would require
/// locales, which would enlarge the WebAssembly file by a fifth.
inline std::string number_text(double number) {
    char digits[32];
    std::snprintf(digits, sizeof digits, "%g", number);
    return digits;
}

/// A message for an index that is out of range. @param name  the singular of what is counted, such as
/// "collider"
inline std::string no_such_text(const std::string& name, const std::string& index, std::size_t count) {
    return "there is no " + name + " " + index + "; there " +
           (count == 1 ? "is 1" : "are " + std::to_string(count));
}

/// Levenshtein's distance: the least number of insertions, deletions and replacements that turn one word into
/// the other.
inline std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
        }
    }
    return row.back();
}

} // namespace echinus
