#include "compare/curve_plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace echinus::comparison {

namespace {

using Measure = double (*)(const Figures&);

constexpr double kNoneWrong = 1e-4; // per cent
constexpr double kNoError = 1e-5;   // per cent of R

double megabytes(const Figures& figures) {
    return 1e-6 * static_cast<double>(figures.byte_count);
}
double wrong_percent(const Figures& figures) {
    return std::max(100 * figures.sets.front().errors.wrong_share, kNoneWrong);
}
double depth_error_percent(const Figures& figures) {
    return std::max(100 * figures.sets.front().errors.depth.mean, kNoError);
}
double side_ns(const Figures& figures) {
    return figures.sets.front().contains.ns;
}
double contact_ns(const Figures& figures) {
    return figures.sets.front().contacts.ns;
}

std::vector<Curve> curves_of(const Comparison& comparison, Measure x, Measure y) {
    std::vector<Curve> curves;
    for (const std::vector<Figures>& sizes : comparison.curves) {
        if (sizes.empty()) continue;
        const SystemType& system = *sizes.front().system;
        const auto [colour, dashed] = line_style_of(system);
        Curve curve{.name = std::string(system.title), .points = {}, .colour = colour, .dashed = dashed};
        for (const Figures& figures : sizes) curve.points.push_back({x(figures), y(figures)});
        curves.push_back(std::move(curve));
    }
    return curves;
}

} // namespace

LineStyle line_style_of(const SystemType& system) {
    // Paul Tol's "muted", and grey for those that come in one size.
    static constexpr std::pair<std::string_view, const char*> kColours[] = {
        {"exact", "#0072b2"},
        {"distance", "#56b4e9"},
        {"distance-octahedral", "#332288"},
        {"distance-cube", "#88ccee"},
        {"distance-ellipsoidal", "#44aa99"},
        {"superquadric", "#cc6677"},
        {"dense", "#009e73"},
        {"dense-16bit", "#117733"},
        {"openvdb", "#ccbb44"},
        {"classified", "#d55e00"},
        {"embree", "#cc79a7"},
        {"bullet", "#888888"},
    };
    const auto found =
        std::ranges::find(kColours, system.name, [](const auto& entry) { return entry.first; });
    const bool ours = system.name == "exact" || system.name.starts_with("distance");
    return {found == std::end(kColours) ? "#444444" : found->second, !ours};
}

std::vector<Plot> curve_plots(const Comparison& comparison) {
    const std::string wrong = fmt::format("on the wrong side, % (none: {:.4f})", kNoneWrong);
    const std::string depth = fmt::format("mean error of the depth, % of R (none: {:.5f})", kNoError);
    const std::string bytes = "bytes that a query reads, MB";
    return {
        {"Inside or outside: error against bytes", bytes, wrong,
         curves_of(comparison, megabytes, wrong_percent)},
        {"Depth: error against bytes", bytes, depth, curves_of(comparison, megabytes, depth_error_percent)},
        {"Inside or outside: time against error", wrong, "ns a particle",
         curves_of(comparison, wrong_percent, side_ns)},
        {"Contact: time against error", depth, "ns a particle",
         curves_of(comparison, depth_error_percent, contact_ns)},
    };
}

} // namespace echinus::comparison
