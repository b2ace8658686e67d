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

/// The most bytes that are read from a pipe or a device, which may have no end.
inline constexpr std::size_t kMostStreamBytes = std::size_t{1} << 30;

/// Looks at the first 64 KiB of a file that has more, before the rest is read. Throws an Error when the bytes
/// are of no use, whatever follows them.
using CheckBeginning = std::function<void(std::span<const std::byte> beginning)>;

/// The bytes of a file, at an address that is a multiple of 16. Of a regular file as many as it has when it
/// is opened, or fewer when it is shortened meanwhile; of a pipe or a device all.
///
/// @throws Error Unreadable, also when a pipe or a device has more than `most_stream_bytes`; the sentence
/// begins with the path. Exceptions of the check pass through.
std::vector<std::byte> read_file(const std::filesystem::path& path,
                                 const CheckBeginning& check_beginning = nullptr,
                                 std::size_t most_stream_bytes = kMostStreamBytes);

/// The bytes of a file, mapped into memory where the system and the kind of file allow it, otherwise read (a
/// pipe, /dev/stdin). They start at an address that is a multiple of 16.
///
/// Nobody may shorten or overwrite the file in place as long as it is mapped: the system would end the
/// process. Replacing it, as AtomicFile does, is safe: the mapping keeps the old file. So only maps are
/// mapped, which are read in place; other files are read by read_file().
class MappedFile {
  public:
    /// @param check_beginning  of what cannot be mapped
    /// @throws Error as read_file()
    explicit MappedFile(const std::filesystem::path& path, const CheckBeginning& check_beginning = nullptr);
    MappedFile(const MappedFile&) = delete;
    MappedFile& operator=(const MappedFile&) = delete;
    ~MappedFile();

    std::span<const std::byte> bytes() const { return bytes_; }

  private:
    std::span<const std::byte> bytes_;
    std::vector<std::byte> copy_; // empty when mapped
};

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
