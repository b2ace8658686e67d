#include "files/mapped_file.hpp"
#include "map_file/validate.hpp"

#include <echinus/error.hpp>
#include <echinus/map_file.hpp>

#include <map_generated.h>

#include <bit>
#include <cmath>
#include <fstream>
#include <string_view>

namespace echinus {

static_assert(std::endian::native == std::endian::little, "map files are little-endian and used in place");

namespace {

// The schema's enumerators are those of the public header, so that a value can be taken as it is.
template <typename Stored, typename Ours>
constexpr bool same_value(Stored stored, Ours ours) {
    return static_cast<int>(stored) == static_cast<int>(ours);
}
static_assert(same_value(schema::PoleAxis::X, PoleAxis::X) && same_value(schema::PoleAxis::Y, PoleAxis::Y) &&
              same_value(schema::PoleAxis::Z, PoleAxis::Z));
static_assert(same_value(schema::EntryFormat::Float32, EntryFormat::Float32) &&
              same_value(schema::EntryFormat::Unorm16, EntryFormat::Unorm16));
static_assert(same_value(schema::VertexCorrection::None, VertexCorrection::None) &&
              same_value(schema::VertexCorrection::Paper, VertexCorrection::Paper) &&
              same_value(schema::VertexCorrection::Signed, VertexCorrection::Signed));

/// Bytes 0 to 3 tell where the root table lies, 4 to 7 are "ECHM".
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
                                        std::to_string(byte_count) +
                                        " bytes contradict each other in structure" + kBuildAgain);
}

void require_map_file(std::span<const std::byte> bytes, const std::string& name) {
    if (bytes.size() >= kHeaderSize && begins_like_a_map_file(bytes.data())) return;
    throw Error(ErrorCode::WrongFormat,
                name + ": not a map file: " + (bytes.empty() ? "it is empty" : "bytes 4 to 7 are not ECHM") +
                    "; echinus build makes one from a mesh");
}

void require_known_version(const schema::AnyVersion& file, const std::string& name) {
    if (file.version() == kMapFileVersion) return;
    throw Error(ErrorCode::UnsupportedVersion,
                name + ": a map file of version " + std::to_string(file.version()) +
                    ", but this library reads version " + std::to_string(kMapFileVersion) + kBuildAgain);
}

/// The root table, once structure and version are known to be sound.
const schema::MapFile& verified_root(std::span<const std::byte> bytes, const std::string& name) {
    require_map_file(bytes, name);
    const bool too_large = bytes.size() >= FLATBUFFERS_MAX_BUFFER_SIZE;
    // Another version may have another structure, so its number comes first.
    if (too_large || !has_sound_structure<schema::AnyVersion>(bytes)) fail_structure(name, bytes.size());
    require_known_version(*flatbuffers::GetRoot<schema::AnyVersion>(bytes.data()), name);
    if (!has_sound_structure<schema::MapFile>(bytes)) fail_structure(name, bytes.size());
    return *schema::GetMapFile(bytes.data());
}

const schema::DistanceMap& require_distance_map(const schema::MapFile& file, const std::string& name) {
    if (file.map_type() != schema::Map::NONE && file.map_type() != schema::Map::DistanceMap) {
        throw Error(ErrorCode::UnsupportedVersion, name + ": a map of the unknown kind " +
                                                       std::to_string(int(file.map_type())) +
                                                       ", which this library does not read" + kBuildAgain);
    }
    const schema::DistanceMap* map = file.map_as_DistanceMap();
    if (map == nullptr) throw Error(ErrorCode::Damaged, name + ": the file holds no map" + kBuildAgain);
    return *map;
}

template <typename T>
std::span<const T> array_view(const flatbuffers::Vector<T>* array) {
    if (array == nullptr) return {};
    return {reinterpret_cast<const T*>(array->Data()), array->size()};
}

DistanceMapView read_view(const schema::DistanceMap& map) {
    DistanceMapView view;
    view.centre = {map.centre()->x(), map.centre()->y(), map.centre()->z()};
    view.radius = map.radius();
    view.longitude_count = map.longitude_count();
    view.colatitude_count = map.colatitude_count();
    view.pole_axis = PoleAxis(map.pole_axis());
    view.entry_format = EntryFormat(map.entry_format());
    view.correction = VertexCorrection(map.vertex_correction());
    view.centre_inside = map.centre_inside();
    view.entry_offsets = array_view(map.entry_offsets());
    view.entries_float32 = array_view(map.entries_float32());
    view.entries_unorm16 = array_view(map.entries_unorm16());
    return view;
}

DistanceMapStatistics read_statistics(const schema::DistanceMapStatistics& stored) {
    DistanceMapStatistics statistics;
    statistics.face_count = stored.face_count();
    statistics.dropped_faces = stored.dropped_faces();
    statistics.max_entries = stored.max_entries();
    statistics.corrected_entries = stored.corrected_entries();
    statistics.clamped_entries = stored.clamped_entries();
    statistics.wrong_parity_share = stored.wrong_parity_share();
    return statistics;
}

} // namespace

DistanceMap load_distance_map(std::span<const std::byte> bytes, std::shared_ptr<const void> storage,
                              const std::string& name) {
    const schema::MapFile& file = verified_root(bytes, name);
    const schema::DistanceMap& map = require_distance_map(file, name);
    const DistanceMapView view = read_view(map);
    const DistanceMapStatistics statistics = read_statistics(*map.statistics());
    validate(view, statistics, name);
    return {view, statistics, file.source_hash(), std::move(storage)};
}

DistanceMap load_distance_map(const std::filesystem::path& path) {
    const auto file = std::make_shared<const MappedFile>(path);
    return load_distance_map(file->bytes(), file, path.string());
}

MapFileNotes load_map_file_notes(const std::filesystem::path& path) {
    const MappedFile file(path);
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
