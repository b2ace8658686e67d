#include "signs.hpp"

#include "names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

using namespace echinus;

namespace {

constexpr std::uint32_t kSampleCounts[] = {100, 200, 400};

DistanceMap build(const Subject& subject, std::uint32_t sample_count, PoleAxis axis,
                  VertexCorrection correction) {
    return DistanceMap::build(subject.mesh, {.longitude_count = sample_count,
                                             .colatitude_count = sample_count,
                                             .correction = correction,
                                             .pole_axis = axis});
}

/// Shares of a set's points, in percent.
struct WrongSigns {
    double missed = 0;   ///< inside, but said to be outside
    double invented = 0; ///< outside, but said to be inside

    double all() const { return missed + invented; }
};

WrongSigns wrong_signs(const DistanceMapView& map, const JudgedPoints& set) {
    std::vector<std::uint8_t> answers(set.points.size());
    contains_batch(map, set.points, answers);
    const double share = 100.0 / static_cast<double>(set.points.size());
    WrongSigns wrong;
    for (std::size_t i = 0; i < answers.size(); ++i) {
        if (answers[i] == set.inside[i]) continue;
        (set.inside[i] ? wrong.missed : wrong.invented) += share;
    }
    return wrong;
}

/// After the cells that name the map.
void add_signs(const DistanceMapView& map, const Subject& subject, std::vector<std::string>& row) {
    const auto& [u, s, c] = subject.sets;
    const WrongSigns near = wrong_signs(map, s);
    row.push_back(fmt::format("{:.3f}", wrong_signs(map, u).all()));
    for (const double share : {near.all(), near.missed, near.invented})
        row.push_back(fmt::format("{:.2f}", share));
    row.push_back(fmt::format("{:.2f}", wrong_signs(map, c).all()));
}

/// Of a set's points within the sphere, in percent.
struct SampleShares {
    double few = 0;           ///< have fewer than three usable samples
    double unequal = 0;       ///< have fewer than four
    double wrong_unequal = 0; ///< of those with a wrong sign, have fewer than four
};

SampleShares sample_shares(const DistanceMapView& map, const JudgedPoints& set) {
    std::size_t asked = 0, few = 0, unequal = 0, wrong = 0, wrong_unequal = 0;
    for (std::size_t i = 0; i < set.points.size(); ++i) {
        const int count = usable_sample_count(map, set.points[i]);
        if (count == 0) continue;
        const bool is_wrong = contains(map, set.points[i]) != (set.inside[i] != 0);
        ++asked;
        few += count < 3;
        unequal += count < 4;
        wrong += is_wrong;
        wrong_unequal += is_wrong && count < 4;
    }
    const auto percent = [](std::size_t part, std::size_t whole) {
        return whole == 0 ? 0 : 100 * static_cast<double>(part) / static_cast<double>(whole);
    };
    return {percent(few, asked), percent(unequal, asked), percent(wrong_unequal, wrong)};
}

std::vector<std::string> sample_cells(const DistanceMapView& map, const Subject& subject) {
    std::vector<std::string> cells;
    for (const JudgedPoints& set : subject.sets)
        cells.push_back(fmt::format("{:.2f}", sample_shares(map, set).few));
    const SampleShares near = sample_shares(map, subject.sets[1]);
    cells.push_back(fmt::format("{:.1f}", near.unequal));
    cells.push_back(fmt::format("{:.0f}", near.wrong_unequal));
    return cells;
}

} // namespace

void measure_signs(const Subject& subject, Values& values) {
    const std::vector<std::string> head{"directions", "pole",     "correction", "U",
                                        "S",          "S missed", "S invented", "C"};
    std::vector<std::vector<std::string>> all{head}, brief{head};
    std::vector<std::vector<std::string>> few{
        {"directions", "pole", "U", "S", "C", "fewer than 4, S", "of the wrong on S"}};
    for (const std::uint32_t count : kSampleCounts)
        for (const PoleAxis axis : kAxes) {
            const std::vector<std::string> grid{fmt::format("{0} x {0}", count), name_of(axis)};
            for (const VertexCorrection correction : kCorrections) {
                const DistanceMap map = build(subject, count, axis, correction);
                all.push_back(grid);
                all.back().push_back(name_of(correction));
                add_signs(map, subject, all.back());
                if (correction != VertexCorrection::None) continue;
                if (count == 200) brief.push_back(all.back());
                few.push_back(grid);
                std::ranges::copy(sample_cells(map, subject), std::back_inserter(few.back()));
            }
        }
    values[subject.name + ".signs.all"] = markdown_table(all);
    values[subject.name + ".signs.short"] = markdown_table(brief);
    values[subject.name + ".few"] = markdown_table(few);
}

void measure_smoothing(std::span<const Subject> subjects, Values& values) {
    constexpr double kDeviations[] = {0.005, 0.01, 0.02, 0.04}; // in widths of the sheet
    std::vector<std::vector<std::string>> rows{{"model"}};
    for (const double deviation : kDeviations) rows[0].push_back(fmt::format("{:.1f} %", 100 * deviation));
    for (const Subject& subject : subjects) {
        rows.push_back({subject.name});
        const DistanceMap map = build(subject, 200, PoleAxis::X, VertexCorrection::None);
        for (const double deviation : kDeviations) {
            const JudgedPoints set =
                judged("C",
                       comparison::cloth_points(subject.mesh, subject.side_count, subject.side_count,
                                                subject.up, deviation),
                       subject.judge);
            rows.back().push_back(fmt::format("{:.2f}", wrong_signs(map, set).all()));
        }
    }
    values["smoothing"] = markdown_table(rows);
}
