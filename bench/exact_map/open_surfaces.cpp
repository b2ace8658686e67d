#include "measurements.hpp"
#include "stopwatch.hpp"

#include <fmt/format.h>

#include <array>

using namespace echinus;

namespace {

/// Nanoseconds per point of classify(); "-" when there are none.
std::string classify_time(const ExactMapView& map, const std::vector<Vec3f>& points, int repetitions) {
    if (points.empty()) return "-";
    std::vector<std::uint8_t> answers(points.size());
    const Contestant asks = [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) answers[i] = classify(map, points[i]).inside;
    };
    return fmt::format("{:.0f}", race(points.size(), repetitions, std::array{asks})[0]);
}

std::vector<std::string> measure(const Model& model, const Setting& setting) {
    const ExactMap map = ExactMap::build(model.mesh, one_thread());
    const double build_ms =
        1e3 * shortest_seconds(setting.repetitions, [&] { (void)ExactMap::build(model.mesh, one_thread()); });
    std::vector<Vec3f> certain, uncertain;
    for (const Vec3f& point : comparison::uniform_points(model.mesh, setting.few_points()))
        (classify(map, point).certain ? certain : uncertain).push_back(point);
    const ExactMapStatistics& statistics = map.statistics();
    return {model.name,
            fmt::format("{}", model.mesh.faces.size()),
            fmt::format("{}", map.view().border.size()),
            fmt::format("{:.2f}", static_cast<double>(map.view().byte_count()) / 1e6),
            fmt::format("{:.1f}", build_ms),
            fmt::format("{:.2f} %", 100 * statistics.certain_share),
            fmt::format("{:.2f} %", 100 * static_cast<double>(certain.size()) /
                                        static_cast<double>(certain.size() + uncertain.size())),
            fmt::format("{:.2f} %", 100 * statistics.uncertain_directions),
            classify_time(map, certain, setting.repetitions),
            classify_time(map, uncertain, setting.repetitions)};
}

} // namespace

void measure_open_surfaces(const Setting& setting, Values& values) {
    std::vector<std::vector<std::string>> rows{
        {"model", "faces", "border edges", "MB", "build, ms", "certain, by volume", "of U",
         "directions with an uncertain gap", "classify, certain, ns", "uncertain, ns"}};
    for (const Model& model : setting.models)
        if (!model.closed) rows.push_back(measure(model, setting));
    values["open"] = markdown_table(rows);
}
