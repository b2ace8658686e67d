#include "compare/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

namespace echinus::comparison {

namespace {

constexpr double kWidth = 720, kHeight = 440;
constexpr double kLegendWidth = 230; // beside the diagram
constexpr double kLeft = 80, kRight = 24, kTop = 48, kBottom = 60;

/// One logarithmic axis, from numbers to places on the page.
class Axis {
  public:
    Axis(double low, double high, double place_of_low, double place_of_high)
        : low_(std::log10(low) - kMargin), high_(std::log10(high) + kMargin), place_of_low_(place_of_low),
          place_of_high_(place_of_high) {}

    double place(double value) const {
        return place_of_low_ + (place_of_high_ - place_of_low_) * (std::log10(value) - low_) / (high_ - low_);
    }

    /// 1, 2 and 5 times the powers of ten; on a long axis the powers alone.
    std::vector<double> ticks() const {
        std::vector<double> result;
        for (int power = static_cast<int>(std::floor(low_)); power <= std::ceil(high_); ++power)
            for (const double digit : {1.0, 2.0, 5.0}) {
                const double tick = std::log10(digit) + power;
                if (tick < low_ || tick > high_ || (digit != 1 && high_ - low_ > 2.5)) continue;
                result.push_back(digit * std::pow(10, power));
            }
        return result;
    }

  private:
    static constexpr double kMargin = 0.06;
    double low_, high_, place_of_low_, place_of_high_;
};

std::string number(double value) {
    if (value >= 999'999) return fmt::format("{:.3g} M", value / 1e6);
    if (value >= 999) return fmt::format("{:.3g} k", value / 1e3);
    return fmt::format("{:.3g}", value);
}

std::string line(double x1, double y1, double x2, double y2, const std::string& style) {
    return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n", x1, y1, x2, y2,
                       style);
}

std::string stroke_of(const Curve& curve) {
    return fmt::format("stroke=\"{}\" stroke-width=\"2\" fill=\"none\"{}", curve.colour,
                       curve.dashed ? " stroke-dasharray=\"8 5\"" : "");
}

std::string disc(double x, double y, const std::string& colour) {
    return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\" fill=\"{}\"/>\n", x, y, colour);
}

std::string ring(double x, double y, const std::string& colour) {
    return fmt::format(
        "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"8\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"/>\n", x,
        y, colour);
}

std::string frame(const Plot& plot, const Axis& x, const Axis& y) {
    const std::string grid = "stroke=\"#dddddd\"";
    std::string result;
    for (const double tick : x.ticks()) {
        result += line(x.place(tick), kTop, x.place(tick), kHeight - kBottom, grid);
        result += svg_text(x.place(tick), kHeight - kBottom + 18, "middle", number(tick));
    }
    for (const double tick : y.ticks()) {
        result += line(kLeft, y.place(tick), kWidth - kRight, y.place(tick), grid);
        result += svg_text(kLeft - 8, y.place(tick) + 4, "end", number(tick));
    }
    result += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" "
                          "stroke=\"#444444\"/>\n",
                          kLeft, kTop, kWidth - kLeft - kRight, kHeight - kTop - kBottom);
    result += svg_text(kWidth / 2, 26, "middle", plot.title, " font-size=\"16\" font-weight=\"bold\"");
    result += svg_text((kLeft + kWidth - kRight) / 2, kHeight - 16, "middle", plot.x_label);
    const double middle = (kTop + kHeight - kBottom) / 2;
    return result + svg_text(20, middle, "middle", plot.y_label,
                             fmt::format(" transform=\"rotate(-90 20 {:.1f})\"", middle));
}

std::string drawn(const Curve& curve, const Axis& x, const Axis& y) {
    std::string result = "<polyline points=\"";
    for (const PlotPoint& p : curve.points)
        result += fmt::format("{:.1f},{:.1f} ", x.place(p.x), y.place(p.y));
    result += fmt::format("\" {}/>\n", stroke_of(curve));
    if (curve.dotted_points)
        for (const PlotPoint& p : curve.points) result += disc(x.place(p.x), y.place(p.y), curve.colour);
    for (const PlotPoint& p : curve.ringed) result += ring(x.place(p.x), y.place(p.y), curve.colour);
    return result;
}

/// Beside the diagram, where it hides nothing.
std::string legend(const Plot& plot) {
    constexpr double kBegin = kWidth - kRight + 14;
    double y = kTop + 10;
    std::string result;
    for (const Curve& curve : plot.curves) {
        if (curve.points.size() > 1)
            result += line(kBegin, y - 4, kBegin + 40, y - 4, stroke_of(curve));
        else
            result += disc(kBegin + 20, y - 4, curve.colour);
        result += svg_text(kBegin + 48, y, "start", curve.name);
        y += 18;
    }
    if (!plot.ring_meaning.empty())
        result += ring(kBegin + 20, y - 4, "#444444") + svg_text(kBegin + 48, y, "start", plot.ring_meaning);
    return result;
}

} // namespace

std::string svg(const Plot& plot) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    PlotPoint low{kInfinity, kInfinity}, high{0, 0};
    for (const Curve& curve : plot.curves)
        for (const PlotPoint& p : curve.points) {
            low = {std::min(low.x, p.x), std::min(low.y, p.y)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y)};
        }
    if (high.x == 0) low = high = {1, 1}; // there is no point
    const Axis x(low.x, high.x, kLeft, kWidth - kRight);
    const Axis y(low.y, high.y, kHeight - kBottom, kTop);
    std::string result =
        fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
                    "height=\"{1}\" font-family=\"sans-serif\" font-size=\"12\" fill=\"#222222\">\n"
                    "<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n",
                    kWidth + kLegendWidth, kHeight);
    result += frame(plot, x, y);
    for (const Curve& curve : plot.curves) result += drawn(curve, x, y);
    return result + legend(plot) + "</svg>\n";
}

std::string escaped(std::string_view plain) {
    std::string result;
    for (const char c : plain) {
        if (c == '&')
            result += "&amp;";
        else if (c == '<')
            result += "&lt;";
        else if (c == '>')
            result += "&gt;";
        else if (c == '"')
            result += "&quot;";
        else
            result += c;
    }
    return result;
}

std::string svg_text(double x, double y, std::string_view anchor, std::string_view content,
                     std::string_view more) {
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>\n", x, y, anchor, more,
                       escaped(content));
}

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
