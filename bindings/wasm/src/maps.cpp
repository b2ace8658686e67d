// Maps of both kinds: build, save, load, query.

#include "interface.hpp"

#include <echinus/any_map.hpp>
#include <echinus/map_file.hpp>
#include <echinus_scene/scene.hpp>

#include <cstddef>
#include <cstring>
#include <memory>
#include <vector>

namespace echinus::wasm {

// The memory layout of a contact that js/buffers.mjs assumes.
static_assert(sizeof(Contact) == 36 && offsetof(Contact, point) == 0 && offsetof(Contact, normal) == 12 &&
              offsetof(Contact, depth) == 24 && offsetof(Contact, face) == 28 &&
              offsetof(Contact, inside) == 32 && offsetof(Contact, certain) == 33 &&
              offsetof(Contact, feature) == 34);
static_assert(sizeof(SweepHit) == 36 && offsetof(SweepHit, point) == 4 && offsetof(SweepHit, normal) == 16 &&
              offsetof(SweepHit, face) == 28 && offsetof(SweepHit, entering) == 32);

namespace {

const char* const kGridNames[] = {"spherical", "octahedral", "cube", "ellipsoidal"};
const char* const kCorrectionNames[] = {"none", "paper", "signed"};
const char* const kEntryNames[] = {"float32", "unorm16"};
const char* const kAxisNames[] = {"x", "y", "z"};

std::string as_hex(std::uint64_t number) {
    std::string digits(16, '0');
    for (std::size_t i = 16; i-- > 0; number >>= 4) digits[i] = "0123456789abcdef"[number & 15];
    return digits;
}

json describe(const DistanceMap& map) {
    const DistanceMapView& view = map.view();
    const DistanceMapStatistics& statistics = map.statistics();
    return {{"kind", "distance"},
            {"grid", kGridNames[static_cast<int>(view.grid)]},
            {"longitudeCount", view.longitude_count},
            {"colatitudeCount", view.colatitude_count},
            {"divisions", view.divisions},
            {"poleAxis", kAxisNames[static_cast<int>(view.pole_axis)]},
            {"entryFormat", kEntryNames[static_cast<int>(view.entry_format)]},
            {"correction", kCorrectionNames[static_cast<int>(view.correction)]},
            {"centreInside", view.centre_inside},
            {"directionCount", view.direction_count()},
            {"entryCount", view.entry_count()},
            {"entryHistogram", entry_histogram(view)},
            {"faceCount", statistics.face_count},
            {"droppedFaces", statistics.dropped_faces},
            {"maxEntries", statistics.max_entries},
            {"correctedEntries", statistics.corrected_entries},
            {"clampedEntries", statistics.clamped_entries},
            {"wrongParityShare", statistics.wrong_parity_share}};
}

json describe(const ExactMap& map) {
    const ExactMapView& view = map.view();
    const ExactMapStatistics& statistics = map.statistics();
    return {{"kind", "exact"},
            {"divisions", view.divisions},
            {"rule", view.rule == InsideRule::Nonzero ? "nonzero" : "parity"},
            {"closed", view.border.empty()},
            {"cellCount", view.cell_count()},
            {"bandCount", view.bands.size() - 1},
            {"referenceCount", view.references.size()},
            {"faceCount", statistics.face_count},
            {"droppedFaces", statistics.dropped_faces},
            {"longestList", statistics.longest_list},
            {"meanList", statistics.mean_list},
            {"expectedTests", statistics.expected_tests},
            {"certainShare", statistics.certain_share},
            {"uncertainDirections", statistics.uncertain_directions}};
}

template <typename Kind>
json describe_with_frame(const Kind& map) {
    json description = describe(map);
    const auto& view = map.view();
    description["centre"] = {view.centre.x, view.centre.y, view.centre.z};
    description["origin"] = {view.origin.x, view.origin.y, view.origin.z};
    description["radius"] = view.radius;
    description["byteCount"] = view.byte_count();
    description["sourceHash"] = as_hex(map.source_hash());
    return description;
}

StridedSpan<const Vec3f> points_at(const float* first, std::uint32_t count) {
    return {reinterpret_cast<const Vec3f*>(first), count};
}

} // namespace

/// @param options  JSON, as under `map` in a scene
ECHINUS_EXPORT(map_build)
AnyMap* map_build(const TriangleMesh* mesh, const char* options, std::uint32_t size) {
    return make_handle(
        [&] { return build_map(*mesh, parse_map_options(text_at(options, size), "the map's options")); });
}

/// The bytes are copied: the map reads its arrays in place.
ECHINUS_EXPORT(map_load)
AnyMap* map_load(const std::byte* bytes, std::uint32_t byte_count, const char* name,
                 std::uint32_t name_size) {
    return make_handle([&] {
        // Eight bytes at a time for the alignment that load_map() requires.
        auto storage = std::make_shared<std::vector<std::uint64_t>>((std::size_t{byte_count} + 7) / 8);
        if (byte_count != 0) std::memcpy(storage->data(), bytes, byte_count);
        const std::span own(reinterpret_cast<const std::byte*>(storage->data()), byte_count);
        return load_map(own, storage, std::string(text_at(name, name_size)));
    });
}

ECHINUS_EXPORT(map_serialise) std::vector<std::byte>* map_serialise(const AnyMap* map) {
    return make_handle([&] { return serialise(*map); });
}
ECHINUS_EXPORT(bytes_first) const std::byte* bytes_first(const std::vector<std::byte>* bytes) {
    return bytes->data();
}
ECHINUS_EXPORT(bytes_size) std::uint32_t bytes_size(const std::vector<std::byte>* bytes) {
    return static_cast<std::uint32_t>(bytes->size());
}
ECHINUS_EXPORT(bytes_delete) void bytes_delete(std::vector<std::byte>* bytes) {
    delete bytes;
}

ECHINUS_EXPORT(map_is_exact) bool map_is_exact(const AnyMap* map) {
    return std::holds_alternative<ExactMap>(*map);
}
ECHINUS_EXPORT(map_describe) Text* map_describe(const AnyMap* map) {
    return make_json(
        [&] { return std::visit([](const auto& kind) { return describe_with_frame(kind); }, *map); });
}
ECHINUS_EXPORT(map_delete) void map_delete(AnyMap* map) {
    delete map;
}

// ---- Queries. Nothing here fails, and nothing is copied.

ECHINUS_EXPORT(map_contains) bool map_contains(const AnyMap* map, float x, float y, float z) {
    return contains(*map, {x, y, z});
}
ECHINUS_EXPORT(map_contact)
void map_contact(const AnyMap* map, float x, float y, float z, float margin, Contact* result) {
    *result = contact(*map, {x, y, z}, margin);
}
ECHINUS_EXPORT(map_contains_batch)
void map_contains_batch(const AnyMap* map, const float* points, std::uint32_t count, std::uint8_t* inside) {
    contains_batch(*map, points_at(points, count), {inside, count});
}
ECHINUS_EXPORT(map_contacts_batch)
void map_contacts_batch(const AnyMap* map, const float* points, std::uint32_t count, float margin,
                        Contact* contacts) {
    contacts_batch(*map, points_at(points, count), margin, {contacts, count});
}

/// Of an exact map. Bit 0: inside, bit 1: certain.
ECHINUS_EXPORT(map_classify) std::uint32_t map_classify(const AnyMap* map, float x, float y, float z) {
    const Containment answer = classify(std::get<ExactMap>(*map), {x, y, z});
    return (answer.inside ? 1U : 0U) | (answer.certain ? 2U : 0U);
}
/// Of an exact map.
ECHINUS_EXPORT(map_sweep)
void map_sweep(const AnyMap* map, float from_x, float from_y, float from_z, float to_x, float to_y,
               float to_z, SweepHit* result) {
    *result = sweep(std::get<ExactMap>(*map), {from_x, from_y, from_z}, {to_x, to_y, to_z});
}
/// Of a distance map.
ECHINUS_EXPORT(map_usable_sample_count)
int map_usable_sample_count(const AnyMap* map, float x, float y, float z) {
    return usable_sample_count(std::get<DistanceMap>(*map), {x, y, z});
}

} // namespace echinus::wasm
