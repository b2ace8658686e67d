// A batch is answered in pieces small enough for the first-level cache. BandSearch finds the gap or the band
// that each particle is in. A particle in a gap has the gap's winding number; for one in a band, BandWindings
// counts the crossings of its ray with the band's faces. Cases that single precision cannot decide are left
// to the scalar query.

#include "exact_map/query/sides.hpp"

#include "geometry/scratch.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <new>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "exact_map/query/sides.cpp"
#include <hwy/foreach_target.h>

// Must follow foreach_target.h, which includes this file once per instruction set.
#include "exact_map/query/band_search-inl.hpp"
#include "exact_map/query/band_windings-inl.hpp"
#include "simd/dispatch.hpp"

#ifndef ECHINUS_SIDES_ONE_BY_ONE
#define ECHINUS_SIDES_ONE_BY_ONE
namespace echinus {
namespace {

void find_sides_one_by_one(const ExactMapView& map, const StridedSpan<const Vec3f>& points_local,
                           std::span<Side> sides) {
    const LatticeFrame frame = frame_of(map);
    for (std::size_t i = 0; i < sides.size(); ++i) sides[i] = side_at(map, frame, points_local[i]);
}

} // namespace
} // namespace echinus
#endif

HWY_BEFORE_NAMESPACE();
namespace echinus::HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR

namespace {

/// Answers a batch piece by piece.
class SideFinder {
  public:
    explicit SideFinder(const ExactMapView& map) : map_(map) {}

    /// Answers any number of particles; copies of the last one fill up the last vector.
    void find(const StridedSpan<const Vec3f>& points, std::span<Side> sides) {
        constexpr std::size_t kCapacity = BandGroup::kCapacity;
        const std::size_t lanes = hn::Lanes(Floats());
        const std::size_t rest = sides.size() % lanes, whole = sides.size() - rest;
        for (std::size_t begin = 0; begin < whole; begin += kCapacity) {
            const std::size_t count = std::min(kCapacity, whole - begin);
            find_piece(points.subspan(begin, count), sides.subspan(begin, count));
        }
        if (rest == 0) return;
        std::array<Vec3f, BandGroup::kMargin> last_points;
        std::array<Side, BandGroup::kMargin> last_sides;
        for (std::size_t lane = 0; lane < lanes; ++lane)
            last_points[lane] = points[whole + std::min(lane, rest - 1)];
        find_piece({last_points.data(), lanes}, {last_sides.data(), lanes});
        std::copy_n(last_sides.data(), rest, &sides[whole]);
    }

  private:
    /// Answers whole vectors of particles, at most BandGroup::kCapacity particles.
    void find_piece(const StridedSpan<const Vec3f>& points, std::span<Side> sides) {
        search_.find(points);
        std::fill(sides.begin(), sides.end(), Side{0}); // beyond all bands
        answer_in_gaps(points, sides);
        answer_in_bands(points, sides);
        for (const std::int32_t slot : search_.unsure()) fall_back_to_scalar(slot, points, sides);
    }

    void answer_in_gaps(const StridedSpan<const Vec3f>& points, std::span<Side> sides) const {
        const BandGroup& group = search_.in_gaps;
        for (std::size_t k = 0; k < group.size; ++k) {
            const std::int16_t winding = map_.winding_below[static_cast<std::uint32_t>(group.bands[k])];
            if (winding == ExactMapView::kUncertain) [[unlikely]]
                fall_back_to_scalar(group.slots[k], points, sides);
            else
                sides[static_cast<std::uint32_t>(group.slots[k])] =
                    is_inside(map_.rule, winding) ? kInsideBit : 0;
        }
    }

    void answer_in_bands(const StridedSpan<const Vec3f>& points, std::span<Side> sides) {
        const BandGroup& group = search_.in_bands;
        const std::span<const std::int32_t> windings = windings_.find(group, search_.outermost_count, points);
        for (std::size_t k = 0; k < windings.size(); ++k) {
            if (windings[k] == BandWindings::kUnsettled) [[unlikely]]
                fall_back_to_scalar(group.slots[k], points, sides);
            else
                sides[static_cast<std::uint32_t>(group.slots[k])] =
                    is_inside(map_.rule, windings[k]) ? kInsideBit : 0;
        }
    }

    void fall_back_to_scalar(std::int32_t slot, const StridedSpan<const Vec3f>& points,
                             std::span<Side> sides) const {
        const auto particle = static_cast<std::uint32_t>(slot);
        sides[particle] = side_at(map_, frame_, points[particle]);
    }

    const ExactMapView& map_;
    LatticeFrame frame_ = frame_of(map_);
    BandSearch search_{map_};
    BandWindings windings_{map_};
};

} // namespace

void find_sides(const ExactMapView& map, const StridedSpan<const Vec3f>& points_local,
                std::span<Side> sides) {
    OnScratch<SideFinder>(map)->find(points_local, sides);
}

namespace {

SideAndLeaf side_and_leaf(const ExactMapView& map, const LatticeFrame& frame, const Vec3f& point_local,
                          bool leaf_outside) {
    const Vec3d place = frame.to_lattice(point_local);
    if (!map.border.empty() || !is_on_lattice(place)) return {side_at(map, frame, point_local), kNoLeaf};
    const LatticePoint p = rounded(place);
    const OctahedralCells::Place in_cell = OctahedralCells(map.divisions).locate(p);
    const std::int64_t t = band_unit_of(l1_norm(p));
    if (t >= map.outer_limits[in_cell.cell] && !leaf_outside) return {0, kNoLeaf};
    const PlaceInBands at = place_in_bands(map, in_cell, t);
    const bool inside = !at.is_beyond_all() && is_inside(map.rule, winding_of_one(map, at, p));
    return {inside ? kInsideBit : Side{0}, inside || leaf_outside ? leaf_near(map, at) : kNoLeaf};
}

} // namespace

SideAndLeaf find_side(const ExactMapView& map, const LatticeFrame& frame, const Vec3f& point_local,
                      bool leaf_outside) {
    return side_and_leaf(map, frame, point_local, leaf_outside);
}

void find_few_sides(const ExactMapView& map, const StridedSpan<const Vec3f>& points_local,
                    std::span<Side> sides) {
    const LatticeFrame frame = frame_of(map);
    for (std::size_t i = 0; i < sides.size(); ++i)
        sides[i] = side_and_leaf(map, frame, points_local[i], false).side;
}

#else

SideAndLeaf find_side(const ExactMapView& map, const LatticeFrame& frame, const Vec3f& point_local,
                      bool /*leaf_outside*/) {
    return {side_at(map, frame, point_local), kNoLeaf};
}

void find_few_sides(const ExactMapView& map, const StridedSpan<const Vec3f>& points_local,
                    std::span<Side> sides) {
    find_sides_one_by_one(map, points_local, sides);
}

void find_sides(const ExactMapView& map, const StridedSpan<const Vec3f>& points_local,
                std::span<Side> sides) {
    find_sides_one_by_one(map, points_local, sides);
}

#endif

} // namespace echinus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace echinus {

namespace {

HWY_EXPORT(find_few_sides);
HWY_EXPORT(find_side);
HWY_EXPORT(find_sides);

} // namespace

SideAndLeaf find_side(const ExactMapView& map, const LatticeFrame& frame, const Vec3f& point_local,
                      bool leaf_outside) noexcept {
    if (!use_kernels()) return {side_at(map, frame, point_local), kNoLeaf};
    return ECHINUS_DISPATCH(find_side)(map, frame, point_local, leaf_outside);
}

void find_sides(const ExactMapView& map, const StridedSpan<const Vec3f>& points_local,
                std::span<Side> sides) noexcept {
    assert(points_local.size() == sides.size());
    constexpr std::size_t kMinKernelBatch = 8; // a full vector takes as long as this many single queries
    if (!use_kernels())
        find_sides_one_by_one(map, points_local, sides);
    else if (sides.size() < kMinKernelBatch)
        ECHINUS_DISPATCH(find_few_sides)(map, points_local, sides);
    else
        try {
            ECHINUS_DISPATCH(find_sides)(map, points_local, sides);
        } catch (const std::bad_alloc&) { // the reference needs no memory
            find_sides_one_by_one(map, points_local, sides);
        }
}

} // namespace echinus
#endif
