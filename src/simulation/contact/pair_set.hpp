#pragma once

#include "geometry/workers.hpp"
#include "simulation/contact/thresholds.hpp"
#include "simulation/particles.hpp"
#include "simulation/state/state_archive.hpp"
#include "simulation/surfaces/elements.hpp"
#include "simulation/surfaces/near_elements.hpp"
#include "simulation/surfaces/near_pairs.hpp"
#include "simulation/surfaces/separation.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace echinus {

/// The pairs of a vertex and a face or of two edges that could meet in a step, and their distances. They are
/// pairs of a deformable's surface and an obstacle, or of the surface and itself.
///
/// Pairs are listed along straight displacements from a safe state. A pair that is not listed is farther
/// apart than the reach at both ends of the displacements, on the same side along an axis; so it does not
/// meet as long as every vertex ends within covered() of its expected position. Of the listed pairs, only
/// those that the displacements since then may have brought near are measured again.
class PairSet {
  public:
    /// @param own_places, obstacle_places  positions by which nearby elements are grouped
    PairSet(std::shared_ptr<const Elements> own, const PointArrays& own_places,
            std::shared_ptr<const Elements> obstacle, const PointArrays& obstacle_places);
    /// The pairs of the surface and itself.
    PairSet(std::shared_ptr<const Elements> own, const PointArrays& places);

    /// Sets the distance within which pairs are listed; all lengths are in its unit.
    void set_reach(float reach) { reach_ = reach; }
    /// How far a vertex may end from its expected position.
    float covered() const { return reach_ * threshold::kCoveredShare; }

    /// The displacements of the surface and of the obstacle; for the surface and itself, both are the
    /// surface's. An obstacle never moves if it has the same array twice.
    struct Displacements {
        const PointArrays &own_from, &own_to, &obstacle_from, &obstacle_to;
    };
    /// Lists the pairs that come near during the displacements, and measures them at the beginning.
    /// @param is_other  [vertex] 1 for vertices whose displacements have changed: their pairs are searched,
    /// and those of other vertices stay listed
    /// @param starts_there  whether the displacements begin where the listed ones begin: then all pairs stay
    /// listed, so that a search for positions that the list covers terminates
    void list(const Displacements& displacements, std::span<const std::uint8_t> is_other, bool starts_there,
              const Workers& workers);

    /// The obstacle has moved since pairs were listed.
    void forget_obstacle() { obstacle_stands_ = false; }
    /// The course of the surface's vertices: their positions when pairs were listed, their positions now, and
    /// the ends of two displacements from there.
    struct Course {
        const PointArrays &listed, &now, &base, &goal;
        /// [vertex] the most that it has moved since then, and that both displacements lead it.
        std::span<const float> strayed, ahead;
    };
    /// Measures the pairs that may be nearer than `near`, and those whose gaps the displacements may close by
    /// half.
    /// @param is_elsewhere  whether vertices have moved since the last call; if not, earlier measurements are
    /// kept
    void measure(const Course& course, const PointArrays& obstacle, float near, bool is_elsewhere,
                 const Workers& workers);

    void archive(StateArchive& state);

    bool is_of_itself() const { return own_ == obstacle_; }
    /// The pairs that were measured.
    std::span<const Pair> pairs() const { return near_; }
    /// [pairs().size()]
    std::span<const Separation> separations() const { return separations_; }
    std::size_t listed_count() const { return listed_.size(); }
    /// The number of points of a pair that belong to the deformable: all four for the surface and itself.
    std::size_t moving_count(const Pair& pair) const { return is_of_itself() ? 4 : own_count(pair.kind); }

  private:
    void find_pairs(const Displacements& displacements, const Workers& workers);
    void list_measured(const Displacements& displacements, std::size_t kept_count);
    float nearer_by(const Pair& pair, const Course& course) const;
    void measure_new(const PointArrays& own, const PointArrays& obstacle, const Workers& workers);

    std::shared_ptr<const Elements> own_, obstacle_;
    float reach_ = 0;
    MovingTree own_tree_, obstacle_tree_; ///< the second is unused for the surface and itself
    bool obstacle_stands_ = false;        ///< whether its tree is up to date
    std::vector<std::vector<std::array<std::uint32_t, 2>>> near_elements_; ///< by worker
    PiecewiseList<Pair> found_;
    std::vector<Pair> listed_;
    std::vector<float> listed_gaps_; ///< at the beginning of the displacements; ascending up to gap_step_
    float gap_step_ = 0;
    std::vector<std::uint8_t> is_near_; ///< [listed] 1 for pairs in near_
    std::vector<Pair> near_;
    std::vector<Separation> separations_;
};

/// How far displacements close a pair along its normal.
float closing_of(const Pair& pair, const Vec3f& normal, const PairSet::Displacements& displacements);

} // namespace echinus
