
#include "exact_map/layout.hpp"
#include "map_file/tables.hpp"

#include <cstdint>
#include <utility>
#include <vector>

namespace echinus {

static_assert(same_value(schema::InsideRule::Nonzero, InsideRule::Nonzero) &&
              same_value(schema::InsideRule::Parity, InsideRule::Parity));

template <>
struct StoredAs<Vec3<std::int32_t>> {
    using Type = schema::LatticePoint;
};
template <>
struct StoredAs<Band> {
    using Type = schema::Band;
};
template <>
struct StoredAs<TreeNode> {
    using Type = schema::TreeNode;
};
template <>
struct StoredAs<BorderEdge> {
    using Type = schema::BorderEdge;
};

namespace {

ExactMapView read_view(const schema::ExactMap& stored) {
    ExactMapView view;
    view.centre = from_stored(*stored.centre());
    view.radius = stored.radius();
    view.divisions = stored.divisions();
    view.rule = InsideRule(stored.inside_rule());
    read_array(stored.band_offsets(), view.band_offsets);
    read_array(stored.bands(), view.bands);
    read_array(stored.winding_below(), view.winding_below);
    read_array(stored.references16(), view.references.narrow);
    read_array(stored.references32(), view.references.wide);
    read_array(stored.reference_parts(), view.reference_parts);
    read_array(stored.vertices(), view.vertices);
    read_array(stored.corners16(), view.corners.narrow);
    read_array(stored.corners32(), view.corners.wide);
    read_array(stored.face_numbers16(), view.face_numbers.narrow);
    read_array(stored.face_numbers32(), view.face_numbers.wide);
    read_array(stored.nodes(), view.nodes);
    read_array(stored.border(), view.border);
    view.origin = from_stored(stored.origin());
    return view;
}

ExactMapStatistics read_statistics(const schema::ExactMapStatistics& stored) {
    ExactMapStatistics statistics;
    statistics.face_count = stored.face_count();
    statistics.dropped_faces = stored.dropped_faces();
    statistics.longest_list = stored.longest_list();
    statistics.mean_list = stored.mean_list();
    statistics.expected_tests = stored.expected_tests();
    statistics.certain_share = stored.certain_share();
    statistics.uncertain_directions = stored.uncertain_directions();
    return statistics;
}

flatbuffers::Offset<schema::ExactMapStatistics> write_statistics(flatbuffers::FlatBufferBuilder& builder,
                                                                 const ExactMapStatistics& statistics) {
    return schema::CreateExactMapStatistics(builder, statistics.face_count, statistics.dropped_faces,
                                            statistics.longest_list, statistics.mean_list,
                                            statistics.expected_tests, statistics.certain_share,
                                            statistics.uncertain_directions);
}

} // namespace

flatbuffers::Offset<schema::ExactMap> write_table(flatbuffers::FlatBufferBuilder& builder,
                                                  const ExactMap& map) {
    const ExactMapView& view = map.view();
    // The offsets are written first, as in a distance map, so that every truncation is detected.
    const auto band_offsets = write_array(builder, view.band_offsets);
    const auto bands = write_array(builder, view.bands);
    const auto winding_below = write_if_any(builder, view.winding_below);
    const auto references16 = write_if_any(builder, view.references.narrow);
    const auto references32 = write_if_any(builder, view.references.wide);
    const auto reference_parts = write_if_any(builder, view.reference_parts);
    const auto vertices = write_array(builder, view.vertices);
    const auto corners16 = write_if_any(builder, view.corners.narrow);
    const auto corners32 = write_if_any(builder, view.corners.wide);
    const auto face_numbers16 = write_if_any(builder, view.face_numbers.narrow);
    const auto face_numbers32 = write_if_any(builder, view.face_numbers.wide);
    const auto nodes = write_array(builder, view.nodes);
    const auto border = write_if_any(builder, view.border);
    const auto statistics = write_statistics(builder, map.statistics());
    const schema::Point centre = to_stored(view.centre);
    const schema::Origin origin = to_stored(view.origin);
    return schema::CreateExactMap(
        builder, &centre, view.radius, view.divisions, schema::InsideRule(view.rule), band_offsets, bands,
        winding_below, references16, references32, reference_parts, vertices, corners16, corners32,
        face_numbers16, face_numbers32, nodes, border, statistics, has_origin(map) ? &origin : nullptr);
}

ExactMap read_table(const schema::ExactMap& stored, std::uint64_t source_hash,
                    std::shared_ptr<const void> storage, const std::string& name) {
    ExactMapView view = read_view(stored);
    const ExactMapStatistics statistics = read_statistics(*stored.statistics());
    validate(Checker(name), view, statistics);
    struct Kept {
        std::shared_ptr<const void> file;
        std::vector<std::uint16_t> outer_limits;
    };
    const auto kept = std::make_shared<Kept>(Kept{std::move(storage), {}});
    set_outer_limits(view.band_offsets, view.bands,
                     kept->outer_limits); // files omit them, since they follow from the bands
    view.outer_limits = kept->outer_limits;
    return {view, statistics, source_hash, kept};
}

} // namespace echinus
