#include "contestants.hpp"
#include "measurements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

using namespace echinus;

namespace {

double build_milliseconds(const TriangleMesh& mesh, const ExactMapOptions& options, int repetitions) {
    return 1e3 * shortest_seconds(repetitions, [&] { (void)ExactMap::build(mesh, options); });
}

std::string both(const char* format, double sphere, double searched) {
    return fmt::format("{} / {}", fmt::format(fmt::runtime(format), sphere),
                       fmt::format(fmt::runtime(format), searched));
}

std::vector<std::string> compare(const Model& model, const Setting& setting) {
    ExactMapOptions search = one_thread();
    search.centre = CentreChoice::Search;
    const std::array maps{ExactMap::build(model.mesh, one_thread()), ExactMap::build(model.mesh, search)};
    const std::vector<Vec3f> points = comparison::surface_points(model.mesh, setting.few_points());
    std::array<std::vector<std::uint8_t>, 2> answers;
    const auto ns = race(points.size(), setting.repetitions,
                         std::array{asks_inside(maps[0].view(), points, answers[0]),
                                    asks_inside(maps[1].view(), points, answers[1])});
    const auto& [sphere, searched] = maps;
    const int builds = std::max(2, setting.repetitions / 2);
    return {model.name,
            fmt::format("{}", model.mesh.faces.size()),
            both("{:.1f}", sphere.statistics().expected_tests, searched.statistics().expected_tests),
            both("{:.0f}", sphere.statistics().longest_list, searched.statistics().longest_list),
            both("{:.1f}", ns[0], ns[1]),
            fmt::format("{:.2f}", ns[1] / ns[0]),
            both("{:.3f}", static_cast<double>(sphere.view().byte_count()) / 1e6,
                 static_cast<double>(searched.view().byte_count()) / 1e6),
            fmt::format("{:.2f}", searched.view().radius / sphere.view().radius),
            both("{:.0f}", build_milliseconds(model.mesh, one_thread(), builds),
                 build_milliseconds(model.mesh, search, builds))};
}

} // namespace

void measure_centres(const Setting& setting, Values& values) {
    std::vector<std::vector<std::string>> rows{{"model", "faces", "expected tests", "longest list",
                                                "contains on S, ns", "ratio", "MB", "radius, ratio",
                                                "build, ms"}};
    for (const Model& model : setting.models)
        if (model.closed) rows.push_back(compare(model, setting));
    values["centres"] = markdown_table(rows);
}
