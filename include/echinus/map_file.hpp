#pragma once

#include <echinus/distance_map.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

/// Map files (docs/file_format.md). A file is verified before use, in structure and in meaning, and then read
/// in place.
namespace echinus {

inline constexpr std::uint32_t kMapFileVersion = 1;

/// Writes to a temporary name beside the target and renames: a failure leaves no partial file and the old one
/// whole. The same map gives the same bytes.
/// @throws Error Unwritable
void save(const DistanceMap& map, const std::filesystem::path& path);

/// The bytes that save() writes.
std::vector<std::byte> serialise(const DistanceMap& map);

/// Maps the file into memory and reads it in place; the map keeps it open. Cost: one pass over the arrays to
/// check them.
/// @throws Error Unreadable, WrongFormat (not a map file), UnsupportedVersion or Damaged; the sentence begins
/// with the path
DistanceMap load_distance_map(const std::filesystem::path& path);

/// The same from bytes in memory. `bytes` must start at an address that is a multiple of 8 and stay unchanged
/// as long as `storage` lives, which the map keeps alive.
/// @throws Error as above; the sentence begins with `name`
DistanceMap load_distance_map(std::span<const std::byte> bytes, std::shared_ptr<const void> storage,
                              const std::string& name);

/// Does the file begin like a map file? False also when it cannot be read.
bool is_map_file(const std::filesystem::path& path) noexcept;

} // namespace echinus
