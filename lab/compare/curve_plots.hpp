#pragma once

#include "compare/compare.hpp"
#include "compare/plot.hpp"

#include <string>
#include <vector>

namespace echinus::comparison {

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
