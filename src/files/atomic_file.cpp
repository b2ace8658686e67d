#include "files/atomic_file.hpp"

#include "files/system.hpp"

#include <echinus/error.hpp>

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

} // namespace

fs::path new_part(const fs::path& folder) {
    static std::atomic<unsigned> counter{std::random_device{}()};
    return folder / (std::string(kPrefix) + std::to_string(counter++));
}

void remove_abandoned_parts(const fs::path& folder) noexcept {
    std::error_code error;
    fs::directory_iterator entry(folder, error);
    for (; !error && entry != fs::directory_iterator(); entry.increment(error))
        if (is_part(entry->path())) system::remove_unless_held(entry->path());
}

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
    is_in_place_ = fs::exists(status) && !fs::is_regular_file(status);
    int descriptor = is_in_place_ ? system::open_to_write(target_) : system::create_unnamed(folder());
    if (descriptor < 0 && !is_in_place_) descriptor = create_part();
    if (descriptor < 0) fail("open");
    file_ = system::stream_of(descriptor, "wb");
    if (file_ != nullptr) return;
    const int reason = errno;
    system::close(descriptor);
    if (!part_.empty()) fs::remove(part_, ignored);
    errno = reason;
    fail("open");
}

AtomicFile::~AtomicFile() {
    std::error_code ignored;
    if (!part_.empty()) fs::remove(part_, ignored);
    if (file_ != nullptr) std::fclose(file_);
}

fs::path AtomicFile::folder() const {
    return target_.parent_path().empty() ? "." : target_.parent_path();
}

int AtomicFile::create_part() {
    const fs::path part = new_part(folder());
    const int descriptor = system::create(part);
    if (descriptor >= 0) part_ = part;
    return descriptor;
}

/// A link cannot replace a file, but a rename can: the file first gets the name of a part, then the target's.
void AtomicFile::give_name() {
    if (part_.empty()) {
        const fs::path part = new_part(folder());
        if (!system::give_name(file_, part)) fail("name");
        part_ = part;
    }
    if (!system::replace(target_, part_)) fail("rename to");
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
    if (std::fflush(file_) != 0) fail("write"); // a full disk is noticed when the buffer is written
    if (!is_in_place_) {
        // If the name reached the disk before the bytes, a power cut could leave an empty file with that
        // name.
        if (!system::sync(file_)) fail("write");
        give_name();
    }
    const bool closed = std::fclose(std::exchange(file_, nullptr)) == 0;
    if (!is_in_place_)
        system::sync_names(folder());
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
