#pragma once

#include "page.hpp"
#include "subject.hpp"

#include <span>

/// How often the paper's map is wrong about inside and outside, for every correction, pole axis and number of
/// directions. Adds to `values` the tables NAME.signs.short and NAME.signs.all, and NAME.few for the share of
/// queries in whose interpolation fewer than three samples take part.
void measure_signs(const Subject& subject, Values& values);

/// How the share of wrong signs on C depends on how deep the sheet cuts in. Adds the table smoothing.
void measure_smoothing(std::span<const Subject> subjects, Values& values);
