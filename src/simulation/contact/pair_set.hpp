#pragma once

#include "geometry/workers.hpp"
#include "simulation/particles.hpp"
#include "simulation/state/state_archive.hpp"
#include "simulation/surfaces/elements.hpp"
#include "simulation/surfaces/near_elements.hpp"
#include "simulation/surfaces/separation.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// The pairs of a vertex and a face or of two edges, of a deformable's surface and an obstacle or of the
/// surface and itself, that could meet in a step, and how far apart they are.
///
/// Pairs are found along straight displacements from where all are safe. One that is not listed is farther
/// apart than the reach at both ends of the displacements, on the same side along an axis; so it does not
/// meet as long as every vertex ends within covered() of where it was expected.
class PairSet {
  public:
    /// Of the surface and an obstacle. Both outlive this.
    PairSet(const Elements& own, const Elements& obstacle);
    /// Of the surface and itself.
    explicit PairSet(const Elements& own);

    /// All lengths: pairs that come so near are listed.
    void set_reach(float reach) { reach_ = reach; }
    float reach() const { return reach_; }
    /// How far the end of a vertex may be from where it was expected.
    float covered() const { return reach_ / 4; }

    /// The pairs that come near on the displacements, instead of those before. Of itself both are the
    /// surface's.
    void list(const PointArrays& own_from, const PointArrays& own_to, const PointArrays& obstacle_from,
              const PointArrays& obstacle_to, const Workers& workers);
    /// Measures all pairs at these places.
    void measure(const PointArrays& own, const PointArrays& obstacle, const Workers& workers);

    /// Takes those of another set of the same surfaces.
    void set_pairs(std::span<const Pair> pairs) { pairs_.assign(pairs.begin(), pairs.end()); }
    void archive(StateArchive& state);

    bool is_of_itself() const { return own_ == obstacle_; }
    std::span<const Pair> pairs() const { return pairs_; }
    /// [pairs().size()] after measure()
    std::span<const Separation> separations() const { return separations_; }
    /// Of a pair, the points that are the deformable's: all four of itself.
    std::size_t moving_count(const Pair& pair) const { return is_of_itself() ? 4 : own_count(pair.kind); }

  private:
    void add_pairs(const std::array<std::uint32_t, 2>& elements, std::vector<Pair>& pairs) const;
    void add_vertex_face(std::uint32_t vertex, const Element& face, bool is_own_vertex,
                         std::vector<Pair>& pairs) const;

    const Elements* own_;
    const Elements* obstacle_;
    float reach_ = 0;
    MovingTree own_tree_, obstacle_tree_; ///< the second unused of itself
    const PointArrays *own_from_ = nullptr, *own_to_ = nullptr;
    const PointArrays *obstacle_from_ = nullptr, *obstacle_to_ = nullptr;  ///< while pairs are listed
    std::vector<std::vector<std::array<std::uint32_t, 2>>> near_elements_; ///< by worker
    PiecewiseList<Pair> found_;
    std::vector<Pair> pairs_;
    std::vector<Separation> separations_;
};

} // namespace echinus
