#pragma once

#include "page.hpp"
#include "subject.hpp"

#include <span>

/// The systems that the paper compares its map with, at its settings: superquadric maps of 17 segments for a
/// horse and 12 for the torus, 200 x 200 samples each, and distance fields of 200 samples along the longest
/// side. Adds the tables rivals.superquadrics (a sentence instead where this build has none), rivals.fields
/// and rivals.speed.
void measure_rivals(std::span<const Subject> subjects, Values& values);
