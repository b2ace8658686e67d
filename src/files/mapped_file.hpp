#pragma once

#include <echinus/export.hpp>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

ECHINUS_EXPORT_BEGIN

namespace echinus {

/// The bytes of a file, mapped into memory where the system and the kind of file allow it, otherwise read (a
/// pipe, /dev/stdin). They start at an address that is a multiple of 16.
///
/// Nobody may shorten or overwrite the file in place as long as it is mapped. Replacing it, as AtomicFile
/// does, is safe: the mapping keeps the old file.
class MappedFile {
  public:
    /// The most bytes that are read from what cannot be mapped: a pipe or a device may have no end.
    static constexpr std::size_t kMostReadBytes = std::size_t{1} << 30;

    /// Looks at the first 64 KiB of a pipe or a device, before the rest is read. Throws an Error when the
    /// bytes are of no use, whatever follows them.
    using CheckBeginning = std::function<void(std::span<const std::byte> beginning)>;

    /// @throws Error Unreadable, also when a pipe or a device has more than `most_read_bytes`; the sentence
    /// begins with the path. What the check throws passes through.
    explicit MappedFile(const std::filesystem::path& path, const CheckBeginning& check_beginning = nullptr,
                        std::size_t most_read_bytes = kMostReadBytes);
    MappedFile(const MappedFile&) = delete;
    MappedFile& operator=(const MappedFile&) = delete;
    ~MappedFile();

    std::span<const std::byte> bytes() const { return bytes_; }

  private:
    std::span<const std::byte> bytes_;
    std::vector<std::byte> copy_; // empty when mapped
};

} // namespace echinus

ECHINUS_EXPORT_END
