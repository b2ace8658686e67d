#include "files/atomic_file.hpp"

#include <echinus/error.hpp>
#include <echinus/map_file.hpp>

#include <map_generated.h>

#include <bit>
#include <cstring>

namespace echinus {

static_assert(std::endian::native == std::endian::little, "map files are little-endian and used in place");

namespace {

using Builder = flatbuffers::FlatBufferBuilder;

/// FlatBuffers counts bytes in 31 bits; all but the arrays is a few hundred bytes.
void require_file_size(const DistanceMapView& map) {
    constexpr std::size_t kRoomForTheRest = 4096;
    if (map.byte_count() <= FLATBUFFERS_MAX_BUFFER_SIZE - kRoomForTheRest) return;
    throw Error(ErrorCode::Unwritable, "the map has " + std::to_string(map.byte_count()) +
                                           " bytes, more than the 2 GiB that a map file can hold; build it "
                                           "with fewer directions or 16-bit entries");
}

template <typename T>
flatbuffers::Offset<flatbuffers::Vector<T>> write_array(Builder& builder, std::span<const T> array) {
    if (array.empty()) return {};
    return builder.CreateVector(array.data(), array.size());
}

flatbuffers::Offset<schema::DistanceMapStatistics> write_statistics(Builder& builder,
                                                                    const DistanceMapStatistics& statistics) {
    return schema::CreateDistanceMapStatistics(builder, statistics.face_count, statistics.dropped_faces,
                                               statistics.max_entries, statistics.corrected_entries,
                                               statistics.clamped_entries, statistics.wrong_parity_share);
}

flatbuffers::Offset<schema::DistanceMap> write_map(Builder& builder, const DistanceMap& map) {
    const DistanceMapView& view = map.view();
    // FlatBuffers are built from the back. The offsets go first because they need no padding behind them: so
    // the last byte of the file is one that is needed, and every truncation is noticed.
    const auto entry_offsets = write_array(builder, view.entry_offsets);
    const auto entries_float32 = write_array(builder, view.entries_float32);
    const auto entries_unorm16 = write_array(builder, view.entries_unorm16);
    const auto statistics = write_statistics(builder, map.statistics());
    const schema::Point centre(view.centre.x, view.centre.y, view.centre.z);
    return schema::CreateDistanceMap(builder, &centre, view.radius, view.longitude_count,
                                     view.colatitude_count, schema::PoleAxis(view.pole_axis),
                                     schema::EntryFormat(view.entry_format),
                                     schema::VertexCorrection(view.correction), view.centre_inside,
                                     entry_offsets, entries_float32, entries_unorm16, statistics);
}

flatbuffers::Offset<schema::Notes> write_notes(Builder& builder, const MapFileNotes& notes) {
    if (!notes.build_milliseconds) return {};
    return schema::CreateNotes(builder, *notes.build_milliseconds);
}

} // namespace

std::vector<std::byte> serialise(const DistanceMap& map, const MapFileNotes& notes) {
    require_file_size(map.view());
    Builder builder;
    const auto body = write_map(builder, map);
    const auto file =
        schema::CreateMapFile(builder, kMapFileVersion, map.source_hash(), schema::Map::DistanceMap,
                              body.Union(), write_notes(builder, notes));
    schema::FinishMapFileBuffer(builder, file);
    const auto* first = reinterpret_cast<const std::byte*>(builder.GetBufferPointer());
    return {first, first + builder.GetSize()};
}

void save(const DistanceMap& map, const std::filesystem::path& path, const MapFileNotes& notes) {
    const std::vector<std::byte> bytes = serialise(map, notes);
    AtomicFile file(path);
    file.write(bytes.data(), bytes.size());
    file.commit();
}

} // namespace echinus
