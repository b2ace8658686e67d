#pragma once

#include "common/comparison.hpp"
#include "contains/system.hpp"

/// Ours and the rivals, in the order of the tables.
ContainsList all_contains_systems();

/// Those that come in sizes.
ContainsList all_contains_sizes();

/// A structure of each system that takes part, and the ways to ask them.
class ContainsField {
  public:
    /// @param one_way  only the first way of each system, which is its best
    ContainsField(const Subject& subject, std::size_t point_count, const ContainsList& systems,
                  bool one_way = false);

    const std::vector<Competitor>& competitors() const { return competitors_; }

  private:
    std::vector<std::unique_ptr<ContainsSystem>> systems_; // which the competitors refer to
    std::vector<Competitor> competitors_;
};
