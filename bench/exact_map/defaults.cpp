#include "contestants.hpp"
#include "exact_map/layout.hpp"
#include "measurements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

using namespace echinus;

namespace {

/// Goals on the processor for which they were stated, in nanoseconds: contains() on U, S and C, contact() on
/// particles up to 1 % R deep. Embree's times there, horse_6k: on each set the best of single rays and
/// packets, which the goals were put beside, and the single rays that are measured here; for the full
/// contact, the mean over all of S, inside or not.
struct QueryGoal {
    const char* query;
    double goal, best, single;
};
constexpr QueryGoal kQueryGoals[] = {
    {"contains, U", 25, 63, 72.3},
    {"contains, S", 90, 228, 237},
    {"contains, C", 20, 49, 80},
    {"contact, up to 1 % R deep", 900, 672, 672},
};

using Rows = std::vector<std::vector<std::string>>;

struct Tables {
    Rows sizes{{"model", "faces", "divisions", "cells", "bands", "references", "mean list", "longest list",
                "expected tests"}};
    Rows costs{{"model", "exact map: bytes", "build, ms", "distance map: bytes", "build, ms", "Embree: bytes",
                "build, ms"}};
    Rows times{{"model", "query", "particles", "exact map, ns", "batch, ns", "distance map, ns", "Embree, ns",
                "exact / Embree", "batch / Embree"}};
    Rows errors{{"model", "particles", "count", "exact and Embree differ", "on the surface", "exact wrong",
                 "Embree wrong", "distance map wrong"}};
    Rows depths{{"model", "particles", "exact against Embree, mean", "worst", "distance map, mean", "worst"}};
    Rows goals{{"goal", "at most", "measured", "", "scaled", ""}};
    Rows query_goals{
        {"query", "goal, ns", "of Embree's", "of single rays", "measured", "of Embree's", "of single rays"}};
    /// Nanoseconds by kQueryGoals: exact map and Embree on the horse.
    std::array<double, std::size(kQueryGoals)> exact{}, embree{};
};

std::string verdict(double measured, double goal) {
    return measured <= goal ? "met" : "**missed**";
}

/// A model and what is asked about it.
struct Subject {
    const Model& model;
    ExactMap exact;
    DistanceMap distance;
    EmbreeRival embree;
    int repetitions;
    bool has_goals;

    Subject(const Model& model_, int repetitions_, bool has_goals_)
        : model(model_), exact(ExactMap::build(model.mesh, one_thread())),
          distance(DistanceMap::build(model.mesh, {.thread_count = 1})), embree(model.mesh),
          repetitions(repetitions_), has_goals(has_goals_) {}
};

/// @returns milliseconds of the exact map's build
double add_sizes(const Subject& subject, Tables& tables) {
    const TriangleMesh& mesh = subject.model.mesh;
    const ExactMapView& map = subject.exact;
    const ExactMapStatistics& statistics = subject.exact.statistics();
    const int builds = 6 * subject.repetitions;
    const double exact_ms =
        1e3 * shortest_seconds(builds, [&] { (void)ExactMap::build(mesh, one_thread()); });
    const double distance_ms =
        1e3 * shortest_seconds(builds, [&] { (void)DistanceMap::build(mesh, {.thread_count = 1}); });
    double embree_seconds = subject.embree.build_seconds();
    for (int i = 1; i < builds; ++i)
        embree_seconds = std::min(embree_seconds, EmbreeRival(mesh).build_seconds());
    tables.sizes.push_back(
        {subject.model.name, fmt::format("{}", mesh.faces.size()), fmt::format("{}", map.divisions),
         fmt::format("{}", map.cell_count()), fmt::format("{}", map.winding_below.size()),
         fmt::format("{}", map.references.size()), fmt::format("{:.1f}", statistics.mean_list),
         fmt::format("{}", statistics.longest_list), fmt::format("{:.1f}", statistics.expected_tests)});
    tables.costs.push_back(
        {subject.model.name, fmt::format("{}", map.byte_count()), fmt::format("{:.2f}", exact_ms),
         fmt::format("{}", subject.distance.view().byte_count()), fmt::format("{:.1f}", distance_ms),
         fmt::format("{}", subject.embree.byte_count()), fmt::format("{:.1f}", 1e3 * embree_seconds)});
    return exact_ms;
}

/// Where exact map and Embree differ: how often, how often within two lattice steps of the surface, where
/// rounding decides what either means by inside, and which is wrong elsewhere by the winding number over all
/// faces.
std::vector<std::string> judged_differences(const Subject& subject, const std::vector<Vec3f>& points,
                                            const std::vector<std::uint8_t>& exact,
                                            const std::vector<std::uint8_t>& embree) {
    const double ambiguous = 2 * frame_of(subject.exact.view()).step;
    std::size_t differences = 0, on_surface = 0, exact_wrong = 0, embree_wrong = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (exact[i] == embree[i]) continue;
        ++differences;
        const Vec3d point(points[i]);
        if (unsigned_distance(subject.model.mesh, point) <= ambiguous) {
            ++on_surface;
            continue;
        }
        const bool inside = std::fabs(winding_number(subject.model.mesh, point)) > 0.5;
        exact_wrong += (exact[i] != 0) != inside;
        embree_wrong += (embree[i] != 0) != inside;
    }
    return {fmt::format("{}", differences), fmt::format("{}", on_surface), fmt::format("{}", exact_wrong),
            fmt::format("{}", embree_wrong)};
}

/// Times and wrong signs of one set.
void add_signs(const Subject& subject, std::size_t set, const std::vector<Vec3f>& points, Tables& tables) {
    std::vector<std::uint8_t> exact, distance, embree, batch(points.size());
    const Contestant asks_batch = [&](std::size_t begin, std::size_t end) {
        contains_batch(subject.exact.view(), std::span(points).subspan(begin, end - begin),
                       std::span(batch).subspan(begin, end - begin));
    };
    const auto ns = race(points.size(), subject.repetitions,
                         std::array{asks_inside(subject.exact.view(), points, exact), asks_batch,
                                    asks_inside(subject.distance.view(), points, distance),
                                    asks_inside(subject.embree, points, embree)});
    const std::string name(1, "USC"[set]);
    tables.times.push_back({subject.model.name, "contains", name, fmt::format("{:.1f}", ns[0]),
                            fmt::format("{:.1f}", ns[1]), fmt::format("{:.1f}", ns[2]),
                            fmt::format("{:.1f}", ns[3]), fmt::format("{:.3f}", ns[0] / ns[3]),
                            fmt::format("{:.3f}", ns[1] / ns[3])});
    if (subject.has_goals) {
        tables.exact[set] = ns[0];
        tables.embree[set] = ns[3];
    }
    tables.errors.push_back({subject.model.name, name, fmt::format("{}", points.size())});
    std::ranges::move(judged_differences(subject, points, exact, embree),
                      std::back_inserter(tables.errors.back()));
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < points.size(); ++i) wrong += exact[i] != distance[i];
    tables.errors.back().push_back(
        fmt::format("{:.3f} %", 100 * static_cast<double>(wrong) / static_cast<double>(points.size())));
}

/// Mean and largest absolute difference of depths, in bounding radii, where both find the particle inside.
std::vector<std::string> depth_differences(const Subject& subject, const std::vector<float>& a,
                                           const std::vector<float>& b) {
    double sum = 0, worst = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (!(a[i] > 0 && b[i] > 0)) continue;
        const double difference = std::fabs(double{a[i]} - double{b[i]}) / subject.model.radius;
        sum += difference;
        worst = std::max(worst, difference);
        ++count;
    }
    return {fmt::format("{:.1e} R", sum / static_cast<double>(count)), fmt::format("{:.1e} R", worst)};
}

struct Contacts {
    double exact_ns, embree_ns;
    std::vector<float> depths; ///< by the exact map
};

/// Times and depth errors of a set.
Contacts add_contacts(const Subject& subject, const std::string& name, const std::vector<Vec3f>& points,
                      Tables& tables) {
    std::vector<float> exact, distance, embree;
    std::vector<Contact> batch(points.size());
    const Contestant asks_batch = [&](std::size_t begin, std::size_t end) {
        contacts_batch(subject.exact.view(), std::span(points).subspan(begin, end - begin), 0,
                       std::span(batch).subspan(begin, end - begin));
    };
    const auto ns = race(points.size(), subject.repetitions,
                         std::array{asks_contact(subject.exact.view(), points, exact), asks_batch,
                                    asks_contact(subject.distance.view(), points, distance),
                                    asks_contact(subject.embree, points, embree)});
    tables.times.push_back({subject.model.name, "contact", name, fmt::format("{:.0f}", ns[0]),
                            fmt::format("{:.0f}", ns[1]), fmt::format("{:.1f}", ns[2]),
                            fmt::format("{:.0f}", ns[3]), fmt::format("{:.2f}", ns[0] / ns[3]),
                            fmt::format("{:.2f}", ns[1] / ns[3])});
    tables.depths.push_back({subject.model.name, name});
    std::ranges::move(depth_differences(subject, exact, embree), std::back_inserter(tables.depths.back()));
    std::ranges::move(depth_differences(subject, distance, exact), std::back_inserter(tables.depths.back()));
    return {ns[0], ns[3], std::move(exact)};
}

std::vector<Vec3f> chosen(const std::vector<Vec3f>& points, const auto& is_chosen) {
    std::vector<Vec3f> result;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (is_chosen(i)) result.push_back(points[i]);
    return result;
}

void measure(const Subject& subject, std::size_t point_count, Tables& tables) {
    const Model& model = subject.model;
    const auto side = static_cast<std::size_t>(std::sqrt(point_count));
    const std::array sets{test::uniform_points(model.mesh, point_count),
                          test::surface_points(model.mesh, point_count),
                          test::cloth_points(model.mesh, side, side, model.up)};
    for (std::size_t set = 0; set < sets.size(); ++set) add_signs(subject, set, sets[set], tables);
    const Contacts all = add_contacts(subject, "S", sets[1], tables);
    const auto near = chosen(sets[1], [&](std::size_t i) { return all.depths[i] > 0; });
    const Contacts inside = add_contacts(subject, "S, inside", near, tables);
    const auto shallow = chosen(near, [&](std::size_t i) { return inside.depths[i] <= 0.01 * model.radius; });
    const Contacts near_surface = add_contacts(subject, "S, up to 1 % R deep", shallow, tables);
    if (!subject.has_goals) return;
    tables.exact.back() = near_surface.exact_ns;
    tables.embree.back() = all.embree_ns;
}

void add_goal(std::string what, double goal, double measured, Rows& rows) {
    rows.push_back({std::move(what), fmt::format("{:g}", goal), fmt::format("{:.3g}", measured),
                    verdict(measured, goal), "", ""});
}

/// Also as it would be on the processor for which the goals were stated, if that builds as much faster as
/// Embree is there.
void add_build_goal(const std::string& name, double goal, double milliseconds, Tables& tables) {
    add_goal(name + ": build, ms", goal, milliseconds, tables.goals);
    const double scaled = milliseconds * kQueryGoals[1].single / tables.embree[1];
    tables.goals.back()[4] = fmt::format("{:.3g}", scaled);
    tables.goals.back()[5] = verdict(scaled, goal);
}

void add_query_goals(Tables& tables) {
    for (std::size_t i = 0; i < std::size(kQueryGoals); ++i) {
        const auto& [query, goal, best, single] = kQueryGoals[i];
        const double ratio = tables.exact[i] / tables.embree[i];
        tables.query_goals.push_back({query, fmt::format("{}", goal), fmt::format("{:.3f}", goal / best),
                                      fmt::format("{:.3f}", goal / single), fmt::format("{:.3f}", ratio),
                                      verdict(ratio, goal / best), verdict(ratio, goal / single)});
    }
}

} // namespace

void measure_defaults(const Setting& setting, Values& values) {
    const Model& horse = setting.horse();
    values["horse"] = horse.name == "horse"
                          ? "`horse` is Debian's `glmark2-data`, doubled patches dropped (7160 faces)"
                          : "`horse_6k` is a standing horse of 6000 faces, the Cyberware horse simplified";
    Tables tables;
    {
        const Subject subject(horse, setting.repetitions, true);
        const double build_ms = add_sizes(subject, tables);
        measure(subject, setting.point_count, tables);
        add_goal(horse.name + ": MB", 0.3, static_cast<double>(subject.exact.view().byte_count()) / 1e6,
                 tables.goals);
        add_build_goal(horse.name, 10, build_ms, tables);
        add_query_goals(tables);
    }
    for (const Model& model : setting.models) {
        if (model.name != "armadillo_52k") continue;
        const Subject subject(model, setting.repetitions, false);
        add_build_goal(model.name, 120, add_sizes(subject, tables), tables);
        measure(subject, setting.few_points(), tables);
    }
    values["slower"] = fmt::format("{:.2f}", tables.embree[1] / kQueryGoals[1].single);
    values["sizes"] = markdown_table(tables.sizes);
    values["costs"] = markdown_table(tables.costs);
    values["times"] = markdown_table(tables.times);
    values["errors"] = markdown_table(tables.errors);
    values["depths"] = markdown_table(tables.depths);
    values["query_goals"] = markdown_table(tables.query_goals);
    values["goals"] = markdown_table(tables.goals);
}
