#include "commands/descriptions.hpp"

#include <fmt/format.h>

#include <cmath>

using echinus::DistanceMap, echinus::DistanceMapView, echinus::ExactMap, echinus::ExactMapView,
    echinus::Vec3d;

namespace {

const char* name_of(echinus::PoleAxis axis) {
    return axis == echinus::PoleAxis::X ? "x" : axis == echinus::PoleAxis::Y ? "y" : "z";
}

const char* name_of(echinus::DirectionGrid grid) {
    constexpr const char* kNames[] = {"spherical", "octahedral", "cube", "ellipsoidal"};
    return kNames[static_cast<std::size_t>(grid)];
}

const char* name_of(echinus::EntryFormat format) {
    return format == echinus::EntryFormat::Float32 ? "float32" : "unorm16";
}

const char* name_of(echinus::VertexCorrection correction) {
    using echinus::VertexCorrection;
    if (correction == VertexCorrection::None) return "none";
    return correction == VertexCorrection::Paper ? "paper" : "signed";
}

const char* name_of(echinus::InsideRule rule) {
    return rule == echinus::InsideRule::Nonzero ? "nonzero" : "parity";
}

/// The bytes of an exact map, by purpose.
struct ExactMapBytes {
    std::size_t bands, references, mesh, tree;

    explicit ExactMapBytes(const ExactMapView& map)
        : bands(map.band_offsets.size_bytes() + map.bands.size_bytes() + map.winding_below.size_bytes()),
          references(map.references.size_bytes() + map.reference_parts.size_bytes()),
          mesh(map.vertices.size_bytes() + map.corners.size_bytes() + map.face_numbers.size_bytes() +
               map.border.size_bytes()),
          tree(map.nodes.size_bytes()) {}
};

std::string directions_text(const DistanceMapView& map) {
    if (!has_poles(map.grid))
        return fmt::format("{}, edges of the {} cut into {}", map.direction_count(),
                           map.grid == echinus::DirectionGrid::Cube ? "cube" : "octahedron", map.divisions);
    std::string text = fmt::format("{} x {} = {}, poles on {}", map.longitude_count, map.colatitude_count,
                                   map.direction_count(), name_of(map.pole_axis));
    if (map.grid == echinus::DirectionGrid::Ellipsoidal)
        text +=
            fmt::format(", axes scaled by {:.3f}, {:.3f} and {:.3f}", map.scale.x, map.scale.y, map.scale.z);
    return text;
}

double mean_entries(const DistanceMapView& map) {
    return static_cast<double>(map.entry_count()) / static_cast<double>(map.direction_count());
}

/// One line for each number of entries, with the number of directions that have it.
std::string histogram_text(const DistanceMapView& map) {
    constexpr double kBarWidth = 40;
    const auto direction_count = static_cast<double>(map.direction_count());
    std::string text = "  entries  directions\n";
    const std::vector<std::size_t> histogram = echinus::entry_histogram(map);
    for (std::size_t entries = 0; entries < histogram.size(); ++entries) {
        if (histogram[entries] == 0) continue;
        const double share = static_cast<double>(histogram[entries]) / direction_count;
        const std::string bar(static_cast<std::size_t>(std::lround(share * kBarWidth)), '#');
        text +=
            fmt::format("  {:>7}  {:>10}  {:5.1f} %  {}\n", entries, histogram[entries], share * 100, bar);
    }
    return text;
}

// ---- Specific to each kind ----

const char* name_of(const DistanceMap&) {
    return "distance";
}
const char* name_of(const ExactMap&) {
    return "exact";
}

bool is_centre_inside(const DistanceMap& map) {
    return map.view().centre_inside;
}
bool is_centre_inside(const ExactMap& map) {
    return classify(map, map.view().centre).inside;
}

void add_own_keys(Json& object, const DistanceMap& map) {
    const DistanceMapView& view = map.view();
    const echinus::DistanceMapStatistics& statistics = map.statistics();
    object.add("directions", view.direction_count());
    object.add("grid", name_of(view.grid));
    if (has_poles(view.grid)) {
        object.add("longitude_count", view.longitude_count);
        object.add("colatitude_count", view.colatitude_count);
        object.add("pole", name_of(view.pole_axis));
        if (view.grid == echinus::DirectionGrid::Ellipsoidal)
            object.add("scale", {view.scale.x, view.scale.y, view.scale.z});
    } else {
        object.add("divisions", view.divisions);
    }
    object.add("correction", name_of(view.correction));
    object.add("entry_format", name_of(view.entry_format));
    object.add("entries", view.entry_count());
    object.add("max_entries", statistics.max_entries);
    object.add("mean_entries", mean_entries(view));
    object.add("entry_histogram", echinus::entry_histogram(view));
    object.add("offset_bytes", view.entry_offsets.size_bytes());
    object.add("entry_bytes", view.byte_count() - view.entry_offsets.size_bytes());
    object.add("wrong_parity_share", statistics.wrong_parity_share);
    object.add("corrected_entries", statistics.corrected_entries);
    object.add("clamped_entries", statistics.clamped_entries);
}

void add_own_keys(Json& object, const ExactMap& map) {
    const ExactMapView& view = map.view();
    const echinus::ExactMapStatistics& statistics = map.statistics();
    const ExactMapBytes bytes(view);
    object.add("cells", view.cell_count());
    object.add("divisions", view.divisions);
    object.add("rule", name_of(view.rule));
    object.add("bands", view.winding_below.size());
    object.add("references", view.references.size());
    object.add("longest_list", statistics.longest_list);
    object.add("mean_list", statistics.mean_list);
    object.add("expected_tests", statistics.expected_tests);
    object.add("certain_share", statistics.certain_share);
    object.add("uncertain_directions", statistics.uncertain_directions);
    object.add("border_edges", view.border.size());
    object.add("band_bytes", bytes.bands);
    object.add("reference_bytes", bytes.references);
    object.add("mesh_bytes", bytes.mesh);
    object.add("tree_bytes", bytes.tree);
}

void add_own_rows(Table& table, const DistanceMap& map) {
    const DistanceMapView& view = map.view();
    const echinus::DistanceMapStatistics& statistics = map.statistics();
    const std::size_t offset_bytes = view.entry_offsets.size_bytes();
    table.add("directions", directions_text(view));
    table.add("entries",
              fmt::format("{} as {}; per direction {:.3f} on average, {} at most", view.entry_count(),
                          name_of(view.entry_format), mean_entries(view), statistics.max_entries));
    table.add("vertex correction",
              fmt::format("{}: {} entries moved, {} of them cut short", name_of(view.correction),
                          statistics.corrected_entries, statistics.clamped_entries));
    table.add("wrong parity", fmt::format("{:.3f} % of the directions, through holes of the mesh",
                                          statistics.wrong_parity_share * 100));
    table.add("bytes", fmt::format("{} ({} offsets, {} entries)", view.byte_count(), offset_bytes,
                                   view.byte_count() - offset_bytes));
}

void add_own_rows(Table& table, const ExactMap& map) {
    const ExactMapView& view = map.view();
    const echinus::ExactMapStatistics& statistics = map.statistics();
    const ExactMapBytes bytes(view);
    table.add("inside",
              view.rule == echinus::InsideRule::Nonzero ? "winding number not zero" : "winding number odd");
    table.add("cells", fmt::format("{} = 8 x {} x {}", view.cell_count(), view.divisions, view.divisions));
    table.add("bands", fmt::format("{} with {} faces; {:.1f} in a list on average, {} at most",
                                   view.winding_below.size(), view.references.size(), statistics.mean_list,
                                   statistics.longest_list));
    table.add("expected tests",
              fmt::format("{:.1f} faces for a particle on the surface", statistics.expected_tests));
    table.add("certain",
              view.border.empty()
                  ? "everywhere, since the surface is closed on the lattice"
                  : fmt::format("{:.3f} % of the bounding sphere; uncertain answers occur in {:.3f} % of the "
                                "directions; {} border edges",
                                statistics.certain_share * 100, statistics.uncertain_directions * 100,
                                view.border.size()));
    table.add("bytes", fmt::format("{} ({} bands, {} lists, {} mesh, {} tree)", view.byte_count(),
                                   bytes.bands, bytes.references, bytes.mesh, bytes.tree));
}

std::string own_text(const DistanceMap& map) {
    return "\n" + histogram_text(map);
}
std::string own_text(const ExactMap&) {
    return {};
}

// ---- Common to both ----

template <typename Map>
Json json_of(const MapDescription& description, const Map& map) {
    const auto& view = map.view();
    Json object;
    object.add("kind", name_of(map));
    object.add("faces", map.statistics().face_count);
    add_own_keys(object, map);
    object.add("dropped_faces", map.statistics().dropped_faces);
    object.add("bytes", view.byte_count());
    object.add("file_bytes", description.file_bytes);
    object.add("build_ms", nullptr);
    if (description.notes.build_milliseconds) object.add("build_ms", *description.notes.build_milliseconds);
    const Vec3d centre = Vec3d(view.centre) + view.origin;
    object.add("centre", {centre.x, centre.y, centre.z});
    if (view.origin != Vec3d{}) object.add("origin", {view.origin.x, view.origin.y, view.origin.z});
    object.add("radius", view.radius);
    object.add("centre_inside", is_centre_inside(map));
    object.add("source_hash", fmt::format("{:016x}", map.source_hash()));
    return object;
}

template <typename Map>
std::string text_about(const MapDescription& description, const std::string& title, const Map& map) {
    const auto& view = map.view();
    const auto build_ms = description.notes.build_milliseconds;
    Table table(title);
    table.add("kind", fmt::format("{} map", name_of(map)));
    table.add("faces of the mesh", fmt::format("{} ({} too small for the lattice)",
                                               map.statistics().face_count, map.statistics().dropped_faces));
    const bool has_origin = view.origin != Vec3d{};
    table.add("bounding sphere", has_origin
                                     ? fmt::format("centre {}, radius {}",
                                                   text_of(Vec3d(view.centre) + view.origin), view.radius)
                                     : fmt::format("centre ({}, {}, {}), radius {}", view.centre.x,
                                                   view.centre.y, view.centre.z, view.radius));
    if (has_origin) table.add("origin", text_of(view.origin));
    table.add("centre inside", yes_or_no(is_centre_inside(map)));
    add_own_rows(table, map);
    table.add("bytes of the file", std::to_string(description.file_bytes));
    table.add("build time", build_ms ? fmt::format("{:.1f} ms", *build_ms) : "not recorded in the file");
    return table.text() + own_text(map);
}

} // namespace

Json to_json(const MapDescription& description) {
    return std::visit([&](const auto& map) { return json_of(description, map); }, description.map);
}

std::string to_text(const MapDescription& description, const std::string& title) {
    return std::visit([&](const auto& map) { return text_about(description, title, map); }, description.map);
}
