#pragma once

#include <echinus/any_map.hpp>
#include <echinus/export.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

ECHINUS_EXPORT_BEGIN

/// Map files (docs/file_format.md). The structure and the contents of a file are verified before it is used;
/// the file is then read in place.
namespace echinus {

/// The versions that load_map() reads. Files are written in the older version if possible: only maps with an
/// origin (ExactMapView::origin) need the newer version, since an older reader would misplace them.
inline constexpr std::uint32_t kMapFileVersion = 2, kMapFileVersionWithoutOrigin = 1;

/// Optional notes in the file of a map. They are not part of the map: without notes, the same map gives the
/// same bytes.
struct MapFileNotes {
    std::optional<double> build_milliseconds; ///< the duration of the build on the machine that made the map
};

/// Writes a map file. It is written under a temporary name in the target's folder and then renamed: a failure
/// leaves no partial file and keeps the old one, and programs that have mapped the old file keep it. The same
/// map and notes give the same bytes.
/// @throws Error Unwritable if the file cannot be written, or the map exceeds the 2 GiB limit of a map file
void save(const AnyMap& map, const std::filesystem::path& path, const MapFileNotes& notes = {});

/// The bytes that save() writes.
/// @throws Error Unwritable when the map exceeds the 2 GiB limit of a map file
std::vector<std::byte> serialise(const AnyMap& map, const MapFileNotes& notes = {});

/// Loads a map file. The file is mapped into memory and read in place; the map keeps the mapping alive. The
/// cost is one pass over the arrays to check them. While the file is mapped, it may be removed or replaced,
/// as save() does, but it must not be overwritten in place.
/// @throws Error Unreadable, WrongFormat (not a map file), UnsupportedVersion or Damaged; the message begins
/// with the path
AnyMap load_map(const std::filesystem::path& path);

/// Loads a map from bytes in memory, which must stay unchanged as long as `storage` exists; the map keeps
/// `storage` alive.
/// @pre bytes.data() is aligned to 8 bytes
/// @throws Error WrongFormat, UnsupportedVersion or Damaged; the message begins with `name`
AnyMap load_map(std::span<const std::byte> bytes, std::shared_ptr<const void> storage,
                const std::string& name);

/// load_map() for a file that must hold this kind of map.
/// @throws Error as load_map() does, and WrongFormat for a map of the other kind
DistanceMap load_distance_map(const std::filesystem::path& path);
ExactMap load_exact_map(const std::filesystem::path& path);

/// The notes of a map file.
/// @throws Error as load_map() does, except for faults in the map itself, which is not read
MapFileNotes load_map_file_notes(const std::filesystem::path& path);

/// Does the file begin like a map file? The result is also false if the file cannot be read.
bool is_map_file(const std::filesystem::path& path) noexcept;

} // namespace echinus

ECHINUS_EXPORT_END
