#include "files/read_file.hpp"

#include "files/system.hpp"

#include <echinus/error.hpp>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace echinus {

namespace fs = std::filesystem;

namespace {

using FileHandle = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

[[noreturn]] void fail(const fs::path& path, const char* action) {
    const std::string reason = std::strerror(errno);
    const std::string name = path.empty() ? "a path that is empty" : path.string();
    throw Error(ErrorCode::Unreadable, name + ": cannot " + action + " the file: " + reason);
}

FileHandle open_stream(const fs::path& path, int descriptor) {
    std::FILE* const file = descriptor < 0 ? nullptr : system::stream_of(descriptor, "rb");
    if (file == nullptr) {
        const int reason = errno;
        if (descriptor >= 0) system::close(descriptor);
        errno = reason;
        fail(path, "open");
    }
    return {file, &std::fclose};
}

} // namespace

std::vector<std::byte> read_file(const fs::path& path, const CheckBeginning& check_beginning,
                                 std::size_t most_stream_bytes) {
    constexpr std::size_t kBlock = std::size_t{1} << 16;
    const int descriptor = system::open_to_read(path);
    const FileHandle file = open_stream(path, descriptor);
    const auto size = static_cast<std::size_t>(system::size_of(descriptor).value_or(0));
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

/// Maps the file; returns nothing if it has to be read. A pipe is not opened, since that would consume its
/// bytes.
std::span<const std::byte> map_bytes(const fs::path& path) {
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored)) return {};
    const int descriptor = system::open_to_read(path);
    if (descriptor < 0) return {};
    const std::uint64_t size = system::size_of(descriptor).value_or(0);
    std::span<const std::byte> bytes;
    if (size > 0) bytes = system::map(descriptor, static_cast<std::size_t>(size));
    system::close(descriptor);
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
    if (copy_.empty() && !bytes_.empty()) system::unmap(bytes_);
}

RandomAccessFile::RandomAccessFile(const std::filesystem::path& path) : path_(path) {
    std::error_code ignored;
    if (fs::is_regular_file(path, ignored)) descriptor_ = system::open_to_read(path);
    const std::optional<std::uint64_t> size = descriptor_ < 0 ? std::nullopt : system::size_of(descriptor_);
    if (size) {
        size_ = *size;
    } else {
        if (descriptor_ >= 0) system::close(std::exchange(descriptor_, -1));
        copy_ = read_file(path);
        size_ = copy_.size();
    }
}

RandomAccessFile::~RandomAccessFile() {
    if (descriptor_ >= 0) system::close(descriptor_);
}

std::size_t RandomAccessFile::read(std::uint64_t offset, std::span<std::byte> bytes) const {
    if (descriptor_ < 0) {
        const std::span<const std::byte> rest =
            std::span(copy_).subspan(std::min<std::uint64_t>(offset, size_));
        const std::size_t count = std::min(bytes.size(), rest.size());
        std::copy_n(rest.begin(), count, bytes.begin());
        return count;
    }
    const std::optional<std::size_t> count = system::read_at(descriptor_, offset, bytes);
    if (!count) fail(path_, "read");
    return *count;
}

} // namespace echinus
