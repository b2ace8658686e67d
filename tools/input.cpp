#include "input.hpp"

#include <cerrno>
#include <cstring>
#include <iostream>

namespace fs = std::filesystem;
using echinus::ErrorCode;

std::string name_of_input(const fs::path& path) {
    return path == kStandardStream ? "standard input" : path.string();
}

Input::Input(const fs::path& path)
    : name_(name_of_input(path)), stream_(path == kStandardStream ? std::cin : file_) {
    if (path == kStandardStream) return;
    errno = 0;
    file_.open(path, std::ios::binary);
    // A directory can be opened like a file, and reading it fails without a reason.
    std::error_code ignored;
    if (fs::is_directory(path, ignored)) errno = EISDIR;
    if (!file_ || errno == EISDIR) {
        fail(ErrorCode::Unreadable, std::string("cannot open the file: ") + std::strerror(errno));
    }
}

std::size_t Input::read(void* bytes, std::size_t byte_count) {
    stream_.read(static_cast<char*>(bytes), static_cast<std::streamsize>(byte_count));
    require_good();
    return static_cast<std::size_t>(stream_.gcount());
}

bool Input::read_line(std::string& line) {
    line.clear();
    std::streambuf& characters = *stream_.rdbuf();
    constexpr int kEnd = std::char_traits<char>::eof();
    int c = characters.sbumpc();
    if (c == kEnd) {
        stream_.peek(); // detects the end or an error
        require_good();
        return false;
    }
    for (; c != kEnd && c != '\n'; c = characters.sbumpc()) {
        if (line.size() == kMaxLineLength)
            fail(ErrorCode::Damaged,
                 "a line has more than " + std::to_string(kMaxLineLength) + " characters");
        line += static_cast<char>(c);
    }
    if (line.ends_with('\r')) line.pop_back();
    return true;
}

bool Input::next_is(char byte) {
    return stream_.peek() == std::char_traits<char>::to_int_type(byte);
}

bool Input::at_end() {
    return stream_.peek() == std::char_traits<char>::eof();
}

void Input::fail(ErrorCode code, const std::string& finding) const {
    throw echinus::Error(code, name_ + ": " + finding);
}

void Input::require_good() const {
    if (stream_.bad()) fail(ErrorCode::Unreadable, "cannot be read to the end");
}
