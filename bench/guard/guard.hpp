#pragma once

#include "measurements.hpp"

/// Ratios of our times to those of Embree, the dense grid and CGAL, from systems that take turns: what
/// scripts/bench --quick compares. Columns mesh, task, system, set, against, ratio, spread.
Records measure_ratios(const Setting& setting);

/// What got slower or faster, a sentence each.
struct GuardVerdict {
    std::vector<std::string> slower, faster, unknown; ///< unknown: not in the record, or in it alone
};

/// A system is slower at a task when each of its ratios there is: by more than a tenth, and by more than
/// three times the spread of both measurements. So a rival that had a bad moment raises no alarm.
GuardVerdict compare_ratios(const Records& recorded, const Records& measured);
