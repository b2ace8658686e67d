#include "files/read_file.hpp"

#include <echinus/error.hpp>

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>

namespace echinus {

namespace fs = std::filesystem;

namespace {

using FileHandle = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

[[noreturn]] void fail(const fs::path& path, const char* action) {
    const std::string reason = std::strerror(errno);
    const std::string name = path.empty() ? "a path that is empty" : path.string();
    throw Error(ErrorCode::Unreadable, name + ": cannot " + action + " the file: " + reason);
}

/// Of a regular file; 0 for others, and for those that do not know, as in /proc.
std::size_t stated_size(std::FILE* file) {
    struct stat status {};
    const bool is_regular = fstat(fileno(file), &status) == 0 && S_ISREG(status.st_mode);
    return is_regular ? static_cast<std::size_t>(status.st_size) : 0;
}

} // namespace

std::vector<std::byte> read_file(const fs::path& path, const CheckBeginning& check_beginning,
                                 std::size_t most_stream_bytes) {
    constexpr std::size_t kBlock = std::size_t{1} << 16;
    const FileHandle file(std::fopen(path.c_str(), "rb"), &std::fclose);
    if (file == nullptr) fail(path, "open");
    const std::size_t size = stated_size(file.get());
    std::vector<std::byte> bytes;
    bytes.reserve(size);
    for (;;) {
        const std::size_t old_size = bytes.size();
        const std::size_t wanted = size == 0 ? kBlock : std::min(kBlock, size - old_size);
        bytes.resize(old_size + wanted);
        bytes.resize(old_size + std::fread(bytes.data() + old_size, 1, wanted, file.get()));
        if (std::ferror(file.get()) != 0) fail(path, "read");
        if (size == 0 && bytes.size() > most_stream_bytes)
            throw Error(ErrorCode::Unreadable,
                        path.string() + ": has more than " + std::to_string(most_stream_bytes) +
                            " bytes, the most that are read from a pipe or a device; write them to a file "
                            "first, if they have an end");
        if (bytes.size() == kBlock && check_beginning) check_beginning(bytes);
        if (bytes.size() < old_size + wanted || bytes.size() == size) return bytes;
    }
}

} // namespace echinus
