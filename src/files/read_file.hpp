#pragma once

#include <echinus/export.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

ECHINUS_EXPORT_BEGIN

namespace echinus {

/// The most bytes that are read from a pipe or a device, which may be endless.
inline constexpr std::size_t kMostStreamBytes = std::size_t{1} << 30;

/// Checks the first 64 KiB of a file that has more, before the rest is read. Throws an Error if the file is
/// useless whatever follows.
using CheckBeginning = std::function<void(std::span<const std::byte> beginning)>;

/// The bytes of a file, at an address that is a multiple of 16. For a regular file, as many as it has when it
/// is opened, or fewer if it is shortened meanwhile; for a pipe or a device, all.
///
/// @throws Error Unreadable, also if a pipe or a device has more than `most_stream_bytes`; the message begins
/// with the path. Exceptions of the check are passed on.
std::vector<std::byte> read_file(const std::filesystem::path& path,
                                 const CheckBeginning& check_beginning = nullptr,
                                 std::size_t most_stream_bytes = kMostStreamBytes);

/// The bytes of a file, mapped into memory if the system and the kind of file permit it, otherwise read (a
/// pipe, /dev/stdin). They start at an address that is a multiple of 16.
///
/// Nobody may shorten or overwrite the file in place while it is mapped: the system would end the process.
/// Replacing it, as AtomicFile does, is safe, since the mapping keeps the old file. So only map files, which
/// are used in place, are mapped; other files are read by read_file().
class MappedFile {
  public:
    /// @param check_beginning  applied to a file that cannot be mapped
    /// @throws Error as read_file()
    explicit MappedFile(const std::filesystem::path& path, const CheckBeginning& check_beginning = nullptr);
    MappedFile(const MappedFile&) = delete;
    MappedFile& operator=(const MappedFile&) = delete;
    ~MappedFile();

    std::span<const std::byte> bytes() const { return bytes_; }

  private:
    std::span<const std::byte> bytes_;
    std::vector<std::byte> copy_; // empty if the file is mapped
};

/// A file whose pieces are read on demand. A pipe or a device is read completely at first. Safe to use from
/// several threads.
class RandomAccessFile {
  public:
    /// @throws Error Unreadable, as read_file()
    explicit RandomAccessFile(const std::filesystem::path& path);
    RandomAccessFile(const RandomAccessFile&) = delete;
    RandomAccessFile& operator=(const RandomAccessFile&) = delete;
    ~RandomAccessFile();

    /// The size when the file was opened.
    std::uint64_t size() const { return size_; }

    /// Fills `bytes` with the bytes of the file from the offset on.
    /// @returns  the number of bytes read, fewer than requested only at the end of the file
    /// @throws Error Unreadable
    std::size_t read(std::uint64_t offset, std::span<std::byte> bytes) const;

  private:
    std::filesystem::path path_;
    int descriptor_ = -1; // of a regular file; otherwise -1
    std::uint64_t size_ = 0;
    std::vector<std::byte> copy_; // the bytes of any other file
};

} // namespace echinus

ECHINUS_EXPORT_END
