#pragma once

#include "geometry/workers.hpp"
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

/// The pairs of a vertex and a face or of two edges, of a deformable's surface and an obstacle or of the
/// surface and itself, that could meet in a step, and how far apart they are.
///
/// Pairs are listed along straight displacements from where all are safe. One that is not listed is farther
/// apart than the reach at both ends of the displacements, on the same side along an axis; so it does not
/// meet as long as every vertex ends within covered() of where it was expected. Of those that are listed,
/// only those are measured again that the displacements since then may have brought near.
class PairSet {
  public:
    /// @param own_places, obstacle_places  by which elements that are near each other are grouped
    PairSet(std::shared_ptr<const Elements> own, const PointArrays& own_places,
            std::shared_ptr<const Elements> obstacle, const PointArrays& obstacle_places);
    /// Of the surface and itself.
    PairSet(std::shared_ptr<const Elements> own, const PointArrays& places);

    /// All lengths: pairs that come so near are listed.
    void set_reach(float reach) { reach_ = reach; }
    /// How far the end of a vertex may be from where it was expected.
    float covered() const { return reach_ / 4; }

    /// Displacements of the surface and of the obstacle; of itself both are the surface's. An obstacle with
    /// the same array twice never moves.
    struct Displacements {
        const PointArrays &own_from, &own_to, &obstacle_from, &obstacle_to;
    };
    /// Lists the pairs that come near on the displacements, and measures them where the displacements begin.
    /// @param is_other  [vertex] 1 for those whose displacements have become others: their pairs are looked
    /// for, and those of other vertices stay listed
    /// @param starts_there  whether the displacements begin where those did that are listed: then all pairs
    /// stay listed, so that a search for ends that the list covers comes to an end
    void list(const Displacements& displacements, std::span<const std::uint8_t> is_other, bool starts_there,
              const Workers& workers);

    /// The obstacle is elsewhere than when pairs were listed.
    void forget_obstacle() { obstacle_stands_ = false; }
    /// The course of the surface's vertices: where their pairs were listed, where they are now, and where two
    /// displacements lead from there.
    struct Course {
        const PointArrays &listed, &now, &base, &goal;
        std::span<const float> strayed, ahead; ///< [vertex] how far, at most, and along both
    };
    /// Measures the pairs that may be nearer than `near`, or of which displacements may close half of the
    /// gap.
    /// @param is_elsewhere  whether vertices have moved since the last call; else what was measured stays
    void measure(const Course& course, const PointArrays& obstacle, float near, bool is_elsewhere,
                 const Workers& workers);

    void archive(StateArchive& state);

    bool is_of_itself() const { return own_ == obstacle_; }
    /// Those that were measured.
    std::span<const Pair> pairs() const { return near_; }
    /// [pairs().size()]
    std::span<const Separation> separations() const { return separations_; }
    std::size_t listed_count() const { return listed_.size(); }
    /// Of a pair, the points that are the deformable's: all four of itself.
    std::size_t moving_count(const Pair& pair) const { return is_of_itself() ? 4 : own_count(pair.kind); }

  private:
    void find_pairs(const Displacements& displacements, const Workers& workers);
    void list_measured(const Displacements& displacements, std::size_t kept_count);
    float closing_of(const Pair& pair, const Vec3f& normal, const Displacements& displacements) const;
    float nearer_by(const Pair& pair, const Course& course) const;
    void measure_new(const PointArrays& own, const PointArrays& obstacle, const Workers& workers);

    std::shared_ptr<const Elements> own_, obstacle_;
    float reach_ = 0;
    MovingTree own_tree_, obstacle_tree_;                                  ///< the second unused of itself
    bool obstacle_stands_ = false;                                         ///< is its tree up to date?
    std::vector<std::vector<std::array<std::uint32_t, 2>>> near_elements_; ///< by worker
    PiecewiseList<Pair> found_;
    std::vector<Pair> listed_;
    std::vector<float> listed_gaps_; ///< where the displacements began; within a step ascending
    float gap_step_ = 0;
    std::vector<std::uint8_t> is_near_; ///< [listed] 1 for those that are in near_
    std::vector<Pair> near_;
    std::vector<Separation> separations_;
};

} // namespace echinus
