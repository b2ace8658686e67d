#pragma once

#include "geometry/workers.hpp"
#include "simulation/constraint_particles.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace echinus {

/// Lanes of the widest instruction set.
inline constexpr std::size_t kConstraintsPerPack = 16;

/// Runs that are as long as a pack have no remainder: that begins the next one.
inline std::size_t whole_packs(std::size_t count) {
    return count < kConstraintsPerPack ? count : count / kConstraintsPerPack * kConstraintsPerPack;
}

/// Consecutive constraints, or others of a row.
struct ConstraintRun {
    std::size_t first, count;
};

/// Particles that a run of constraints has used so far.
class DisjointRun {
  public:
    explicit DisjointRun(std::size_t particle_count) : last_run_(particle_count, 0) {}

    void begin() { ++run_; }
    /// @return false if one of them is in the run already; then nothing changes
    template <typename ParticlesOfOne>
    bool add(const ParticlesOfOne& particles) {
        const auto is_used = [&](std::uint32_t i) { return last_run_[i] == run_; };
        if (std::any_of(particles.begin(), particles.end(), is_used)) return false;
        for (const std::uint32_t i : particles) last_run_[i] = run_;
        return true;
    }

  private:
    std::vector<std::size_t> last_run_; ///< of each particle; runs count from 1
    std::size_t run_ = 1;
};

/// Which of the constraints, in the order in which they stand, may be relaxed at once: all that does not
/// change the bits. Pieces of a phase have no particle in common, and phases follow one another.
struct ConstraintPieces {
    std::vector<ConstraintRun> pieces;
    std::vector<ConstraintRun> phases; ///< of pieces
};

/// Finds the slabs of relaxation_order(), also where some constraints are missing. In any other order most
/// phases are of one piece.
/// @param per_slab  as it was ordered
ConstraintPieces independent_pieces(const ConstraintParticles& constraints, std::size_t per_slab);

/// Cuts a piece where a constraint shares a particle with an earlier one of its run.
std::vector<ConstraintRun> disjoint_runs(const ConstraintParticles& constraints, const ConstraintRun& piece,
                                         DisjointRun& particles);

/// The runs of each piece.
template <typename Run>
struct ConstraintSchedule {
    std::vector<Run> runs;
    std::vector<ConstraintRun> pieces; ///< of runs
    std::vector<ConstraintRun> phases; ///< of pieces

    /// @param runs_of  gives the runs of a piece
    template <typename RunsOf>
    static ConstraintSchedule of(const ConstraintPieces& all, const RunsOf& runs_of) {
        ConstraintSchedule schedule;
        schedule.phases = all.phases;
        for (const ConstraintRun& piece : all.pieces) {
            const std::vector<Run> runs = runs_of(piece);
            schedule.pieces.push_back({schedule.runs.size(), runs.size()});
            schedule.runs.insert(schedule.runs.end(), runs.begin(), runs.end());
        }
        return schedule;
    }

    /// Calls relax(run) for all, with the bits of their order.
    template <typename Relax>
    void for_each_run(const Workers& workers, const Relax& relax) const {
        for (const ConstraintRun& phase : phases)
            workers.for_pieces(phase.count, [&](std::size_t, std::size_t number) {
                const ConstraintRun& piece = pieces[phase.first + number];
                for (std::size_t i = 0; i < piece.count; ++i) relax(runs[piece.first + i]);
            });
    }
};

/// With the pieces' disjoint runs. @param per_slab  as they were ordered
ConstraintSchedule<ConstraintRun> schedule_of(const ConstraintParticles& constraints, std::size_t per_slab);

} // namespace echinus
