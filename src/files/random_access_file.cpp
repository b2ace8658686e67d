#include "files/random_access_file.hpp"

#include "files/read_file.hpp"

#include <echinus/error.hpp>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace echinus {

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
