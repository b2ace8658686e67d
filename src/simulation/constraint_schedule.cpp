#include "simulation/constraint_schedule.hpp"

#include <algorithm>
#include <utility>

namespace echinus {

namespace {

/// Finds where pieces end and phases begin.
class Cutter {
  public:
    Cutter(const ConstraintParticles& constraints, std::size_t least)
        : constraints_(constraints), least_(least), piece_at_(constraints.particle_count(), 0) {}

    ConstraintPieces cut() {
        if (constraints_.count() > 0) begin_piece(0);
        for (std::size_t i = 0; i < constraints_.count(); ++i) {
            if (pieces_.back().count >= least_ && is_new_ground(i)) begin_piece(i);
            add(i);
        }
        return {std::move(pieces_), std::move(phases_)};
    }

  private:
    /// Pieces count from 1.
    std::size_t number() const { return pieces_.size(); }

    void begin_piece(std::size_t first) {
        pieces_.push_back({first, 0});
        if (phases_.empty()) phases_.push_back({0, 0});
        ++phases_.back().count;
    }
    /// Do this constraint and the next ones have no particle of this piece?
    bool is_new_ground(std::size_t first) const {
        const std::size_t end = std::min(first + kConstraintsPerPack, constraints_.count());
        for (std::size_t i = first; i < end; ++i)
            for (const std::uint32_t particle : constraints_.of(i))
                if (piece_at_[particle] == number()) return false;
        return true;
    }
    void add(std::size_t i) {
        ++pieces_.back().count;
        for (const std::uint32_t particle : constraints_.of(i)) {
            const std::size_t other = std::exchange(piece_at_[particle], number());
            if (other != number() && other > phases_.back().first) begin_phase();
        }
    }
    /// With this piece.
    void begin_phase() {
        --phases_.back().count;
        phases_.push_back({pieces_.size() - 1, 1});
    }

    const ConstraintParticles& constraints_;
    std::size_t least_;
    std::vector<std::size_t> piece_at_; ///< the last one that has the particle, 0: none
    std::vector<ConstraintRun> pieces_, phases_;
};

/// What no phase shares is not worth cutting.
ConstraintPieces with_single_pieces_joined(const ConstraintPieces& cut) {
    ConstraintPieces joined;
    bool was_single = false;
    for (const ConstraintRun& phase : cut.phases) {
        const bool is_single = phase.count == 1;
        if (is_single && was_single) {
            joined.pieces.back().count += cut.pieces[phase.first].count;
            continue;
        }
        was_single = is_single;
        joined.phases.push_back({joined.pieces.size(), phase.count});
        for (std::size_t i = 0; i < phase.count; ++i) joined.pieces.push_back(cut.pieces[phase.first + i]);
    }
    return joined;
}

} // namespace

ConstraintPieces independent_pieces(const ConstraintParticles& constraints, std::size_t per_slab) {
    // Some of a slab may be missing.
    return with_single_pieces_joined(Cutter(constraints, per_slab / 2).cut());
}

std::vector<ConstraintRun> disjoint_runs(const ConstraintParticles& constraints, const ConstraintRun& piece,
                                         DisjointRun& particles) {
    std::vector<ConstraintRun> runs;
    for (std::size_t first = piece.first, end = piece.first + piece.count; first < end;) {
        particles.begin();
        std::size_t next = first;
        while (next < end && particles.add(constraints.of(next))) ++next;
        runs.push_back({first, whole_packs(next - first)});
        first += runs.back().count;
    }
    return runs;
}

ConstraintSchedule<ConstraintRun> schedule_of(const ConstraintParticles& constraints, std::size_t per_slab) {
    DisjointRun particles(constraints.particle_count());
    return ConstraintSchedule<ConstraintRun>::of(
        independent_pieces(constraints, per_slab),
        [&](const ConstraintRun& piece) { return disjoint_runs(constraints, piece, particles); });
}

} // namespace echinus
