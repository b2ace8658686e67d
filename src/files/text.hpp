#pragma once

#include <array>
#include <cstdio>
#include <string>
#include <string_view>
#include <utility>

namespace echinus {

/// The text of a file, behind the byte order mark of UTF-8 if there is one.
/// @param fail  is called with a clause, and must throw, when the mark says that the text is UTF-16 or UTF-32
template <typename Fail>
std::string_view utf8_text(std::string_view bytes, Fail&& fail) {
    using namespace std::string_view_literals;
    constexpr std::string_view kMarkOfUtf8 = "\xef\xbb\xbf";
    constexpr std::array<std::pair<std::string_view, const char*>, 4> kOtherMarks{{
        {"\xff\xfe\0\0"sv, "UTF-32"}, // before that of UTF-16, which it begins with
        {"\0\0\xfe\xff"sv, "UTF-32"},
        {"\xff\xfe"sv, "UTF-16"},
        {"\xfe\xff"sv, "UTF-16"},
    }};
    for (const auto& [mark, encoding] : kOtherMarks)
        if (bytes.starts_with(mark))
            fail("the text is " + std::string(encoding) + "; save it as UTF-8 or ASCII");
    return bytes.starts_with(kMarkOfUtf8) ? bytes.substr(kMarkOfUtf8.size()) : bytes;
}

/// A number in a sentence: six significant digits, as a stream writes it. Streams would bring their locales
/// along, which make the WebAssembly file a fifth larger.
inline std::string number_text(double number) {
    char digits[32];
    std::snprintf(digits, sizeof digits, "%g", number);
    return digits;
}

} // namespace echinus
