#pragma once

#include "files/read_file.hpp"

#include <echinus/export.hpp>

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

ECHINUS_EXPORT_BEGIN

namespace echinus {

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

} // namespace echinus

ECHINUS_EXPORT_END
