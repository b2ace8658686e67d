#include "contestants.hpp"
#include "files/atomic_file.hpp"
#include "measurements.hpp"
#include "rivals/compare/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

using namespace echinus;
using namespace echinus::comparison;

namespace {

/// With the default among them, ascending.
std::vector<std::uint32_t> divisions_to_try(std::uint32_t by_default) {
    std::vector<std::uint32_t> divisions{8, 12, 16, 24, 32, 48, 64, 96};
    divisions.push_back(by_default);
    std::ranges::sort(divisions);
    const auto [first, last] = std::ranges::unique(divisions);
    divisions.erase(first, last);
    return divisions;
}

struct Times {
    double inside, contact;
};

/// Takes turns with Embree, whose times come second.
std::array<Times, 2> query_times(const ExactMapView& map, const EmbreeRival& embree,
                                 const std::vector<Vec3f>& points, int repetitions) {
    std::vector<std::uint8_t> answers, others;
    std::vector<float> depths, other_depths;
    const auto inside =
        race(points.size(), repetitions,
             std::array{asks_inside(map, points, answers), asks_inside(embree, points, others)});
    std::vector<Vec3f> deep;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (answers[i]) deep.push_back(points[i]);
    const auto contact =
        race(deep.size(), repetitions,
             std::array{asks_contact(map, deep, depths), asks_contact(embree, deep, other_depths)});
    return {Times{inside[0], contact[0]}, Times{inside[1], contact[1]}};
}

/// Curves of one model.
struct Curves {
    Curve exact, embree;
};

Curves sweep_divisions(const Model& model, const char* colour, const Setting& setting,
                       std::vector<std::vector<std::string>>& rows) {
    const std::vector<Vec3f> points = comparison::surface_points(model.mesh, setting.few_points());
    const EmbreeRival embree(model.mesh);
    const ExactMap usual = ExactMap::build(model.mesh, one_thread());
    const std::uint32_t by_default = usual.view().divisions;
    Curves curves{{.name = model.name + ", exact map", .points = {}, .colour = colour},
                  {.name = model.name + ", Embree", .points = {}, .colour = colour, .dashed = true}};
    double embree_ns = 1e9;
    for (const std::uint32_t divisions : divisions_to_try(by_default)) {
        ExactMapOptions options = one_thread();
        options.divisions = divisions;
        const ExactMap map = ExactMap::build(model.mesh, options);
        const double build_ms =
            1e3 * shortest_seconds(setting.repetitions, [&] { (void)ExactMap::build(model.mesh, options); });
        const auto [ours, theirs] = query_times(map, embree, points, setting.repetitions);
        const auto megabytes = static_cast<double>(map.view().byte_count()) / 1e6;
        embree_ns = std::min(embree_ns, theirs.inside);
        curves.exact.points.push_back({megabytes, ours.inside});
        if (divisions == by_default) curves.exact.ringed.push_back({megabytes, ours.inside});
        rows.push_back(
            {model.name,
             divisions == by_default ? fmt::format("**{}**", divisions) : fmt::format("{}", divisions),
             fmt::format("{:.3f}", megabytes), fmt::format("{:.2f}", build_ms),
             fmt::format("{:.1f}", map.statistics().mean_list),
             fmt::format("{}", map.statistics().longest_list),
             fmt::format("{:.1f}", map.statistics().expected_tests), fmt::format("{:.1f}", ours.inside),
             fmt::format("{:.3f}", ours.inside / theirs.inside), fmt::format("{:.0f}", ours.contact),
             fmt::format("{:.2f}", ours.contact / theirs.contact)});
    }
    curves.embree.dotted_points = false;
    curves.embree.points = {{curves.exact.points.front().x, embree_ns},
                            {curves.exact.points.back().x, embree_ns}};
    return curves;
}

} // namespace

void measure_divisions(const Setting& setting, Values& values) {
    std::vector<std::vector<std::string>> rows{{"model", "divisions", "MB", "build, ms", "mean list",
                                                "longest list", "expected tests", "contains on S, ns",
                                                "of Embree's", "contact on S, ns", "of Embree's"}};
    Plot plot{.title = "Time against memory, 8 to 96 divisions",
              .x_label = "all bytes that a query reads, MB",
              .y_label = "contains() on S, ns per particle",
              .curves = {},
              .ring_meaning = "default"};
    const auto add = [&](const Model& model, const char* colour) {
        Curves curves = sweep_divisions(model, colour, setting, rows);
        plot.curves.push_back(std::move(curves.exact));
        plot.curves.push_back(std::move(curves.embree));
    };
    add(setting.horse(), "#0072b2");
    for (const Model& model : setting.models)
        if (model.name == "armadillo_52k") add(model, "#c44e00");
    write_file(setting.images / "exact_divisions.svg", svg(plot));
    values["divisions"] = markdown_table(rows);
}
