#pragma once

#include "common/system.hpp"

#include <cstdint>
#include <span>

/// One way to ask a system which particles are inside.
struct ContainsWay {
    std::string name;
    /// @param points  [n]
    /// @param inside  [n] out: not 0 inside
    std::function<void(std::span<const echinus::Vec3f> points, std::span<std::uint8_t> inside)> answer;
    bool as_whole = false; ///< gains by the number of particles in a call: never asked for parts of a set
};

/// A system in the task "contains": the sign of every particle.
class ContainsSystem : public Structure {
  public:
    /// After build(); they live as long as the system.
    virtual std::vector<ContainsWay> ways() = 0;
};

using ContainsList = std::vector<Listed<ContainsSystem>>;

// A function for each file beside this one.
void list_exact_map(ContainsList& list);
void list_distance_map(ContainsList& list);
void list_floors(ContainsList& list);
void list_dense_grid(ContainsList& list);
void list_classified_grid(ContainsList& list);
void list_nanovdb(ContainsList& list);
void list_openvdb(ContainsList& list);
void list_embree(ContainsList& list);
void list_cgal(ContainsList& list);
void list_bullet(ContainsList& list);
void list_fcl(ContainsList& list);

// The same in several sizes, from small to large.
void list_sizes_of_exact_map(ContainsList& list);
void list_sizes_of_distance_map(ContainsList& list);
void list_sizes_of_dense_grid(ContainsList& list);
void list_sizes_of_classified_grid(ContainsList& list);

/// The rivals that this build has, in the order of the tables.
[[gnu::visibility("default")]] void list_contains_rivals(ContainsList& list);

/// Those of them that come in sizes.
[[gnu::visibility("default")]] void list_sizes_of_contains_rivals(ContainsList& list);
