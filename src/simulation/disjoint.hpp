#pragma once

#include "geometry/workers.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

/// Constraints without a common particle may be relaxed at once: that gives the same bits as one after the
/// other.
namespace echinus {

/// Orders constraints in groups without a common particle: each goes to the first of 64 groups that has none
/// of its particles, and what fits into none of them comes last. Within a group their order stays.
/// @param particles_of  gives a constraint's particles as an array
template <typename Constraint, typename ParticlesOf>
void order_in_disjoint_groups(std::vector<Constraint>& constraints, std::size_t particle_count,
                              const ParticlesOf& particles_of) {
    constexpr std::size_t kGroups = 64;
    std::vector<std::uint64_t> groups_at(particle_count, 0); ///< of each particle, as bits
    std::array<std::vector<Constraint>, kGroups + 1> groups;
    for (const Constraint& constraint : constraints) {
        std::uint64_t taken = 0;
        for (const std::uint32_t i : particles_of(constraint)) taken |= groups_at[i];
        const auto group = static_cast<std::size_t>(std::countr_one(taken));
        groups[group].push_back(constraint);
        if (group == kGroups) continue;
        for (const std::uint32_t i : particles_of(constraint)) groups_at[i] |= std::uint64_t{1} << group;
    }
    constraints.clear();
    for (const auto& group : groups) constraints.insert(constraints.end(), group.begin(), group.end());
}

/// Particles that a run of constraints has used so far.
class DisjointRun {
  public:
    explicit DisjointRun(std::size_t particle_count) : last_run_(particle_count, 0) {}

    void begin() { ++run_; }
    /// @return false if one of them is in the run already; then nothing changes
    template <std::size_t n>
    bool add(const std::array<std::uint32_t, n>& particles) {
        const auto is_used = [&](std::uint32_t i) { return last_run_[i] == run_; };
        if (std::any_of(particles.begin(), particles.end(), is_used)) return false;
        for (const std::uint32_t i : particles) last_run_[i] = run_;
        return true;
    }

  private:
    std::vector<std::size_t> last_run_; ///< of each particle; runs count from 1
    std::size_t run_ = 1;
};

/// Consecutive constraints without a common particle.
struct ConstraintRun {
    std::size_t first, count;
};

/// Cuts constraints into runs, in their order.
/// @param particles_of  gives the particles of the constraint of a number, as an array
template <typename ParticlesOf>
std::vector<ConstraintRun> disjoint_runs(std::size_t constraint_count, std::size_t particle_count,
                                         const ParticlesOf& particles_of) {
    std::vector<ConstraintRun> runs;
    DisjointRun particles(particle_count);
    for (std::size_t i = 0; i < constraint_count; ++i) {
        if (runs.empty() || !particles.add(particles_of(i))) {
            runs.push_back({i, 0});
            particles.begin();
            particles.add(particles_of(i));
        }
        ++runs.back().count;
    }
    return runs;
}

/// Calls relax(part) for parts of a run that are as long as a piece of work, on several threads.
/// @param piece_size  a multiple of the lanes of every instruction set
template <typename Relax>
void for_parts_of(const ConstraintRun& run, std::size_t piece_size, const Workers& workers,
                  const Relax& relax) {
    workers.for_ranges(run.count, piece_size,
                       [&](std::size_t, std::size_t, std::size_t begin, std::size_t end) {
                           relax(ConstraintRun{run.first + begin, end - begin});
                       });
}

} // namespace echinus
