#pragma once

#include <echinus/export.hpp>

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <string_view>

ECHINUS_EXPORT_BEGIN

namespace echinus {

// A *part* is an unfinished result: a file or folder called .echinus.part and a number, in the folder where
// the result will be. The process that writes it holds it (files/system.hpp) until the process ends, by
// whatever cause, so that others can recognise abandoned parts. On file systems without locks, all parts
// count as held.

/// A path for a new part in this folder, which no other thread or process of Echinus uses.
std::filesystem::path new_part(const std::filesystem::path& folder);

/// Removes the parts in this folder that no process holds. Parts that cannot be removed stay.
void remove_abandoned_parts(const std::filesystem::path& folder) noexcept;

/// A file that appears completely or not at all. Bytes are written to a file without a name (O_TMPFILE) in
/// the target's folder or, if the file system does not support such files, to a part. commit() gives it the
/// target's name once the bytes are on the disk, so that even after a power cut there is either the old
/// target or the new one. Without commit(), even if the process is killed, the old target stays and nothing
/// else remains, except possibly a part, which remove_abandoned_parts() removes later. An existing target
/// that is not a regular file (/dev/stdout, a pipe) is written to directly, since a rename would replace the
/// device.
///
/// commit() waits for the disk twice, for the bytes and for the name, which takes milliseconds.
///
/// All members throw Error Unwritable with a message that names the target and the system's reason.
class AtomicFile {
  public:
    explicit AtomicFile(const std::filesystem::path& target);
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;
    ~AtomicFile();

    void write(const void* data, std::size_t byte_count);
    void write(std::string_view text) { write(text.data(), text.size()); }
    /// Replaces bytes that were written before, such as a count in a header. Later writes continue at the
    /// end.
    void overwrite(long offset, const void* data, std::size_t byte_count);
    void commit();

  private:
    std::filesystem::path folder() const;
    int create_part();
    void give_name();
    [[noreturn]] void fail(const char* action) const;

    std::filesystem::path target_; // symbolic links are resolved
    std::filesystem::path part_;   // empty if the file has no name or target_ itself is written to
    bool is_in_place_ = false;     // whether target_ itself is written to
    std::FILE* file_ = nullptr;    // keeps the part held
};

/// Writes a file by an AtomicFile with a single write().
void write_file(const std::filesystem::path& target, std::string_view content);

} // namespace echinus

ECHINUS_EXPORT_END
