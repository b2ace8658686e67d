#include "files/atomic_file.hpp"

#include <echinus/error.hpp>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <random>
#include <string>

namespace echinus {

namespace fs = std::filesystem;

namespace {

/// A name beside the target that no other thread or process uses.
fs::path temporary_name(const fs::path& target) {
    static std::atomic<unsigned> counter{std::random_device{}()};
    return fs::path(target).concat(".part" + std::to_string(counter++));
}

} // namespace

AtomicFile::AtomicFile(const fs::path& target) : target_(target) {
    std::error_code ignored;
    if (fs::is_symlink(target, ignored)) {
        const fs::path resolved = fs::weakly_canonical(target, ignored);
        if (!resolved.empty()) target_ = resolved;
    }
    const fs::file_status status = fs::status(target_, ignored);
    if (fs::is_directory(status)) {
        errno = EISDIR;
        fail("open");
    }
    const bool rename_later = !fs::exists(status) || fs::is_regular_file(status);
    if (rename_later) temporary_ = temporary_name(target_);
    file_ = std::fopen(rename_later ? temporary_.c_str() : target_.c_str(), "wb");
    if (file_ == nullptr) {
        temporary_.clear();
        fail("open");
    }
}

AtomicFile::~AtomicFile() {
    if (file_ != nullptr) std::fclose(file_);
    std::error_code ignored;
    if (!temporary_.empty()) fs::remove(temporary_, ignored);
}

void AtomicFile::write(const void* data, std::size_t byte_count) {
    if (byte_count != 0 && std::fwrite(data, 1, byte_count, file_) != byte_count) fail("write");
}

void AtomicFile::overwrite(long offset, const void* data, std::size_t byte_count) {
    if (std::fseek(file_, offset, SEEK_SET) != 0) fail("seek in");
    write(data, byte_count);
    if (std::fseek(file_, 0, SEEK_END) != 0) fail("seek in");
}

void AtomicFile::commit() {
    // Buffered bytes meet a full disk only now, so both results count.
    const bool flushed = std::fflush(file_) == 0;
    const int flush_error = errno;
    const bool closed = std::fclose(file_) == 0;
    file_ = nullptr;
    if (!flushed) errno = flush_error;
    if (!flushed || !closed) fail("write");
    if (temporary_.empty()) return;
    if (std::rename(temporary_.c_str(), target_.c_str()) != 0) fail("rename to");
    temporary_.clear();
}

void AtomicFile::fail(const char* action) const {
    const std::string reason = std::strerror(errno);
    throw Error(ErrorCode::Unwritable, target_.string() + ": cannot " + action + " the file: " + reason);
}

void write_file(const fs::path& target, std::string_view content) {
    AtomicFile file(target);
    file.write(content);
    file.commit();
}

} // namespace echinus
