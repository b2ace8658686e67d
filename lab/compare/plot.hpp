#pragma once

#include <string>
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

/// Exponent b of y = a x^b by least squares of the logarithms, from the points with x >= from.
double fitted_exponent(const std::vector<PlotPoint>& points, double from = 0);

} // namespace echinus::comparison
