#pragma once

#include "compare/compare.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace echinus::comparison {

/// A point of a curve, in the units of the axes.
struct PlotPoint {
    double x, y;
};

struct Curve {
    std::string name; ///< for the legend
    std::vector<PlotPoint> points;
    std::string colour; ///< as SVG writes it
    bool dashed = false;
    bool dotted_points = true;       ///< a disc at each point
    std::vector<PlotPoint> ringed{}; ///< points that stand out, such as a default
};

/// A diagram with two logarithmic axes.
struct Plot {
    std::string title;
    std::string x_label, y_label; ///< with units
    std::vector<Curve> curves;
    std::string ring_meaning{}; ///< for the legend; empty when no point is ringed
};

/// The diagram as an SVG document on white paper, readable in front of any background. The same numbers give
/// the same bytes.
/// @pre coordinates are positive
std::string svg(const Plot& plot);

/// As text or as the value of an attribute, in HTML and in SVG.
std::string escaped(std::string_view plain);

/// A line of text in a picture.
/// @param anchor  which part of it lies at (x, y): "start", "middle" or "end"
/// @param more    further attributes, with a space in front
std::string svg_text(double x, double y, std::string_view anchor, std::string_view content,
                     std::string_view more = {});

/// The SVG colour of a system in all plots; distinguishable with every common kind of colour blindness.
/// Dashed: not a map of Echinus.
struct LineStyle {
    std::string colour;
    bool dashed;
};
LineStyle line_style_of(const SystemType& system);

/// Near the surface (the set S), each system a curve over its sizes: error against bytes and time against
/// error, of signs and of depths. An error of 0 is drawn at the edge, as noted on the axis.
/// @pre comparison.curves is not empty
std::vector<Plot> curve_plots(const Comparison& comparison);

} // namespace echinus::comparison
