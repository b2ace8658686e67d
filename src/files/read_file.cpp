#include "files/read_file.hpp"

#include <echinus/error.hpp>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>

#if __has_include(<sys/mman.h>)
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#define ECHINUS_HAS_MMAP
#endif

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

namespace {

/// The file as a mapping, or nothing where it has to be read. A pipe is not opened, which would take its
/// bytes away.
std::span<const std::byte> map_bytes([[maybe_unused]] const std::filesystem::path& path) {
    std::span<const std::byte> bytes;
#ifdef ECHINUS_HAS_MMAP
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored)) return bytes;
    const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (descriptor < 0) return bytes;
    struct stat status {};
    if (fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode) && status.st_size > 0) {
        const auto byte_count = static_cast<std::size_t>(status.st_size);
        void* first = mmap(nullptr, byte_count, PROT_READ, MAP_PRIVATE, descriptor, 0);
        if (first != MAP_FAILED) bytes = {static_cast<const std::byte*>(first), byte_count};
    }
    close(descriptor);
#endif
    return bytes;
}

} // namespace

MappedFile::MappedFile(const std::filesystem::path& path, const CheckBeginning& check_beginning)
    : bytes_(map_bytes(path)) {
    if (!bytes_.empty()) return;
    copy_ = read_file(path, check_beginning);
    bytes_ = copy_;
}

MappedFile::~MappedFile() {
#ifdef ECHINUS_HAS_MMAP
    if (copy_.empty() && !bytes_.empty()) munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
#endif
}

RandomAccessFile::RandomAccessFile(const std::filesystem::path& path) : path_(path) {
    std::error_code ignored;
    if (std::filesystem::is_regular_file(path, ignored))
        descriptor_ = open(path.c_str(), O_RDONLY | O_CLOEXEC);
    struct stat status {};
    if (descriptor_ >= 0 && fstat(descriptor_, &status) == 0) {
        size_ = static_cast<std::uint64_t>(status.st_size);
    } else {
        copy_ = read_file(path);
        size_ = copy_.size();
    }
}

RandomAccessFile::~RandomAccessFile() {
    if (descriptor_ >= 0) close(descriptor_);
}

std::size_t RandomAccessFile::read(std::uint64_t offset, std::span<std::byte> bytes) const {
    std::size_t count = 0;
    if (descriptor_ < 0) {
        const std::span<const std::byte> rest =
            std::span(copy_).subspan(std::min<std::uint64_t>(offset, size_));
        count = std::min(bytes.size(), rest.size());
        std::copy_n(rest.begin(), count, bytes.begin());
        return count;
    }
    while (count < bytes.size()) {
        const ssize_t read_count = pread(descriptor_, bytes.data() + count, bytes.size() - count,
                                         static_cast<off_t>(offset + count));
        if (read_count == 0) break;
        if (read_count < 0 && errno != EINTR)
            throw Error(ErrorCode::Unreadable,
                        path_.string() + ": cannot read the file: " + std::strerror(errno));
        count += static_cast<std::size_t>(std::max<ssize_t>(read_count, 0));
    }
    return count;
}

} // namespace echinus
