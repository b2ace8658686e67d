#include "mesh_io/mesh_source.hpp"

#include <algorithm>

namespace echinus {

bool begins_as_utf16(std::string_view bytes) {
    return bytes.starts_with("\xff\xfe") || bytes.starts_with("\xfe\xff");
}

std::size_t begin_of_text(const MeshSource& source) {
    constexpr std::string_view kMarkOfUtf8 = "\xef\xbb\xbf";
    if (begins_as_utf16(source.bytes))
        source.fail(ErrorCode::WrongFormat, "the text is UTF-16; save it as UTF-8 or ASCII");
    return source.bytes.starts_with(kMarkOfUtf8) ? kMarkOfUtf8.size() : 0;
}

std::string lower_case(std::string_view text) {
    std::string lower(text);
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return lower;
}

std::string lower_case_ending(const std::filesystem::path& path) {
    return lower_case(path.extension().string());
}

std::string printable(std::string_view text) {
    std::string shown(text);
    const auto is_unprintable = [](char c) { return c < ' ' || c > '~'; };
    std::replace_if(shown.begin(), shown.end(), is_unprintable, '?');
    return shown;
}

std::string in_quotes(std::string_view text) {
    constexpr std::size_t kMaxLength = 24;
    const std::string shown = printable(text.substr(0, kMaxLength));
    return "'" + shown + (text.size() > kMaxLength ? "...'" : "'");
}

} // namespace echinus
