#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace echinus {

/// The path that UTF-8 names. Windows would read bytes in its old code page, which it does with those that
/// are not UTF-8.
inline std::filesystem::path utf8_path(std::string_view text) {
#ifdef _WIN32
    try {
        return std::u8string(text.begin(), text.end());
    } catch (const std::filesystem::filesystem_error&) {
    }
#endif
    return text;
}

} // namespace echinus
