#pragma once

#include <echinus/export.hpp>

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <string_view>

ECHINUS_EXPORT_BEGIN

namespace echinus {

// A *part* is a result that is not finished: a file or folder called .echinus.part and a number, in the
// folder where the result will be. Whoever writes it holds it (files/system.hpp) until the process ends,
// however that is, so that others can tell the parts that were abandoned. File systems without locks are
// taken as holding all of them.

/// The path of a part in this folder, which no other thread or process of ours uses.
std::filesystem::path new_part(const std::filesystem::path& folder);

/// Removes the parts that nobody holds in this folder. Parts that cannot be removed stay.
void remove_abandoned_parts(const std::filesystem::path& folder) noexcept;

/// A file that appears whole or not at all: bytes go to a file in the target's folder that has no name
/// (O_TMPFILE), or, where the file system has no such files, to a part; commit() gives it the
/// target's name, once the disk has the bytes, so that also a power cut leaves the old target or the new one.
/// Without commit() nothing is left and the old target stays, also where the process is killed, except for a
/// part, which remove_abandoned_parts() then removes. A target that exists and is no regular file
/// (/dev/stdout, a pipe) is written to directly, since a rename would replace the device.
///
/// commit() waits for the disk twice, for the bytes and for the name: milliseconds.
///
/// All members throw Error Unwritable with a sentence that names the target and the system's reason.
class AtomicFile {
  public:
    explicit AtomicFile(const std::filesystem::path& target);
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;
    ~AtomicFile();

    void write(const void* data, std::size_t byte_count);
    void write(std::string_view text) { write(text.data(), text.size()); }
    /// Replaces bytes that were written before, such as a count in a header; writing goes on at the end.
    void overwrite(long offset, const void* data, std::size_t byte_count);
    void commit();

  private:
    std::filesystem::path folder() const;
    int create_part();
    void give_name();
    [[noreturn]] void fail(const char* action) const;

    std::filesystem::path target_; // links resolved
    std::filesystem::path part_;   // empty: the file has no name, or target_ itself is written to
    bool is_in_place_ = false;     // target_ itself is written to
    std::FILE* file_ = nullptr;    // holds the part
};

/// An AtomicFile with one write.
void write_file(const std::filesystem::path& target, std::string_view content);

} // namespace echinus

ECHINUS_EXPORT_END
