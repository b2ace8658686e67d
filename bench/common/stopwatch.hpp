#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

/// Processor time of the shortest of several calls: what other programs on the machine add, through shared
/// caches and the clock rate, it is nearly free of.
double shortest_seconds(int repetitions, const std::function<void()>& body);

/// Does its work for items [begin, end).
using Contestant = std::function<void(std::size_t begin, std::size_t end)>;

/// Nanoseconds per item for each contestant. They take turns at blocks of items, several times over, there
/// and back, so that nobody always finds the caches as another left them; of a block's times the shortest
/// counts.
std::vector<double> race(std::size_t item_count, int repetitions, std::span<const Contestant> contestants);
