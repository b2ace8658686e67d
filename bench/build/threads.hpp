#pragma once

#include "build/system.hpp"
#include "common/subjects.hpp"

/// Adds batches of queries on one thread and on two, for the table of what a second core brings.
void list_batches(std::vector<BuildWay>& ways, const Subject& subject, std::size_t point_count);
