// A batch is answered piece by piece, small enough for the first-level cache: who is in a gap by a
// comparison, who is in a band by its faces, and who may be in one or the other by the reference.

#include "exact_map/query/sides.hpp"

#include "exact_map/layout.hpp"
#include "exact_map/query/winding.hpp"

#include <algorithm>
#include <array>
#include <cassert>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "exact_map/query/sides.cpp"
#include <hwy/foreach_target.h>

// After foreach_target.h, which includes this file once for each instruction set.
#include "exact_map/query/band_search-inl.hpp"
#include "exact_map/query/band_windings-inl.hpp"
#include "exact_map/query/cell_lanes-inl.hpp"
#include "simd/dispatch.hpp"

HWY_BEFORE_NAMESPACE();
namespace echinus::HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR

namespace {

class SideFinder {
  public:
    explicit SideFinder(const ExactMapView& map) : map_(map) {}

    /// The particles of any batch: the last of them that fill no vector are followed by copies of the last.
    void run(const StridedSpan<const Vec3f>& points, std::span<Side> sides) {
        const std::size_t rest = sides.size() % hn::Lanes(Floats()), whole = sides.size() - rest;
        run_whole(points.subspan(0, whole), sides.first(whole));
        if (rest == 0) return;
        std::array<Vec3f, BandGroup::kMargin> last_points;
        std::array<Side, BandGroup::kMargin> last_sides;
        for (std::size_t lane = 0; lane < last_points.size(); ++lane)
            last_points[lane] = points[whole + std::min(lane, rest - 1)];
        const std::size_t count = hn::Lanes(Floats());
        run_whole({last_points.data(), count}, {last_sides.data(), count});
        std::copy_n(last_sides.data(), rest, &sides[whole]);
    }

  private:
    /// Particles that fill vectors.
    void run_whole(const StridedSpan<const Vec3f>& points, std::span<Side> sides) {
        points_ = points;
        sides_ = sides;
        is_packed_ = points.size() > 1 && &points[1] == &points[0] + 1;
        for (begin_ = 0; begin_ < sides.size(); begin_ += BandGroup::kCapacity) {
            const std::size_t count = std::min(BandGroup::kCapacity, sides.size() - begin_);
            search_.find(count, [this](std::size_t slot) HWY_ATTR { return load(begin_ + slot); });
            std::fill_n(&sides_[begin_], count, Side{0}); // those beyond all bands
            answer_in_gaps();
            place_in_bands();
            answer_in_bands();
            for (const std::int32_t slot : search_.unsure()) fall_back_to_scalar(slot);
        }
    }

    std::size_t particle_of(std::int32_t slot) const { return begin_ + static_cast<std::size_t>(slot); }

    /// Leaves a particle to the reference.
    void fall_back_to_scalar(std::int32_t slot) {
        const std::size_t particle = particle_of(slot);
        sides_[particle] = side_of(classify(map_, points_[particle]));
    }

    PointLanes load(std::size_t particle) {
        constexpr Floats f;
        if (is_packed_) {
            FloatLanes x, y, z;
            hn::LoadInterleaved3(f, &points_[particle].x, x, y, z);
            return {x, y, z};
        }
        alignas(64) std::array<std::array<float, BandGroup::kMargin>, 3> rows;
        for (std::size_t lane = 0; lane < hn::Lanes(f); ++lane) {
            const Vec3f& point = points_[particle + lane];
            rows[0][lane] = point.x;
            rows[1][lane] = point.y;
            rows[2][lane] = point.z;
        }
        return {hn::Load(f, rows[0].data()), hn::Load(f, rows[1].data()), hn::Load(f, rows[2].data())};
    }

    void answer_in_gaps() {
        const BandGroup& group = search_.in_gaps;
        for (std::size_t k = 0; k < group.size; ++k) {
            const std::int16_t winding = map_.winding_below[static_cast<std::uint32_t>(group.bands[k])];
            if (winding == ExactMapView::kUncertain) [[unlikely]]
                fall_back_to_scalar(group.slots[k]);
            else
                sides_[particle_of(group.slots[k])] = is_inside(map_.rule, winding) ? kInsideBit : 0;
        }
    }

    /// Snaps those in bands to the lattice and finds the parts of their cells that they are in.
    void place_in_bands() {
        constexpr Floats f;
        auto& [x, y, z, parts] = windings_.particles;
        const BandGroup& group = search_.in_bands;
        for (std::size_t k = 0; k < group.size; ++k) {
            const Vec3f& point = points_[particle_of(group.slots[k])];
            x[k] = point.x;
            y[k] = point.y;
            z[k] = point.z;
        }
        for (std::size_t k = 0; k < group.size; k += hn::Lanes(f)) {
            const LatticeLanes p = snap_({hn::Load(f, &x[k]), hn::Load(f, &y[k]), hn::Load(f, &z[k])});
            hn::Store(p.x, f, &x[k]);
            hn::Store(p.y, f, &y[k]);
            hn::Store(p.z, f, &z[k]);
            hn::Store(parts_of_(p), Ints(), &parts[k]);
        }
    }

    void answer_in_bands() {
        const std::int32_t* slots = search_.in_bands.slots.data();
        Side* sides = &sides_[begin_];
        const InsideRule rule = map_.rule;
        windings_.find(search_.in_bands, search_.outermost_count,
                       [=, this](std::size_t k, std::int32_t winding) {
                           if (winding == BandWindings::kUnsettled) [[unlikely]]
                               fall_back_to_scalar(slots[k]);
                           else
                               sides[slots[k]] = is_inside(rule, winding) ? kInsideBit : 0;
                       });
    }

    const ExactMapView& map_;
    SnapLanes snap_{frame_of(map_)};
    PartLanes parts_of_{map_.divisions};

    StridedSpan<const Vec3f> points_;
    bool is_packed_ = false; ///< one point after the other, without a gap
    std::span<Side> sides_;
    std::size_t begin_ = 0; ///< of the piece at hand
    BandSearch search_{map_};
    BandWindings windings_{map_};
};

} // namespace

void find_sides(const ExactMapView& map, const StridedSpan<const Vec3f>& points_local,
                std::span<Side> sides) {
    SideFinder(map).run(points_local, sides);
}

#else

void find_sides(const ExactMapView& map, const StridedSpan<const Vec3f>& points_local,
                std::span<Side> sides) {
    for (std::size_t i = 0; i < sides.size(); ++i) sides[i] = side_of(classify(map, points_local[i]));
}

#endif

} // namespace echinus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace echinus {

namespace {

HWY_EXPORT(find_sides);

} // namespace

void find_sides(const ExactMapView& map, StridedSpan<const Vec3f> points_local,
                std::span<Side> sides) noexcept {
    assert(points_local.size() == sides.size());
    constexpr std::size_t kMinKernelBatch = 8; // one vector takes as long as the reference for so many
    if (use_kernels() && sides.size() >= kMinKernelBatch) {
        ECHINUS_DISPATCH(find_sides)(map, points_local, sides);
        return;
    }
    for (std::size_t i = 0; i < sides.size(); ++i) sides[i] = side_of(classify(map, points_local[i]));
}

} // namespace echinus
#endif
