#include "verdict.hpp"

#include "rivals/compare/curve_plots.hpp"
#include "rivals/compare/markup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

using namespace echinus;
using namespace echinus::comparison;

namespace {

// Pixels.
constexpr double kNames = 190, kBar = 250, kValue = 110, kPanel = kNames + kBar + kValue;
constexpr double kRow = 19, kHead = 58, kGap = 26;
constexpr std::size_t kAcross = 2;          // panels
constexpr double kLeast = 1e-3, kMost = 20; // per cent, the ends of the axis

double bar_length(double percent) {
    const double share = std::log10(std::max(percent, kLeast) / kLeast) / std::log10(kMost / kLeast);
    return kBar * std::min(share, 1.0);
}

double wrong_percent(const Figures& figures) {
    return 100 * std::ranges::find(figures.sets, "S", &SetFigures::set)->errors.wrong_share;
}

std::string label_of(const Figures& figures) {
    const double percent = wrong_percent(figures);
    std::string label = percent == 0 ? "none" : fmt::format("{:.3g} %", percent);
    if (!figures.excess.empty())
        label += fmt::format(", in {:.3g} MB", 1e-6 * static_cast<double>(figures.byte_count));
    return label;
}

std::string row_of(const Figures& figures, double x, double y) {
    const auto [colour, rival] = line_style_of(*figures.system);
    const double length = bar_length(wrong_percent(figures));
    const bool over = !figures.excess.empty();
    std::string svg = svg_text(x + kNames - 8, y + 13, "end", std::string(figures.system->title),
                               rival ? "" : " font-weight=\"bold\"");
    if (length > 0)
        svg += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\" "
                           "fill-opacity=\"{}\" stroke=\"{}\"/>\n",
                           x + kNames, y + 3, length, kRow - 6, colour, over ? 0.25 : 1.0, colour);
    return svg + svg_text(x + kNames + length + 6, y + 13, "start", label_of(figures));
}

/// The grid behind the bars, with its percentages above.
std::string axis(double x, double top, double bottom) {
    std::string svg;
    for (const double percent : {0.001, 0.01, 0.1, 1.0, 10.0}) {
        const double place = x + kNames + bar_length(percent);
        svg += fmt::format("<line x1=\"{0:.1f}\" y1=\"{1:.1f}\" x2=\"{0:.1f}\" y2=\"{2:.1f}\" "
                           "stroke=\"#dddddd\"/>\n",
                           place, top, bottom);
        svg += svg_text(place, top - 5, "middle", fmt::format("{:g}", percent),
                        " font-size=\"10\" fill=\"#666666\"");
    }
    return svg;
}

std::string panel_of(const Model& model, double x, double y) {
    std::string svg =
        svg_text(x + kNames, y + 16, "start", model.name, " font-size=\"15\" font-weight=\"bold\"");
    svg += svg_text(x + kNames, y + 32, "start",
                    fmt::format("{} faces; {}", model.result.face_count, model.what), " fill=\"#666666\"");
    const double bottom = y + kHead + kRow * static_cast<double>(model.result.systems.size());
    svg += axis(x, y + kHead - 4, bottom);
    double row = y + kHead;
    for (const Figures& figures : model.result.systems) {
        svg += row_of(figures, x, row);
        row += kRow;
    }
    return svg;
}

} // namespace

std::string verdict_figure(std::span<const Model> models, std::size_t byte_budget) {
    std::size_t most_rows = 0;
    for (const Model& model : models) most_rows = std::max(most_rows, model.result.systems.size());
    const double panel_height = kHead + kRow * static_cast<double>(most_rows) + kGap;
    const std::size_t down = (models.size() + kAcross - 1) / kAcross;
    constexpr double kTitle = 40;
    const double width = kAcross * kPanel, height = kTitle + panel_height * static_cast<double>(down);
    std::string svg = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
        "font-family=\"sans-serif\" font-size=\"12\" fill=\"#222222\">\n"
        "<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n",
        width, height);
    svg += svg_text(width / 2, 26, "middle",
                    fmt::format("Particles near the surface on the wrong side, %, each system in {:.2f} MB",
                                1e-6 * static_cast<double>(byte_budget)),
                    " font-size=\"17\" font-weight=\"bold\"");
    for (std::size_t k = 0; k < models.size(); ++k)
        svg += panel_of(models[k], kPanel * static_cast<double>(k % kAcross),
                        kTitle + panel_height * static_cast<double>(k / kAcross));
    return svg + "</svg>\n";
}
