#include "files/atomic_file.hpp"

#include <echinus/error.hpp>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <random>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

namespace echinus {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kPrefix = ".echinus.part";

bool is_part(const fs::path& path) {
    const std::string name = path.filename().string();
    return name.size() > kPrefix.size() && name.starts_with(kPrefix) &&
           std::all_of(name.begin() + kPrefix.size(), name.end(),
                       [](char c) { return c >= '0' && c <= '9'; });
}

void remove_if_abandoned(const fs::path& part) {
    const int descriptor = open(part.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) return;
    std::error_code ignored;
    if (lock_part(descriptor)) fs::remove_all(part, ignored);
    close(descriptor);
}

} // namespace

fs::path new_part(const fs::path& folder) {
    static std::atomic<unsigned> counter{std::random_device{}()};
    return folder / (std::string(kPrefix) + std::to_string(counter++));
}

bool lock_part(int descriptor) noexcept {
    return flock(descriptor, LOCK_EX | LOCK_NB) == 0;
}

void remove_abandoned_parts(const fs::path& folder) noexcept {
    std::error_code error;
    fs::directory_iterator entry(folder, error);
    for (; !error && entry != fs::directory_iterator(); entry.increment(error))
        if (is_part(entry->path())) remove_if_abandoned(entry->path());
}

namespace {

/// Where Linux shows the file of an open descriptor.
std::string path_of_descriptor(int descriptor) {
    return "/proc/self/fd/" + std::to_string(descriptor);
}

/// Waits until the disk has what was written.
/// @returns false with errno; true also where the file system cannot say when that is
bool sync(int descriptor) {
    return fsync(descriptor) == 0 || errno == EINVAL || errno == ENOTSUP || errno == ENOSYS;
}

/// So that a new name outlasts a power cut. The file is whole without it, so nothing fails here: there are
/// folders that may be written to and not be opened.
void sync_names(const fs::path& folder) {
    const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) return;
    fsync(descriptor);
    close(descriptor);
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
        is_in_place_ = true;
        file_ = std::fopen(target_.c_str(), "wbe");
        if (file_ == nullptr) fail("open");
        return;
    }
    int descriptor = open_unnamed();
    if (descriptor < 0) descriptor = open_part();
    if (descriptor < 0) fail("open");
    lock_part(descriptor);
    file_ = fdopen(descriptor, "wb");
    if (file_ != nullptr) return;
    const int reason = errno;
    close(descriptor);
    if (!part_.empty()) unlink(part_.c_str());
    errno = reason;
    fail("open");
}

AtomicFile::~AtomicFile() {
    if (!part_.empty()) unlink(part_.c_str());
    if (file_ != nullptr) std::fclose(file_);
}

fs::path AtomicFile::folder() const {
    return target_.parent_path().empty() ? "." : target_.parent_path();
}

/// @returns a descriptor, or -1 where the system or the file system has no files without names
int AtomicFile::open_unnamed() {
#ifdef O_TMPFILE
    const int descriptor = open(folder().c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
    if (descriptor < 0 || access(path_of_descriptor(descriptor).c_str(), F_OK) == 0) return descriptor;
    close(descriptor); // it could not be given a name
#endif
    return -1;
}

int AtomicFile::open_part() {
    const fs::path part = new_part(folder());
    const int descriptor = open(part.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
    if (descriptor >= 0) part_ = part;
    return descriptor;
}

/// A link cannot replace a file, but a rename can: first the name of a part, then the target's.
void AtomicFile::give_name() {
    if (part_.empty()) {
        const fs::path part = new_part(folder());
        if (linkat(AT_FDCWD, path_of_descriptor(fileno(file_)).c_str(), AT_FDCWD, part.c_str(),
                   AT_SYMLINK_FOLLOW) != 0)
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
    if (std::fflush(file_) != 0) fail("write"); // buffered bytes meet a full disk only now
    if (!is_in_place_) {
        // A name that reached the disk before the bytes did would be that of an empty file.
        if (!sync(fileno(file_))) fail("write");
        give_name();
    }
    const bool closed = std::fclose(std::exchange(file_, nullptr)) == 0;
    if (!is_in_place_)
        sync_names(folder());
    else if (!closed)
        fail("write");
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
