#include "map_description.hpp"

#include "table.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>

using echinus::DistanceMapView;

namespace {

const char* name_of(echinus::PoleAxis axis) {
    return axis == echinus::PoleAxis::X ? "x" : axis == echinus::PoleAxis::Y ? "y" : "z";
}

const char* name_of(echinus::EntryFormat format) {
    return format == echinus::EntryFormat::Float32 ? "float32" : "unorm16";
}

const char* name_of(echinus::VertexCorrection correction) {
    using echinus::VertexCorrection;
    if (correction == VertexCorrection::None) return "none";
    return correction == VertexCorrection::Paper ? "paper" : "signed";
}

double mean_entries(const DistanceMapView& map) {
    return static_cast<double>(map.entry_count()) / static_cast<double>(map.direction_count());
}

/// One line for each number of entries: how many directions have it.
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

std::string bytes_text(const DistanceMapView& map) {
    return fmt::format("{} ({} offsets, {} entries)", map.byte_count(), map.entry_offsets.size_bytes(),
                       map.byte_count() - map.entry_offsets.size_bytes());
}

} // namespace

nlohmann::ordered_json to_json(const MapDescription& description) {
    const DistanceMapView& view = description.map.view();
    const echinus::DistanceMapStatistics& statistics = description.map.statistics();
    nlohmann::ordered_json object;
    object["kind"] = "distance";
    object["faces"] = statistics.face_count;
    object["directions"] = view.direction_count();
    object["longitude_count"] = view.longitude_count;
    object["colatitude_count"] = view.colatitude_count;
    object["pole"] = name_of(view.pole_axis);
    object["correction"] = name_of(view.correction);
    object["entry_format"] = name_of(view.entry_format);
    object["entries"] = view.entry_count();
    object["max_entries"] = statistics.max_entries;
    object["mean_entries"] = mean_entries(view);
    object["entry_histogram"] = echinus::entry_histogram(view);
    object["bytes"] = view.byte_count();
    object["offset_bytes"] = view.entry_offsets.size_bytes();
    object["entry_bytes"] = view.byte_count() - view.entry_offsets.size_bytes();
    object["file_bytes"] = description.file_bytes;
    object["build_ms"] = nullptr;
    if (description.notes.build_milliseconds) object["build_ms"] = *description.notes.build_milliseconds;
    object["centre"] = {view.centre.x, view.centre.y, view.centre.z};
    object["radius"] = view.radius;
    object["centre_inside"] = view.centre_inside;
    object["wrong_parity_share"] = statistics.wrong_parity_share;
    object["dropped_faces"] = statistics.dropped_faces;
    object["corrected_entries"] = statistics.corrected_entries;
    object["clamped_entries"] = statistics.clamped_entries;
    object["source_hash"] = fmt::format("{:016x}", description.map.source_hash());
    return object;
}

std::string to_text(const MapDescription& description, const std::string& title) {
    const DistanceMapView& view = description.map.view();
    const echinus::DistanceMapStatistics& statistics = description.map.statistics();
    const auto build_ms = description.notes.build_milliseconds;
    Table table(title);
    table.add("kind", "distance map");
    table.add("faces of the mesh",
              fmt::format("{} ({} too small to count)", statistics.face_count, statistics.dropped_faces));
    table.add("bounding sphere", fmt::format("centre ({}, {}, {}), radius {}", view.centre.x, view.centre.y,
                                             view.centre.z, view.radius));
    table.add("centre inside", yes_or_no(view.centre_inside));
    table.add("directions",
              fmt::format("{} x {} = {}, poles on {}", view.longitude_count, view.colatitude_count,
                          view.direction_count(), name_of(view.pole_axis)));
    table.add("entries",
              fmt::format("{} as {}; per direction {:.3f} on average, {} at most", view.entry_count(),
                          name_of(view.entry_format), mean_entries(view), statistics.max_entries));
    table.add("vertex correction",
              fmt::format("{}: {} entries moved, {} of them cut short", name_of(view.correction),
                          statistics.corrected_entries, statistics.clamped_entries));
    table.add("wrong parity", fmt::format("{:.3f} % of the directions, through holes of the mesh",
                                          statistics.wrong_parity_share * 100));
    table.add("bytes", bytes_text(view));
    table.add("bytes of the file", std::to_string(description.file_bytes));
    table.add("build time", build_ms ? fmt::format("{:.1f} ms", *build_ms) : "not noted in the file");
    return table.text() + "\n" + histogram_text(view);
}
