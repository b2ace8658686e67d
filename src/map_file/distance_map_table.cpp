
#include "distance_map/layout.hpp"
#include "map_file/tables.hpp"

#include <utility>

namespace echinus {

static_assert(same_value(schema::DirectionGrid::Spherical, DirectionGrid::Spherical) &&
              same_value(schema::DirectionGrid::Octahedral, DirectionGrid::Octahedral) &&
              same_value(schema::DirectionGrid::Cube, DirectionGrid::Cube) &&
              same_value(schema::DirectionGrid::Ellipsoidal, DirectionGrid::Ellipsoidal));
static_assert(same_value(schema::PoleAxis::X, PoleAxis::X) && same_value(schema::PoleAxis::Y, PoleAxis::Y) &&
              same_value(schema::PoleAxis::Z, PoleAxis::Z));
static_assert(same_value(schema::EntryFormat::Float32, EntryFormat::Float32) &&
              same_value(schema::EntryFormat::Unorm16, EntryFormat::Unorm16));
static_assert(same_value(schema::VertexCorrection::None, VertexCorrection::None) &&
              same_value(schema::VertexCorrection::Paper, VertexCorrection::Paper) &&
              same_value(schema::VertexCorrection::Signed, VertexCorrection::Signed));

namespace {

DistanceMapView read_view(const schema::DistanceMap& stored) {
    DistanceMapView view;
    view.centre = from_stored(*stored.centre());
    view.radius = stored.radius();
    view.longitude_count = stored.longitude_count();
    view.colatitude_count = stored.colatitude_count();
    view.grid = DirectionGrid(stored.grid());
    view.divisions = stored.divisions();
    if (stored.scale() != nullptr) view.scale = from_stored(*stored.scale());
    view.pole_axis = PoleAxis(stored.pole_axis());
    view.entry_format = EntryFormat(stored.entry_format());
    view.correction = VertexCorrection(stored.vertex_correction());
    view.centre_inside = stored.centre_inside();
    read_array(stored.entry_offsets(), view.entry_offsets);
    read_array(stored.entries_float32(), view.entries_float32);
    read_array(stored.entries_unorm16(), view.entries_unorm16);
    view.origin = from_stored(stored.origin());
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

flatbuffers::Offset<schema::DistanceMapStatistics> write_statistics(flatbuffers::FlatBufferBuilder& builder,
                                                                    const DistanceMapStatistics& statistics) {
    return schema::CreateDistanceMapStatistics(builder, statistics.face_count, statistics.dropped_faces,
                                               statistics.max_entries, statistics.corrected_entries,
                                               statistics.clamped_entries, statistics.wrong_parity_share);
}

} // namespace

flatbuffers::Offset<schema::DistanceMap> write_table(flatbuffers::FlatBufferBuilder& builder,
                                                     const DistanceMap& map) {
    const DistanceMapView& view = map.view();
    // FlatBuffers are built from back to front. The offsets are written first because they need no padding
    // after them: the last byte of the file is then in use, so that every truncation is detected.
    const auto entry_offsets = write_array(builder, view.entry_offsets);
    const auto entries_float32 = write_if_any(builder, view.entries_float32);
    const auto entries_unorm16 = write_if_any(builder, view.entries_unorm16);
    const auto statistics = write_statistics(builder, map.statistics());
    const schema::Point centre = to_stored(view.centre);
    const schema::Point scale = to_stored(view.scale);
    const schema::Origin origin = to_stored(view.origin);
    return schema::CreateDistanceMap(
        builder, &centre, view.radius, view.longitude_count, view.colatitude_count,
        schema::PoleAxis(view.pole_axis), schema::EntryFormat(view.entry_format),
        schema::VertexCorrection(view.correction), view.centre_inside, entry_offsets, entries_float32,
        entries_unorm16, statistics, schema::DirectionGrid(view.grid), view.divisions,
        view.grid == DirectionGrid::Ellipsoidal ? &scale : nullptr, has_origin(map) ? &origin : nullptr);
}

DistanceMap read_table(const schema::DistanceMap& stored, std::uint64_t source_hash,
                       std::shared_ptr<const void> storage, const std::string& name) {
    const DistanceMapView view = read_view(stored);
    const DistanceMapStatistics statistics = read_statistics(*stored.statistics());
    validate(Checker(name), view, statistics);
    return {view, statistics, source_hash, std::move(storage)};
}

} // namespace echinus
