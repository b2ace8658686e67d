#pragma once

#include <echinus/export.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

ECHINUS_EXPORT_BEGIN

namespace echinus {

/// A file of which pieces are read when they are needed. A pipe or a device is read to its end at first. Safe
/// to use from several threads.
class RandomAccessFile {
  public:
    /// @throws Error Unreadable, as read_file()
    explicit RandomAccessFile(const std::filesystem::path& path);
    RandomAccessFile(const RandomAccessFile&) = delete;
    RandomAccessFile& operator=(const RandomAccessFile&) = delete;
    ~RandomAccessFile();

    /// When it was opened.
    std::uint64_t size() const { return size_; }

    /// Fills `bytes` with those that begin at the offset.
    /// @returns how many there are, fewer only where the file ends
    /// @throws Error Unreadable
    std::size_t read(std::uint64_t offset, std::span<std::byte> bytes) const;

  private:
    std::filesystem::path path_;
    int descriptor_ = -1; // of a regular file
    std::uint64_t size_ = 0;
    std::vector<std::byte> copy_; // of another
};

} // namespace echinus

ECHINUS_EXPORT_END
