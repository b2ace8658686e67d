#pragma once

#include <echinus/export.hpp>

#include <cstddef>
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

} // namespace echinus

ECHINUS_EXPORT_END
