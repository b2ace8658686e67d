#include "files/mapped_file.hpp"

#include <echinus/error.hpp>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>

#if __has_include(<sys/mman.h>)
#include <sys/mman.h>
#include <sys/stat.h>
#define ECHINUS_HAS_MMAP
#endif

namespace echinus {

namespace {

using FileHandle = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

[[noreturn]] void fail(const std::filesystem::path& path, const char* action) {
    const std::string reason = std::strerror(errno);
    const std::string name = path.empty() ? "a path that is empty" : path.string();
    throw Error(ErrorCode::Unreadable, name + ": cannot " + action + " the file: " + reason);
}

/// The file as a mapping, or nothing where it has to be read.
std::span<const std::byte> map_bytes([[maybe_unused]] std::FILE* file) {
#ifdef ECHINUS_HAS_MMAP
    struct stat status {};
    if (fstat(fileno(file), &status) != 0 || !S_ISREG(status.st_mode) || status.st_size == 0) return {};
    const auto byte_count = static_cast<std::size_t>(status.st_size);
    void* first = mmap(nullptr, byte_count, PROT_READ, MAP_PRIVATE, fileno(file), 0);
    if (first != MAP_FAILED) return {static_cast<const std::byte*>(first), byte_count};
#endif
    return {};
}

std::vector<std::byte> read_bytes(std::FILE* file, const std::filesystem::path& path,
                                  const MappedFile::CheckBeginning& check_beginning, std::size_t most) {
    constexpr std::size_t kBlock = std::size_t{1} << 16;
    std::vector<std::byte> bytes;
    for (;;) {
        const std::size_t old_size = bytes.size();
        bytes.resize(old_size + kBlock);
        const std::size_t read_count = std::fread(bytes.data() + old_size, 1, kBlock, file);
        bytes.resize(old_size + read_count);
        if (bytes.size() > most)
            throw Error(ErrorCode::Unreadable,
                        path.string() + ": has more than " + std::to_string(most) +
                            " bytes, the most that are read from a pipe or a device; write them to a file "
                            "first, if they have an end");
        if (bytes.size() == kBlock && check_beginning) check_beginning(bytes);
        if (read_count == kBlock) continue;
        if (std::ferror(file) != 0) fail(path, "read");
        return bytes;
    }
}

} // namespace

MappedFile::MappedFile(const std::filesystem::path& path, const CheckBeginning& check_beginning,
                       std::size_t most_read_bytes) {
    const FileHandle file(std::fopen(path.c_str(), "rb"), &std::fclose);
    if (file == nullptr) fail(path, "open");
    bytes_ = map_bytes(file.get());
    if (!bytes_.empty()) return;
    copy_ = read_bytes(file.get(), path, check_beginning, most_read_bytes);
    bytes_ = copy_;
}

MappedFile::~MappedFile() {
#ifdef ECHINUS_HAS_MMAP
    if (copy_.empty() && !bytes_.empty()) munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
#endif
}

} // namespace echinus
