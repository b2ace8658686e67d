#include "mesh_io/mesh_source.hpp"

#include "files/text.hpp"

#include <algorithm>

namespace echinus {

std::string_view text_of(const MeshSource& source) {
    return utf8_text(source.bytes,
                     [&](const std::string& what) { source.fail(ErrorCode::WrongFormat, what); });
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
