#include "contestants.hpp"
#include "exact_map/layout.hpp"
#include "measurements.hpp"
#include "rivals/compare/portable_random.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

using namespace echinus;

namespace {

struct Chords {
    std::string name;
    std::vector<Vec3f> from, to;
};

Vec3d random_direction(comparison::PortableRandom& random) {
    const Vec3d v{random.normal(), random.normal(), random.normal()};
    return v * (1 / length(v));
}

/// Of one length, any way.
Chords short_chords(std::string name, const std::vector<Vec3f>& from, double chord_length) {
    comparison::PortableRandom random(4);
    Chords chords{std::move(name), from, {}};
    for (const Vec3f& point : from)
        chords.to.emplace_back(Vec3d(point) + random_direction(random) * chord_length);
    return chords;
}

/// As the shortcut of sweep() in src/exact_map/query/sweep.cpp decides it: both ends in one gap of one cell.
bool in_one_gap(const ExactMapView& map, const Vec3f& from_local, const Vec3f& to_local) {
    const LatticePoint from = rounded(frame_of(map).to_lattice(from_local));
    const LatticePoint to = rounded(frame_of(map).to_lattice(to_local));
    const OctahedralCells cells(map.divisions);
    const std::uint32_t cell = cells.locate(from).cell;
    if (cell != cells.locate(to).cell) return false;
    /// An even number for a band, an odd one for the gap beyond it; -1 for the innermost gap.
    const auto interval = [&](const LatticePoint& p) {
        const std::int64_t t = band_unit_of(l1_norm(p));
        const BandRange bands = bands_of_cell(map, cell);
        int number = -1;
        for (std::uint32_t band = bands.first; band < bands.last; ++band)
            number += (t >= map.bands[band].lower) + (t >= map.bands[band].upper);
        return number;
    };
    return interval(from) == interval(to) && interval(from) % 2 != 0;
}

std::vector<std::string> measure(const Model& model, const ExactMapView& map, const EmbreeRival& embree,
                                 const Chords& chords, int repetitions) {
    const std::size_t count = chords.from.size();
    std::vector<std::uint8_t> ours(count), theirs(count);
    const auto ns =
        race(count, repetitions,
             std::array<Contestant, 2>{[&](std::size_t begin, std::size_t end) {
                                           for (std::size_t i = begin; i < end; ++i)
                                               ours[i] = sweep(map, chords.from[i], chords.to[i]).found();
                                       },
                                       [&](std::size_t begin, std::size_t end) {
                                           for (std::size_t i = begin; i < end; ++i)
                                               theirs[i] = embree.crossed(chords.from[i], chords.to[i]);
                                       }});
    std::size_t found = 0, differing = 0, shortcuts = 0;
    for (std::size_t i = 0; i < count; ++i) {
        found += ours[i];
        differing += ours[i] != theirs[i];
        shortcuts += in_one_gap(map, chords.from[i], chords.to[i]);
    }
    const auto percent = [&](std::size_t part) {
        return 100 * static_cast<double>(part) / static_cast<double>(count);
    };
    return {model.name,
            chords.name,
            fmt::format("{:.0f}", ns[0]),
            fmt::format("{:.0f}", ns[1]),
            fmt::format("{:.2f}", ns[0] / ns[1]),
            fmt::format("{:.1f} %", percent(shortcuts)),
            fmt::format("{:.1f} %", percent(found)),
            fmt::format("{:.4f} %", percent(differing))};
}

} // namespace

void measure_chords(const Setting& setting, Values& values) {
    std::vector<std::vector<std::string>> rows{{"model", "chords", "sweep, ns", "Embree, ns", "ratio",
                                                "within one gap", "meet the surface",
                                                "exact and Embree differ"}};
    for (const Model& model : setting.models) {
        if (&model != &setting.horse() && model.name != "armadillo_52k") continue;
        const ExactMap map = ExactMap::build(model.mesh, one_thread());
        const EmbreeRival embree(model.mesh);
        const std::size_t count = setting.few_points();
        const auto side = static_cast<std::size_t>(std::sqrt(count));
        const Chords kinds[] = {
            short_chords("1 % R, from S", comparison::surface_points(model.mesh, count), 0.01 * model.radius),
            short_chords("1 % R, from C", comparison::cloth_points(model.mesh, side, side, model.up),
                         0.01 * model.radius),
            {"long, from U to U", comparison::uniform_points(model.mesh, count, 5),
             comparison::uniform_points(model.mesh, count, 6)}};
        for (const Chords& chords : kinds)
            rows.push_back(measure(model, map, embree, chords, setting.repetitions));
    }
    values["chords"] = markdown_table(rows);
}
