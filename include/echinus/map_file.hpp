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

/// Map files (docs/file_format.md). A file is verified before use, in structure and in meaning, and then read
/// in place.
namespace echinus {

inline constexpr std::uint32_t kMapFileVersion = 1;

/// What may be noted beside a map. It is not part of the map: with no notes, the same map gives the same
/// bytes.
struct MapFileNotes {
    std::optional<double> build_milliseconds; ///< how long the build took on the machine that did it
};

/// Writes to a temporary name beside the target and renames: a failure leaves no partial file and the old one
/// whole, also for those who have it mapped. The same map and notes give the same bytes.
/// @throws Error Unwritable; also when the map is larger than the 2 GiB that a map file can hold
void save(const AnyMap& map, const std::filesystem::path& path, const MapFileNotes& notes = {});

/// The bytes that save() writes.
/// @throws Error Unwritable when the map is larger than the 2 GiB that a map file can hold
std::vector<std::byte> serialise(const AnyMap& map, const MapFileNotes& notes = {});

/// Maps the file into memory and reads it in place; the map keeps the mapping. Cost: one pass over the arrays
/// to check them. The file may be replaced or removed while it is mapped, as save() does, but must not be
/// overwritten in place.
/// @throws Error Unreadable, WrongFormat (not a map file), UnsupportedVersion or Damaged; the sentence begins
/// with the path
AnyMap load_map(const std::filesystem::path& path);

/// The same from bytes in memory. They must stay unchanged as long as `storage` lives, which the map keeps
/// alive.
/// @pre bytes.data() is a multiple of 8
/// @throws Error as above; the sentence begins with `name`
AnyMap load_map(std::span<const std::byte> bytes, std::shared_ptr<const void> storage,
                const std::string& name);

/// load_map() for those who need this kind.
/// @throws Error as above, and WrongFormat for a map of another kind
DistanceMap load_distance_map(const std::filesystem::path& path);
ExactMap load_exact_map(const std::filesystem::path& path);

/// The notes of a map file.
/// @throws Error as load_map(), except that it does not look at the map
MapFileNotes load_map_file_notes(const std::filesystem::path& path);

/// Does the file begin like a map file? False also when it cannot be read.
bool is_map_file(const std::filesystem::path& path) noexcept;

} // namespace echinus

ECHINUS_EXPORT_END
