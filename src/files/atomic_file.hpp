#pragma once

#include <echinus/export.hpp>

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <string_view>

ECHINUS_EXPORT_BEGIN

namespace echinus {

/// A file that appears whole or not at all: bytes go to a temporary name in the target's folder, commit()
/// renames. Without commit() the destructor removes the temporary file and the old target stays. A target
/// that exists and is no regular file (/dev/stdout, a pipe) is written to directly, since a rename would
/// replace the device.
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
    [[noreturn]] void fail(const char* action) const;

    std::filesystem::path target_;    // links resolved
    std::filesystem::path temporary_; // empty: target_ itself is written to
    std::FILE* file_ = nullptr;
};

/// An AtomicFile with one write.
void write_file(const std::filesystem::path& target, std::string_view content);

} // namespace echinus

ECHINUS_EXPORT_END
