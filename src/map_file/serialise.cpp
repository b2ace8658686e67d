#include "files/atomic_file.hpp"
#include "map_file/tables.hpp"

#include <echinus/error.hpp>
#include <echinus/map_file.hpp>

#include <map_generated.h>

namespace echinus {

namespace {

using Builder = flatbuffers::FlatBufferBuilder;

/// FlatBuffers counts bytes in 31 bits; everything except the arrays takes only a few hundred bytes.
void require_file_size(std::size_t byte_count) {
    constexpr std::size_t kRoomForTheRest = 4096;
    if (byte_count <= FLATBUFFERS_MAX_BUFFER_SIZE - kRoomForTheRest) return;
    throw Error(ErrorCode::Unwritable, "the map has " + std::to_string(byte_count) +
                                           " bytes, more than the 2 GiB that a map file can hold; build it "
                                           "with fewer directions or cells");
}

constexpr schema::Map type_of(const DistanceMap&) {
    return schema::Map::DistanceMap;
}
constexpr schema::Map type_of(const ExactMap&) {
    return schema::Map::ExactMap;
}

flatbuffers::Offset<schema::Notes> write_notes(Builder& builder, const MapFileNotes& notes) {
    if (!notes.build_milliseconds) return {};
    return schema::CreateNotes(builder, *notes.build_milliseconds);
}

template <typename Kind>
std::vector<std::byte> serialise_kind(const Kind& map, const MapFileNotes& notes) {
    require_file_size(map.view().byte_count());
    Builder builder;
    const auto body = write_table(builder, map);
    const std::uint32_t version = has_origin(map) ? kMapFileVersion : kMapFileVersionWithoutOrigin;
    const auto file = schema::CreateMapFile(builder, version, map.source_hash(), type_of(map), body.Union(),
                                            write_notes(builder, notes));
    schema::FinishMapFileBuffer(builder, file);
    const auto* first = reinterpret_cast<const std::byte*>(builder.GetBufferPointer());
    return {first, first + builder.GetSize()};
}

} // namespace

std::vector<std::byte> serialise(const AnyMap& map, const MapFileNotes& notes) {
    return std::visit([&](const auto& kind) { return serialise_kind(kind, notes); }, map);
}

void save(const AnyMap& map, const std::filesystem::path& path, const MapFileNotes& notes) {
    const std::vector<std::byte> bytes = serialise(map, notes);
    AtomicFile file(path);
    file.write(bytes.data(), bytes.size());
    file.commit();
}

} // namespace echinus
