#pragma once
#include "geometry/workers.hpp"
#include "simulation/particles.hpp"
#include "simulation/surfaces/element_tree.hpp"
#include "simulation/surfaces/elements.hpp"
#include "simulation/surfaces/near_elements.hpp"
#include "simulation/surfaces/pair_lists.hpp"
#include "simulation/surfaces/shares.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// A model's surface, in the frame in which everything is said here. Unless it deforms, it rests there.
struct Opponent {
    const Elements* elements;
    const ElementTree* tree; ///< where it deforms, of the ways of its elements
    const PointArrays* positions;
    /// Where it deforms: its vertices go straight from the positions to here, none farther than `most`, as
    /// the deformable's do to their bases.
    const PointArrays* ends = nullptr;
    float most = 0;
    const MovingTree* ways = nullptr; ///< of its elements, where it deforms
};

/// Lengths, in units of the world.
struct PairReach {
    float listed;    ///< pairs this near are listed
    float slack;     ///< lists hold until a vertex has moved this far
    float least_gap; ///< no motion takes a pair nearer than this
};

/// How far the vertices of a deformable may move without its surface meeting a model
/// (docs/surfaces.md).
///
/// Around each vertex lies a ball, its *room*: whatever way vertices take within their rooms, nothing meets.
/// Only a vertex that is about to leave its room is looked at: its pairs are measured anew where they are
/// when the frame begins, and it gets a new room there. One that would leave even that one has to stay in the
/// convex set that its pairs' separating planes leave it.
///
/// The pairs come from lists of what is near each element, which hold until one of its vertices has moved by
/// a slack.
///
/// Where the model deforms, both sides of a pair go straight ways, and the plane between them is enough if it
/// is so at both ends (docs/surfaces.md). Every vertex has a *base*, where it ends when it goes along with
/// the surface beside it; rooms lie around bases, and what a pair's parts close on the way there is taken off
/// its gap. All that is known is for this one frame.
class SurfacePairs {
  public:
    /// @param own  must outlive this
    SurfacePairs(const Elements& own, const PairReach& reach);

    /// Forgets everything: the frame has changed, or the deformable was moved.
    void reset();

    /// Keeps pairs so far apart from now on: forgets everything.
    void keep_gap(float least_gap) {
        reach_.least_gap = least_gap;
        reset();
    }

    /// @param starts  of all vertices, when the frame begins
    /// @param bases   of all vertices; where the opponent rests, they are the starts
    /// @param clearances  lower bounds of the starts' distances from the opponent, or none
    void begin(const Opponent& opponent, const PointArrays& starts, const PointArrays& bases,
               std::span<const float> clearances);

    /// Gives new rooms to the vertices that leave the smaller ball around them in which nothing new is to be
    /// expected, on their way to the goals. First calls forget(elements) with those whose pairs are measured
    /// anew, and then, for each of these pairs, visit(element, pair, separation), which returns how far the
    /// pair's vertices may go before it has to be measured again. The separation's gap is what is left of it
    /// for ways from the bases.
    template <typename Forget, typename Visit>
    void look_ahead(const PointArrays& goals, const Workers& workers, const Forget& forget,
                    const Visit& visit) {
        for (std::uint32_t v = 0; v < own_->vertex_count(); ++v)
            if (is_beyond(v, goals[v], quiet_[v])) wake(v);
        collect_measured();
        forget(std::span<const std::uint32_t>(measuring_));
        measure_collected(visit, workers);
    }

    /// The vertices that leave their rooms for the goals though their rooms are new.
    std::span<const std::uint32_t> find_leaving(const PointArrays& goals, const Workers& workers);
    /// Gives a vertex a new room in this frame. @return whether it had none
    bool renew(std::uint32_t vertex, const Workers& workers);

    /// The shares of the way of one of them that nothing forbids.
    /// @param from, to  the way's ends, in this frame
    /// @param rounding  by which the way's beginning may be too near
    Shares allowed(std::uint32_t vertex, const Vec3f& from, const Vec3f& to, float rounding) const;

    /// Is one of the shares of a vertex's way that ends here?
    bool permits(std::uint32_t vertex, const Vec3f& place, float rounding) const {
        return !is_beyond(vertex, place, rooms_[vertex]) || !allowed(vertex, place, place, rounding).none();
    }
    /// Is anything of the opponent in reach of the lists of a vertex' elements?
    bool lists_any(std::uint32_t vertex) const {
        const auto elements = own_->at(vertex);
        return std::any_of(elements.begin(), elements.end(),
                           [&](std::uint32_t element) { return !lists_.of(element).empty(); });
    }
    /// By which the place of a vertex that is carried along, and so keeps its gap, may seem too near.
    float rounding() const { return reach_.least_gap / 4; }

    /// @param opponent_count  of vertices
    void archive(StateArchive& state, std::size_t opponent_count);

    std::uint64_t measured_count = 0, listed_count = 0;

  private:
    float usable(float gap) const { return usable_gap(gap, reach_.least_gap); }
    float bound_of(std::uint32_t element) const;
    bool is_beyond(std::uint32_t vertex, const Vec3f& goal, float radius) const;
    void wake(std::uint32_t vertex);
    void measure_woken(const Workers& workers);
    void collect_measured();
    template <typename Visit>
    void measure_collected(const Visit& visit, const Workers& workers);
    void gather_measured(const Workers& workers);
    void shrink(std::uint32_t vertex, float room, float quiet);
    std::array<Vec3f, 4> points_of(const Pair& pair) const;
    float advance(const Pair& pair, const Vec3f& normal) const;
    float closing(const Pair& pair, const Vec3f& normal) const;

    /// An element of the deformable, where its vertices go.
    struct Ways {
        const Element* element;
        std::array<Box, 3> points; ///< around the way of each vertex
        Box reached;               ///< around all that is listed with it
    };
    struct Measured {
        Pair pair;
        Separation apart;
    };
    /// What a worker needs to list pairs, and those that it has found.
    struct Listing {
        std::vector<std::array<std::uint32_t, 2>> near_elements;
        std::vector<std::uint32_t> others;
        std::vector<Pair> near;
        std::vector<Separation> separations;
        std::vector<Measured> found;
    };
    /// Of the pairs that a worker has found.
    struct Slice {
        std::size_t worker = 0, first = 0, count = 0;
    };
    bool is_list_outdated(std::uint32_t element) const;
    float moved_since_listed(std::uint32_t element) const;
    void keep_lists(const Workers& workers);
    void note_place(std::uint32_t element);
    bool is_far(std::uint32_t element);
    void list(std::uint32_t element, std::size_t worker);
    void list_on_their_ways(const Workers& workers);
    void list_piece(std::size_t piece, Listing& listing, std::size_t worker);
    float distance_to(std::uint32_t element, float most) const;
    bool look_farther(std::uint32_t vertex, const Vec3f& goal);
    float clearance_of(const Element& element) const;
    Ways ways_of(std::uint32_t element) const;
    void list_pairs(const Ways& own, std::uint32_t other, std::vector<Pair>& near) const;
    void keep_near(std::uint32_t element, Listing& listing);
    std::span<const Measured> just_listed(std::uint32_t element) const {
        const Slice& slice = listed_[element];
        return std::span(listings_[slice.worker].found).subspan(slice.first, slice.count);
    }
    void measure(const Workers& workers);

    const Elements* own_;
    PairReach reach_;
    PairLists lists_;
    // Lists
    std::vector<float> list_reaches_; ///< by element: pairs that are not listed were farther apart
    /// By element: where its vertices were when its list was made.
    std::vector<std::array<Vec3f, 3>> element_listed_at_;
    // Rooms
    PointArrays anchors_;
    std::vector<float> rooms_;
    std::vector<float> quiet_; ///< the radii of the smaller balls
    // The frame
    Opponent opponent_{};
    const PointArrays* starts_ = nullptr;
    const PointArrays* bases_ = nullptr;
    bool was_for_one_frame_ = false; ///< what is known, since the opponent deformed
    std::span<const float> clearances_;
    std::uint32_t frame_ = 0;
    std::vector<std::uint32_t> renewed_in_;  ///< by vertex: the frame of its room
    std::vector<std::uint32_t> measured_in_; ///< by element, in wakes: so that none is measured twice
    std::uint32_t wake_ = 0;
    std::vector<std::uint32_t> woken_, measuring_, leaving_;
    PiecewiseList<std::uint32_t> outdated_; ///< elements,
    std::vector<std::uint32_t> listing_;    ///< the same, in the order of those to be measured
    std::vector<Listing> listings_;         ///< by worker
    std::vector<Slice> listed_;             ///< by element: what was found for its list last
    // Beside an opponent that deforms
    MovingTree own_ways_;
    std::vector<std::uint32_t> places_in_tree_; ///< by element
    std::vector<std::uint8_t> is_wanted_;       ///< the same
    std::vector<Measured> measured_;
    std::vector<std::uint32_t> measured_elements_; ///< by measured pair
    std::vector<std::uint32_t> to_measure_;        ///< those of them that were listed earlier
};

/// @param visit  returns how far the pair's vertices may go quietly
template <typename Visit>
void SurfacePairs::measure_collected(const Visit& visit, const Workers& workers) {
    gather_measured(workers);
    for (std::size_t i = 0; i < measured_.size(); ++i) {
        const Pair& pair = measured_[i].pair;
        Separation apart = measured_[i].apart;
        const float closed = opponent_.ends != nullptr ? closing(pair, apart.normal) : 0;
        const float room = usable(apart.gap) - closed;
        apart.gap -= closed;
        const float quiet = visit(measured_elements_[i], pair, apart);
        for (std::size_t k = 0; k < own_count(pair.kind); ++k) shrink(pair.points[k], room, quiet);
    }
    measured_count += measured_.size();
}

} // namespace echinus
