#include "files/atomic_file.hpp"

#include "files/part.hpp"

#include <echinus/error.hpp>

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

namespace echinus {

namespace fs = std::filesystem;

namespace {

/// Where Linux shows the file of an open descriptor.
std::string path_of_descriptor(int descriptor) {
    return "/proc/self/fd/" + std::to_string(descriptor);
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
    if (fs::exists(status) && !fs::is_regular_file(status)) {
        file_ = std::fopen(target_.c_str(), "wb");
        if (file_ == nullptr) fail("open");
        return;
    }
    const fs::path folder = target_.parent_path().empty() ? "." : target_.parent_path();
    int descriptor = open_unnamed(folder);
    if (descriptor < 0) descriptor = open_part(folder);
    if (descriptor < 0) fail("open");
    lock_ = dup(descriptor);
    lock_part(lock_);
    file_ = fdopen(descriptor, "wb");
}

AtomicFile::~AtomicFile() {
    if (file_ != nullptr) std::fclose(file_);
    if (!part_.empty()) unlink(part_.c_str());
    if (lock_ >= 0) close(lock_);
}

/// @returns a descriptor, or -1 where the system or the file system has no files without names
int AtomicFile::open_unnamed([[maybe_unused]] const fs::path& folder) {
#ifdef O_TMPFILE
    const int descriptor = open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
    if (descriptor < 0 || access(path_of_descriptor(descriptor).c_str(), F_OK) == 0) return descriptor;
    close(descriptor); // it could not be given a name
#endif
    return -1;
}

int AtomicFile::open_part(const fs::path& folder) {
    const fs::path part = new_part(folder);
    const int descriptor = open(part.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
    if (descriptor >= 0) part_ = part;
    return descriptor;
}

/// A link cannot replace a file, but a rename can: first the name of a part, then the target's.
void AtomicFile::give_name() {
    if (part_.empty()) {
        const fs::path part = new_part(target_.parent_path());
        if (linkat(AT_FDCWD, path_of_descriptor(lock_).c_str(), AT_FDCWD, part.c_str(), AT_SYMLINK_FOLLOW) !=
            0)
            fail("name");
        part_ = part;
    }
    if (std::rename(part_.c_str(), target_.c_str()) != 0) fail("rename to");
    part_.clear();
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
    if (lock_ >= 0) give_name();
}

void AtomicFile::fail(const char* action) const {
    const std::string reason = std::strerror(errno);
    const std::string name = target_.empty() ? "a path that is empty" : target_.string();
    throw Error(ErrorCode::Unwritable, name + ": cannot " + action + " the file: " + reason);
}

void write_file(const fs::path& target, std::string_view content) {
    AtomicFile file(target);
    file.write(content);
    file.commit();
}

} // namespace echinus
