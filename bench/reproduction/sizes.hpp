#pragma once

#include "page.hpp"
#include "subject.hpp"

/// The bytes of a subject's map in three layouts and for every pole axis, and how long it takes to build.
/// Adds the table NAME.sizes.
void measure_sizes(const Subject& subject, Values& values);

/// What a torus's map would take in the layout of the paper, by the thickness of its tube, which the paper
/// does not tell. Adds the table torus_shapes.
void measure_torus_shapes(Values& values);
