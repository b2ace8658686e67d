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

/// Nanoseconds of Embree on the processor for which the goals were stated, horse_6k: first hit on U, S and C,
/// and first hit with point query on S.
constexpr std::array<double, 3> kReferenceSign{63, 228, 49};
constexpr double kReferenceContact = 672;
/// Goals there, in nanoseconds and milliseconds.
constexpr std::array<double, 3> kSignGoal{25, 90, 20};
constexpr double kContactGoal = 900;

using Rows = std::vector<std::vector<std::string>>;

struct Tables {
    Rows sizes{{"model", "faces", "divisions", "cells", "bands", "references", "mean list", "longest list",
                "expected tests"}};
    Rows costs{{"model", "exact map: bytes", "build, ms", "distance map: bytes", "build, ms", "Embree: bytes",
                "build, ms"}};
    Rows times{{"model", "query", "particles", "exact map, ns", "batch, ns", "distance map, ns", "Embree, ns",
                "exact / Embree", "batch / Embree", "goal", ""}};
    Rows errors{{"model", "particles", "count", "exact and Embree differ", "on the surface", "exact wrong",
                 "Embree wrong", "distance map wrong"}};
    Rows depths{{"model", "particles", "exact against Embree, mean", "worst", "distance map, mean", "worst"}};
    Rows goals{{"goal", "at most", "measured", "", "scaled", ""}};
    /// Nanoseconds of Embree's sign on the horse's S: how fast this machine was.
    double embree_sign = 0;
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
    const int builds = 4 * subject.repetitions;
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

/// Times and wrong signs of one set. @returns what is inside, by the exact map
std::vector<std::uint8_t> add_signs(const Subject& subject, std::size_t set, const std::vector<Vec3f>& points,
                                    Tables& tables) {
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
    const double ratio = ns[0] / ns[3], goal = kSignGoal[set] / kReferenceSign[set];
    tables.times.push_back(
        {subject.model.name, "contains", name, fmt::format("{:.1f}", ns[0]), fmt::format("{:.1f}", ns[1]),
         fmt::format("{:.1f}", ns[2]), fmt::format("{:.1f}", ns[3]), fmt::format("{:.3f}", ratio),
         fmt::format("{:.3f}", ns[1] / ns[3]), subject.has_goals ? fmt::format("{:.3f}", goal) : "",
         subject.has_goals ? verdict(ratio, goal) : ""});
    if (subject.has_goals && set == 1) tables.embree_sign = ns[3];
    tables.errors.push_back({subject.model.name, name, fmt::format("{}", points.size())});
    std::ranges::move(judged_differences(subject, points, exact, embree),
                      std::back_inserter(tables.errors.back()));
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < points.size(); ++i) wrong += exact[i] != distance[i];
    tables.errors.back().push_back(
        fmt::format("{:.3f} %", 100 * static_cast<double>(wrong) / static_cast<double>(points.size())));
    return exact;
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

/// Times and depth errors of particles that are all inside. @returns depths by the exact map
std::vector<float> add_contacts(const Subject& subject, const std::string& name,
                                const std::vector<Vec3f>& points, bool has_goal, Tables& tables) {
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
    const double ratio = ns[0] / ns[3], goal = kContactGoal / kReferenceContact;
    tables.times.push_back({subject.model.name, "contact", name, fmt::format("{:.0f}", ns[0]),
                            fmt::format("{:.0f}", ns[1]), fmt::format("{:.1f}", ns[2]),
                            fmt::format("{:.0f}", ns[3]), fmt::format("{:.2f}", ratio),
                            fmt::format("{:.2f}", ns[1] / ns[3]), has_goal ? fmt::format("{:.2f}", goal) : "",
                            has_goal ? verdict(ratio, goal) : ""});
    tables.depths.push_back({subject.model.name, name});
    std::ranges::move(depth_differences(subject, exact, embree), std::back_inserter(tables.depths.back()));
    std::ranges::move(depth_differences(subject, distance, exact), std::back_inserter(tables.depths.back()));
    return exact;
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
    std::array<std::vector<std::uint8_t>, 3> inside;
    for (std::size_t set = 0; set < sets.size(); ++set)
        inside[set] = add_signs(subject, set, sets[set], tables);
    const std::vector<Vec3f> near = chosen(sets[1], [&](std::size_t i) { return inside[1][i] != 0; });
    const std::vector<float> depths = add_contacts(subject, "S, inside", near, false, tables);
    const auto shallow = [&](std::size_t i) { return depths[i] <= 0.01 * model.radius; };
    add_contacts(subject, "S, up to 1 % R deep", chosen(near, shallow), subject.has_goals, tables);
}

void add_goal(std::string what, double goal, double measured, Rows& rows) {
    rows.push_back({std::move(what), fmt::format("{:g}", goal), fmt::format("{:.3g}", measured),
                    verdict(measured, goal), "", ""});
}

/// Also as it would be on the processor for which the goals were stated, if that builds as much faster as
/// Embree is there.
void add_build_goal(const std::string& name, double goal, double milliseconds, Tables& tables) {
    add_goal(name + ": build, ms", goal, milliseconds, tables.goals);
    const double scaled = milliseconds * kReferenceSign[1] / tables.embree_sign;
    tables.goals.back()[4] = fmt::format("{:.3g}", scaled);
    tables.goals.back()[5] = verdict(scaled, goal);
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
    }
    for (const Model& model : setting.models) {
        if (model.name != "armadillo_52k") continue;
        const Subject subject(model, setting.repetitions, false);
        add_build_goal(model.name, 120, add_sizes(subject, tables), tables);
        measure(subject, setting.few_points(), tables);
    }
    values["slower"] = fmt::format("{:.2f}", tables.embree_sign / kReferenceSign[1]);
    values["sizes"] = markdown_table(tables.sizes);
    values["costs"] = markdown_table(tables.costs);
    values["times"] = markdown_table(tables.times);
    values["errors"] = markdown_table(tables.errors);
    values["depths"] = markdown_table(tables.depths);
    values["goals"] = markdown_table(tables.goals);
}
