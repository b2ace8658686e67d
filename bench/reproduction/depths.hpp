#pragma once

#include "page.hpp"
#include "subject.hpp"

#include <span>

/// How much longer the radial push-out is than the shortest way out, for particles that are inside and found
/// to be. Adds the table depths with a row for each subject.
void measure_depths(std::span<const Subject> subjects, Values& values);
