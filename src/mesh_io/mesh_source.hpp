#pragma once

#include <echinus/error.hpp>

#include <filesystem>
#include <string>
#include <string_view>

namespace echinus {

/// A mesh file in memory.
struct MeshSource {
    std::string name; ///< the path, with which every sentence of an error begins
    std::string_view bytes;

    [[noreturn]] void fail(ErrorCode code, const std::string& what) const {
        throw Error(code, name + ": " + what);
    }
};

/// The text of a file, behind the byte order mark of UTF-8 if there is one.
/// @throws Error WrongFormat when the text is UTF-16 or UTF-32
std::string_view text_of(const MeshSource& source);

/// With ASCII capitals as small letters, whatever the locale.
std::string lower_case(std::string_view text);

/// What a path's name ends in, with the dot, in lower case: ".obj" for "A/Horse.OBJ".
std::string lower_case_ending(const std::filesystem::path& path);

/// The text with ? for bytes that do not print, so that it can stand in a sentence.
std::string printable(std::string_view text);

/// A word of a file for use in a sentence: in quotation marks, printable, cut short.
std::string in_quotes(std::string_view text);

} // namespace echinus
