// The task reproduction: the paper's map on the paper's models. Its bytes in three layouts, and how often it
// is wrong about inside and outside, for every pole axis and correction.

#include "subjects.hpp"
#include "task.hpp"
#include "truth.hpp"

#include <echinus/distance_map.hpp>

#include <fmt/format.h>

#include <utility>

using namespace echinus;
using namespace echinus::comparison;

namespace {

constexpr std::pair<PoleAxis, const char*> kAxes[] = {
    {PoleAxis::X, "x"}, {PoleAxis::Y, "y"}, {PoleAxis::Z, "z"}};
constexpr std::pair<VertexCorrection, const char*> kCorrections[] = {{VertexCorrection::None, "none"},
                                                                     {VertexCorrection::Paper, "paper"},
                                                                     {VertexCorrection::Signed, "signed"}};

/// Each direction a dynamic array of a 32-bit program (three pointers) with its floats on the heap: the
/// layout that comes nearest to the paper's figure.
double dynamic_array_bytes(const DistanceMapView& map) {
    return 12 * static_cast<double>(map.direction_count()) + 4 * static_cast<double>(map.entry_count());
}

/// Shares of a set's particles, in percent.
struct WrongSides {
    double missed = 0;   ///< inside, but answered as outside
    double invented = 0; ///< outside, but answered as inside
};

WrongSides wrong_sides(const DistanceMapView& map, const JudgedSet& set) {
    std::vector<std::uint8_t> answers(set.points.size());
    contains_batch(map, set.points, answers);
    const double share = 100.0 / static_cast<double>(set.points.size());
    WrongSides wrong;
    for (std::size_t i = 0; i < answers.size(); ++i)
        if (answers[i] != set.truth.inside[i])
            (set.truth.inside[i] != 0 ? wrong.missed : wrong.invented) += share;
    return wrong;
}

void add_map(const Subject& subject, const std::vector<JudgedSet>& sets, DistanceMapOptions options,
             Records::Record record, Records& records) {
    const DistanceMap map = DistanceMap::build(subject.mesh, options);
    options.entry_format = EntryFormat::Unorm16;
    const DistanceMap small = DistanceMap::build(subject.mesh, options);
    const DistanceMapView& view = map;
    record["mesh"] = subject.name;
    record["faces"] = fmt::format("{}", subject.mesh.faces.size());
    record["mean_entries"] = fmt::format("{:.2f}", static_cast<double>(view.entry_count()) /
                                                       static_cast<double>(view.direction_count()));
    record["max_entries"] = fmt::format("{}", map.statistics().max_entries);
    record["bytes_float"] = fmt::format("{}", view.byte_count());
    record["bytes_16_bit"] = fmt::format("{}", small.view().byte_count());
    record["bytes_dynamic_arrays"] = fmt::format("{:.0f}", dynamic_array_bytes(view));
    for (const JudgedSet& set : sets) {
        const WrongSides wrong = wrong_sides(view, set);
        record["wrong_" + set.name] = fmt::format("{:.4g}", wrong.missed + wrong.invented);
        record["missed_" + set.name] = fmt::format("{:.4g}", wrong.missed);
    }
    records.add(std::move(record));
}

} // namespace

Records measure_reproduction(const Setting& setting) {
    Records records({"mesh", "faces", "pole", "correction", "mean_entries", "max_entries", "bytes_float",
                     "bytes_16_bit", "bytes_dynamic_arrays", "wrong_U", "missed_U", "wrong_S", "missed_S",
                     "wrong_C", "missed_C"});
    std::vector<Subject> subjects{public_horse(setting.debian_horse), torus_subject()};
    if (Subject first = first_subject(setting.meshes, setting.debian_horse); first.name != "horse")
        subjects.insert(subjects.begin(), std::move(first));
    for (const Subject& subject : subjects) {
        setting.report_progress("judging " + subject.name, 0);
        std::vector<JudgedSet> sets = subject.sets(setting.point_count);
        for (JudgedSet& set : sets) judge(subject, setting.truth_cache, set);
        for (const auto& [axis, axis_name] : kAxes)
            for (const auto& [correction, correction_name] : kCorrections) {
                DistanceMapOptions options;
                options.pole_axis = axis;
                options.correction = correction;
                add_map(subject, sets, options, {{"pole", axis_name}, {"correction", correction_name}},
                        records);
            }
    }
    return records;
}
