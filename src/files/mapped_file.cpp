#include "files/mapped_file.hpp"

#if __has_include(<sys/mman.h>)
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#define ECHINUS_HAS_MMAP
#endif

namespace echinus {

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

} // namespace echinus
