#pragma once

#include "models.hpp"

#include <span>
#include <string>

/// The verdict in one figure, as an SVG document: for each model a panel, in it for each system a bar of the
/// share of particles near the surface that it puts on the wrong side. Bars on a logarithmic axis; none for
/// nothing wrong. A system that takes more than the budget has its bytes beside it.
std::string verdict_figure(std::span<const Model> models, std::size_t byte_budget);
