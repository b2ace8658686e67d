#include "directions/checker.hpp"
#include "files/read_file.hpp"
#include "map_file/tables.hpp"

#include <echinus/error.hpp>
#include <echinus/map_file.hpp>

#include <map_generated.h>

#include <cmath>
#include <fstream>
#include <string_view>
#include <utility>

namespace echinus {

namespace {

/// Bytes 0 to 3 are the root table's offset, 4 to 7 are "ECHM".
constexpr std::size_t kHeaderSize = sizeof(flatbuffers::uoffset_t) + flatbuffers::kFileIdentifierLength;

bool begins_like_a_map_file(const void* header) {
    return flatbuffers::BufferHasIdentifier(header, schema::MapFileIdentifier());
}

template <typename Table>
bool has_sound_structure(std::span<const std::byte> bytes) {
    flatbuffers::Verifier verifier(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    return verifier.VerifyBuffer<Table>(schema::MapFileIdentifier());
}

[[noreturn]] void fail_structure(const std::string& name, std::size_t byte_count) {
    throw Error(ErrorCode::Damaged, name + ": the map file is truncated or damaged: its " +
                                        std::to_string(byte_count) + " bytes have an inconsistent structure" +
                                        kBuildAgain);
}

void require_map_file(std::span<const std::byte> bytes, const std::string& name) {
    if (bytes.size() >= kHeaderSize && begins_like_a_map_file(bytes.data())) return;
    throw Error(ErrorCode::WrongFormat,
                name + ": not a map file: " + (bytes.empty() ? "it is empty" : "bytes 4 to 7 are not ECHM") +
                    "; echinus build makes one from a mesh");
}

void require_known_version(const schema::AnyVersion& file, const std::string& name) {
    if (file.version() == kMapFileVersion || file.version() == kMapFileVersionWithoutOrigin) return;
    throw Error(ErrorCode::UnsupportedVersion,
                name + ": a map file of version " + std::to_string(file.version()) +
                    ", but this library reads versions " + std::to_string(kMapFileVersionWithoutOrigin) +
                    " and " + std::to_string(kMapFileVersion) + kBuildAgain);
}

/// A map must have an origin if its version requires one, and otherwise must not have one.
void require_origin(const schema::Origin* origin, bool wanted, const std::string& name) {
    const Vec3d place = from_stored(origin);
    if (!wanted && origin != nullptr) Checker(name).fail("it has an origin, which its version does not have");
    if (wanted && (place == Vec3d{} || !is_finite(place)))
        Checker(name).fail("its origin is missing, 0 or not finite");
}

/// The root table, after its structure and version were checked.
const schema::MapFile& verified_root(std::span<const std::byte> bytes, const std::string& name) {
    require_map_file(bytes, name);
    const bool too_large = bytes.size() >= FLATBUFFERS_MAX_BUFFER_SIZE;
    // Another version may have a different structure, so its number is checked first.
    if (too_large || !has_sound_structure<schema::AnyVersion>(bytes)) fail_structure(name, bytes.size());
    require_known_version(*flatbuffers::GetRoot<schema::AnyVersion>(bytes.data()), name);
    if (!has_sound_structure<schema::MapFile>(bytes)) fail_structure(name, bytes.size());
    return *schema::GetMapFile(bytes.data());
}

CheckBeginning check_beginning_of(const std::filesystem::path& path) {
    return
        [name = path.string()](std::span<const std::byte> beginning) { require_map_file(beginning, name); };
}

/// The command line's name for a kind of map.
constexpr const char* name_of(const DistanceMap*) {
    return "distance";
}
constexpr const char* name_of(const ExactMap*) {
    return "exact";
}

/// The map, if it is of this kind.
template <typename Kind>
Kind require_kind(const AnyMap& map, const std::string& name) {
    if (const Kind* kind = std::get_if<Kind>(&map)) return *kind;
    const std::string found = std::visit([](const auto& other) { return name_of(&other); }, map);
    const std::string wanted = name_of(static_cast<const Kind*>(nullptr));
    throw Error(ErrorCode::WrongFormat, name + ": the map is of the kind " + found + " and not " + wanted +
                                            "; echinus build --kind " + wanted + " makes one from a mesh");
}

} // namespace

AnyMap load_map(std::span<const std::byte> bytes, std::shared_ptr<const void> storage,
                const std::string& name) {
    const schema::MapFile& file = verified_root(bytes, name);
    const bool has_origin = file.version() == kMapFileVersion;
    if (const auto* map = file.map_as_DistanceMap()) {
        require_origin(map->origin(), has_origin, name);
        return read_table(*map, file.source_hash(), std::move(storage), name);
    }
    if (const auto* map = file.map_as_ExactMap()) {
        require_origin(map->origin(), has_origin, name);
        return read_table(*map, file.source_hash(), std::move(storage), name);
    }
    if (file.map_type() > schema::Map::MAX)
        throw Error(ErrorCode::UnsupportedVersion, name + ": a map of the unknown kind " +
                                                       std::to_string(int(file.map_type())) +
                                                       ", which this library does not read" + kBuildAgain);
    throw Error(ErrorCode::Damaged, name + ": the file holds no map" + kBuildAgain);
}

AnyMap load_map(const std::filesystem::path& path) {
    const auto file = std::make_shared<const MappedFile>(path, check_beginning_of(path));
    return load_map(file->bytes(), file, path.string());
}

DistanceMap load_distance_map(const std::filesystem::path& path) {
    return require_kind<DistanceMap>(load_map(path), path.string());
}

ExactMap load_exact_map(const std::filesystem::path& path) {
    return require_kind<ExactMap>(load_map(path), path.string());
}

MapFileNotes load_map_file_notes(const std::filesystem::path& path) {
    const MappedFile file(path, check_beginning_of(path));
    MapFileNotes notes;
    const schema::Notes* stored = verified_root(file.bytes(), path.string()).notes();
    if (stored == nullptr || !stored->build_milliseconds()) return notes;
    const double milliseconds = *stored->build_milliseconds();
    if (!std::isfinite(milliseconds) || milliseconds < 0) {
        throw Error(ErrorCode::Damaged, path.string() + ": the notes are damaged: build_milliseconds is " +
                                            std::to_string(milliseconds) + " and not a finite duration" +
                                            kBuildAgain);
    }
    notes.build_milliseconds = milliseconds;
    return notes;
}

bool is_map_file(const std::filesystem::path& path) noexcept {
    char header[kHeaderSize] = {};
    std::ifstream file(path, std::ios::binary);
    return file.read(header, sizeof header) && begins_like_a_map_file(header);
}

} // namespace echinus
