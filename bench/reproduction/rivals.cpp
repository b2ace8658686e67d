#include "rivals.hpp"

#include "rivals/systems/dense_grid/dense_grid.hpp"
#include "rivals/systems/maps/maps.hpp"
#ifdef ECHINUS_HAS_SUPERQUADRIC_MAP
#include "rivals/systems/superquadric_map/superquadric_map.hpp"
#endif
#include "rivals/compare/clock.hpp"
#include "rivals/compare/turns.hpp"

#include <echinus/instruction_set.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

using namespace echinus;
using namespace echinus::comparison;
using rivals::System;

namespace {

using Rows = std::vector<std::vector<std::string>>;

/// Something that was built at the paper's settings.
struct Rival {
    std::string name;
    std::unique_ptr<const System> structure;
    double build_seconds;
    std::string instruction_set{echinus::instruction_set()}; ///< that it is asked with
};

template <typename Build>
Rival rival(std::string name, Build build) {
    const double start = process_seconds();
    auto structure = build();
    const double seconds = process_seconds() - start;
    return {std::move(name), std::move(structure), seconds};
}

/// The paper's figures for a model.
struct Printed {
    std::uint32_t segment_count;
    double superquadric_megabytes, field_megabytes;
};

Printed printed_for(const Subject& subject) {
    return subject.name == "torus" ? Printed{12, 4.1, 180} : Printed{17, 2.9, 230};
}

std::string megabytes(std::size_t bytes) {
    return fmt::format("{:.2f}", 1e-6 * static_cast<double>(bytes));
}

/// Percent of the points of each set.
void add_wrong(const System& structure, const Subject& subject, std::vector<std::string>& row) {
    for (const JudgedPoints& set : subject.sets) {
        std::vector<std::uint8_t> inside(set.points.size());
        structure.contains_batch(set.points, inside);
        std::size_t wrong = 0;
        for (std::size_t i = 0; i < inside.size(); ++i) wrong += inside[i] != set.inside[i] ? 1 : 0;
        row.push_back(
            fmt::format("{:.3f}", 100 * static_cast<double>(wrong) /
                                      static_cast<double>(std::max<std::size_t>(inside.size(), 1))));
    }
}

// ---- Superquadric maps ----

#ifdef ECHINUS_HAS_SUPERQUADRIC_MAP
Rival superquadric_rival(const Subject& subject, Rows& rows) {
    const Printed printed = printed_for(subject);
    rivals::SuperquadricMapOptions options;
    options.segment_count = printed.segment_count;
    options.thread_count = 1;
    Rival result = rival("superquadric map", [&] {
        return std::make_unique<rivals::SuperquadricMap>(
            rivals::SuperquadricMap::build(subject.mesh, options));
    });
    const auto& map = static_cast<const rivals::SuperquadricMap&>(*result.structure);
    rows.push_back({subject.name, fmt::format("{}", map.segment_count()), megabytes(map.byte_count()),
                    fmt::format("{:.2f}", static_cast<double>(map.byte_count()) / (1 << 20)),
                    fmt::format("{:.1f}", printed.superquadric_megabytes),
                    fmt::format("{:.1f}", result.build_seconds),
                    fmt::format("{:.1f}", 100 * rivals::fit_error(map.report()).mean),
                    fmt::format("{:.1f}", 100 * map.report().uncovered_area_share)});
    add_wrong(map, subject, rows.back());
    return result;
}
#endif

// ---- Distance fields ----

constexpr std::uint32_t kFieldSamples = 200;

Rival field_rival(const Subject& subject, rivals::SampleFormat format, Rows& rows) {
    const bool floats = format == rivals::SampleFormat::Float32;
    std::size_t node_count = 1;
    Rival result = rival(floats ? "distance field" : "distance field, 16 bit", [&] {
        auto grid = std::make_unique<rivals::DenseGrid>(rivals::DenseGrid::with_samples(
            subject.mesh, kFieldSamples, {.format = format, .thread_count = 1}));
        for (int axis = 0; axis < 3; ++axis) node_count *= grid->node_count(axis);
        return grid;
    });
    const double printed = printed_for(subject).field_megabytes;
    rows.push_back({subject.name, floats ? "float32" : "16 bit",
                    fmt::format("{:.2f} M", 1e-6 * static_cast<double>(node_count)),
                    megabytes(result.structure->byte_count()), fmt::format("{:.0f}", printed),
                    fmt::format("{:.0f}", 1e6 * printed / static_cast<double>(node_count)),
                    fmt::format("{:.1f}", 1e6 * printed / std::pow(kFieldSamples, 3)),
                    fmt::format("{:.1f}", result.build_seconds)});
    add_wrong(*result.structure, subject, rows.back());
    return result;
}

// ---- Speed ----

Rival distance_map_rival(const Subject& subject, std::string name) {
    return rival(std::move(name), [&] { return rivals::distance_map(subject.mesh, {.thread_count = 1}); });
}

/// One particle after the other, as the superquadric map is asked.
Rival scalar_distance_map_rival(const Subject& subject) {
    Rival result = distance_map_rival(subject, "distance map, scalar");
    result.instruction_set = "scalar";
    return result;
}

/// ns a particle, of all rivals on one model, which take turns.
void add_speeds(const Subject& subject, const std::vector<Rival>& rivals, Rows& rows) {
    const std::size_t first_row = rows.size();
    for (const Rival& rival : rivals)
        rows.push_back({subject.name, rival.name, megabytes(rival.structure->byte_count()),
                        fmt::format("{:.1f}", 1e3 * rival.build_seconds)});
    const auto race = [&](const JudgedPoints& set, const auto& ask) {
        std::vector<Racer> racers;
        for (const Rival& rival : rivals)
            racers.push_back({[&](Part part) {
                                  use_instruction_set(rival.instruction_set);
                                  ask(*rival.structure,
                                      std::span(set.points).subspan(part.begin, part.size()));
                              },
                              {{0, set.points.size()}}});
        TurnOptions turns;
        turns.enough_seconds = 2;
        const std::vector<Pace> paces = take_turns(racers, turns);
        use_instruction_set(rivals.front().instruction_set);
        for (std::size_t k = 0; k < paces.size(); ++k)
            rows[first_row + k].push_back(fmt::format("{:.0f}", paces[k].ns));
    };
    std::vector<std::uint8_t> inside(subject.sets[0].points.size());
    std::vector<Contact> contacts(inside.size());
    for (const JudgedPoints& set : subject.sets)
        race(set, [&](const System& structure, std::span<const Vec3f> points) {
            structure.contains_batch(points, std::span(inside).first(points.size()));
        });
    for (const JudgedPoints& set : subject.sets)
        race(set, [&](const System& structure, std::span<const Vec3f> points) {
            structure.contacts_batch(points, std::span(contacts).first(points.size()));
        });
}

} // namespace

void measure_rivals(std::span<const Subject> subjects, Values& values) {
    Rows superquadrics{{"model", "segments", "MB", "MiB", "printed", "build, s",
                        "fit, % of the segment's radius", "uncovered, % of the area", "wrong, %: U", "S",
                        "C"}};
    Rows fields{{"model", "samples", "how many", "MB", "printed", "printed, bytes a sample",
                 "the same in 200^3", "build, s", "wrong, %: U", "S", "C"}};
    Rows speeds{
        {"model", "system", "MB", "build, ms", "inside?, ns: U", "S", "C", "contact, ns: U", "S", "C"}};
    for (const Subject& subject : subjects) {
        std::vector<Rival> rivals;
        rivals.push_back(distance_map_rival(subject, "distance map"));
        rivals.push_back(scalar_distance_map_rival(subject));
#ifdef ECHINUS_HAS_SUPERQUADRIC_MAP
        rivals.push_back(superquadric_rival(subject, superquadrics));
#endif
        rivals.push_back(field_rival(subject, rivals::SampleFormat::Float32, fields));
        rivals.push_back(field_rival(subject, rivals::SampleFormat::Snorm16, fields));
        add_speeds(subject, rivals, speeds);
    }
    values["rivals.superquadrics"] =
        superquadrics.size() > 1
            ? markdown_table(superquadrics)
            : "Not measured: this build was without Eigen or Bullet's HACD, which the map is made with.";
    values["rivals.fields"] = markdown_table(fields);
    values["rivals.speed"] = markdown_table(speeds);
}
