// Two passes. The first finds the gap or the band of as many particles at once as there are lanes, and
// settles those in gaps. The second takes the bands in turn: it prepares a band's faces once and tests them
// for all particles of the band.

#include "exact_map/sides.hpp"

#include "exact_map/band_buckets.hpp"
#include "exact_map/layout.hpp"
#include "exact_map/winding.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <new>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "exact_map/sides.cpp"
#include <hwy/foreach_target.h>

// After foreach_target.h, which includes this file once for each instruction set.
#include "exact_map/cell_lanes-inl.hpp"
#include "exact_map/prepared_faces-inl.hpp"
#include "simd/dispatch.hpp"

HWY_BEFORE_NAMESPACE();
namespace echinus::HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR

namespace {

/// Particles of a piece of the batch that have something in common, and the band in question. Written a
/// whole vector at a time, of which only the first few count.
struct Group {
    static constexpr std::size_t kCapacity = 256;
    static constexpr std::size_t kMargin = 16; // lanes of the widest vector

    std::size_t size = 0;
    alignas(64) std::array<std::int32_t, kCapacity + kMargin> slots; ///< numbers in the piece
    alignas(64) std::array<std::int32_t, kCapacity + kMargin> bands;

    void add(IntMask mask, IntLanes slot, IntLanes band) {
        constexpr Ints i;
#if HWY_TARGET == HWY_AVX3 // the only one with an instruction for it
        hn::StoreU(hn::Compress(band, mask), i, &bands[size]);
        hn::StoreU(hn::Compress(slot, mask), i, &slots[size]);
        size += hn::CountTrue(i, mask);
#else
        alignas(64) std::array<std::int32_t, kMargin> slot_of, band_of, chosen;
        hn::Store(slot, i, slot_of.data());
        hn::Store(band, i, band_of.data());
        hn::Store(hn::VecFromMask(i, mask), i, chosen.data());
        for (std::size_t lane = 0; lane < hn::Lanes(i); ++lane) {
            slots[size] = slot_of[lane];
            bands[size] = band_of[lane];
            size -= static_cast<std::size_t>(static_cast<std::ptrdiff_t>(chosen[lane])); // -1 where it is
        }
#endif
    }
};

class SideFinder {
  public:
    SideFinder(const ExactMapView& map, const StridedSpan<const Vec3f>& points, std::span<Side> sides,
               BandBuckets& buckets)
        : map_(map), points_(points), sides_(sides), buckets_(buckets) {}

    void run() {
        const std::size_t lanes = hn::Lanes(Floats());
        const std::size_t whole = sides_.size() / lanes * lanes;
        for (begin_ = 0; begin_ < whole; begin_ += kPiece) {
            size_ = std::min(kPiece, whole - begin_);
            locate();
            compare_with_reach();
            compare_with_outermost();
            compare_with_inner();
            answer_in_gaps();
            list_in_bands();
            for (; refer_count_ > 0; --refer_count_) refer(begin_ + refer_[refer_count_ - 1]);
        }
        for (std::size_t bucket = 0; bucket < buckets_.count(); ++bucket) resolve(bucket);
        for (std::size_t particle = whole; particle < sides_.size(); ++particle) refer(particle);
    }

  private:
    static constexpr std::size_t kPiece = Group::kCapacity;
    static constexpr float kSurelyOnLattice = static_cast<float>(kLatticeExtent) - 1;
    /// An L1 norm that no place in the bounding sphere has.
    static constexpr float kBeyondEverything = 1.75F * static_cast<float>(kLatticeExtent);
    using Numbers = std::array<std::int32_t, kPiece>;

    /// Leaves a particle to the reference.
    void refer(std::size_t particle) { sides_[particle] = side_of(classify(map_, points_[particle])); }
    void refer_later(std::int32_t slot) { refer_[refer_count_++] = slot; }
    void refer_later(std::size_t first_slot, IntMask mask) {
        constexpr Ints i;
        if (hn::AllFalse(i, mask)) [[likely]]
            return;
        alignas(64) std::array<std::int32_t, Group::kMargin> lanes;
        hn::Store(hn::VecFromMask(i, mask), i, lanes.data());
        for (std::size_t lane = 0; lane < hn::Lanes(i); ++lane)
            if (lanes[lane] != 0) refer_later(static_cast<std::int32_t>(first_slot + lane));
    }

    PointLanes load(std::size_t particle) {
        PointLanes points;
        if (is_packed_) {
            hn::LoadInterleaved3(Floats(), &points_[particle].x, points.x, points.y, points.z);
            return points;
        }
        return gather(hn::Lanes(Floats()),
                      [&](std::size_t lane) -> const Vec3f& { return points_[particle + lane]; });
    }

    /// @param point_of  the point of each of the first `count` lanes; the others get any numbers
    template <typename PointOf>
    PointLanes gather(std::size_t count, const PointOf& point_of) {
        constexpr Floats f;
        for (std::size_t lane = 0; lane < count; ++lane) {
            const Vec3f& point = point_of(lane);
            rows_[0][lane] = point.x;
            rows_[1][lane] = point.y;
            rows_[2][lane] = point.z;
        }
        return {hn::Load(f, rows_[0].data()), hn::Load(f, rows_[1].data()), hn::Load(f, rows_[2].data())};
    }

    void locate() {
        constexpr Floats f;
        constexpr Ints i;
        const FloatLanes largest = hn::Set(f, kBeyondEverything);
        for (std::size_t slot = 0; slot < size_; slot += hn::Lanes(f)) {
            const CellLanes at = locate_(load(begin_ + slot));
            const FloatMask far = hn::Ge(at.l1, largest);
            const FloatMask located = hn::AndNot(far, at.sure);
            hn::Store(hn::IfThenElse(located, at.l1, largest), f, &l1_[slot]);
            hn::Store(hn::IfThenElseZero(hn::RebindMask(i, located), at.cell), i, &cells_[slot]);
            refer_later(slot, hn::RebindMask(i, hn::Not(hn::Or(far, at.sure))));
            if (is_open_) [[unlikely]] // beyond the lattice nothing is certain
                refer_later(slot, hn::RebindMask(i, hn::Gt(at.farthest, hn::Set(f, kSurelyOnLattice))));
        }
    }

    /// Of a band, in lattice steps.
    struct Limits {
        FloatLanes lower, upper;
    };

    static Limits limits(IntLanes both) {
        constexpr Floats f;
        constexpr Ints i;
        const auto upper = hn::ShiftRight<16>(hn::BitCast(hn::RebindToUnsigned<Ints>(), both));
        const FloatLanes unit = hn::Set(f, ExactMapView::kBandUnit);
        return {hn::Mul(hn::ConvertTo(f, hn::And(both, hn::Set(i, UINT16_MAX))), unit),
                hn::Mul(hn::ConvertTo(f, hn::BitCast(i, upper)), unit)};
    }

    /// Both limits of a band in one number, as limits() takes them.
    std::int32_t limits_of(std::uint32_t band) const {
        const Band& limits = map_.bands[band];
        return static_cast<std::int32_t>(std::uint32_t{limits.upper} << 16 | limits.lower);
    }

    /// Is a particle surely beyond a limit, or surely not?
    static IntMask surely_beyond(FloatLanes l1, FloatLanes limit) {
        return hn::RebindMask(Ints(), hn::Ge(l1, hn::Add(limit, hn::Set(Floats(), CellLanes::kL1Error))));
    }
    static IntMask surely_below(FloatLanes l1, FloatLanes limit) {
        return hn::RebindMask(Ints(), hn::Lt(l1, hn::Sub(limit, hn::Set(Floats(), CellLanes::kL1Error))));
    }

    /// Most particles are beyond all bands of their cell: of no more than its reach is then read. Loads, and
    /// no gathers: these are slower on many processors.
    void compare_with_reach() {
        constexpr Ints i;
        for (std::size_t slot = 0; slot < size_; ++slot)
            limits_[slot] = map_.reaches[static_cast<std::size_t>(cells_[slot])];
        below_.size = 0;
        for (std::size_t slot = 0; slot < size_; slot += hn::Lanes(i)) {
            const FloatLanes l1 = hn::Load(Floats(), &l1_[slot]);
            const FloatLanes reach = hn::Mul(hn::ConvertTo(Floats(), hn::Load(i, &limits_[slot])),
                                             hn::Set(Floats(), ExactMapView::kBandUnit));
            const IntMask beyond = surely_beyond(l1, reach);
            store_sides(slot, hn::Zero(i));
            if (is_open_) [[unlikely]]
                refer_later(slot, beyond);
            // With the cell for the moment: its bands are looked up next. A cell without bands has no such
            // particle, since nobody is sure of a cell who is less than kL1Error from the centre.
            below_.add(hn::Not(beyond), hn::Iota(i, static_cast<std::int32_t>(slot)),
                       hn::Load(i, &cells_[slot]));
        }
    }

    void compare_with_outermost() {
        constexpr Floats f;
        constexpr Ints i;
        in_bands_.size = in_gaps_.size = 0;
        const std::size_t count = below_.size;
        for (std::size_t k = 0; k < count; ++k) {
            const auto slot = static_cast<std::size_t>(below_.slots[k]);
            const auto cell = static_cast<std::size_t>(below_.bands[k]);
            const std::uint32_t band = map_.band_offsets[cell + 1] - 1;
            first_bands_[slot] = static_cast<std::int32_t>(map_.band_offsets[cell]);
            bands_[k] = static_cast<std::int32_t>(band);
            limits_[k] = limits_of(band);
            inner_l1_[k] = l1_[slot];
        }
        below_.size = 0;
        for (std::size_t k = 0; k < count; k += hn::Lanes(i)) {
            const IntMask valid = hn::FirstN(i, count - k);
            const FloatLanes l1 = hn::Load(f, &inner_l1_[k]);
            const IntMask below = surely_below(l1, limits(hn::Load(i, &limits_[k])).lower);
            const IntLanes slots = hn::Load(i, &below_.slots[k]), bands = hn::Load(i, &bands_[k]);
            in_bands_.add(hn::AndNot(below, valid), slots, bands);
            below_.add(hn::And(below, valid), slots, bands);
        }
        outermost_count_ = in_bands_.size;
    }

    /// Of those below a band, compares with the next one inwards, until none is left.
    void compare_with_inner() {
        constexpr Floats f;
        constexpr Ints i;
        while (below_.size > 0) {
            const std::size_t count = below_.size;
            for (std::size_t k = 0; k < count; ++k) {
                const auto slot = static_cast<std::size_t>(below_.slots[k]);
                const bool innermost = below_.bands[k] == first_bands_[slot];
                const std::int32_t band = below_.bands[k] - (innermost ? 0 : 1);
                inner_l1_[k] = l1_[slot];
                bands_[k] = band;
                limits_[k] = innermost ? 0 : limits_of(static_cast<std::uint32_t>(band));
            }
            below_.size = 0; // what is added lies before what is read
            for (std::size_t k = 0; k < count; k += hn::Lanes(i)) {
                const IntMask valid = hn::FirstN(i, count - k);
                const IntLanes slots = hn::Load(i, &below_.slots[k]), above = hn::Load(i, &below_.bands[k]);
                const IntLanes bands = hn::Load(i, &bands_[k]);
                const FloatLanes l1 = hn::Load(f, &inner_l1_[k]);
                const auto [lower, upper] = limits(hn::Load(i, &limits_[k]));
                const IntMask in_gap = surely_beyond(l1, upper);
                const IntMask below = surely_below(l1, lower);
                in_gaps_.add(hn::And(valid, in_gap), slots, above);
                in_bands_.add(hn::AndNot(hn::Or(in_gap, below), valid), slots, bands);
                below_.add(hn::And(valid, hn::AndNot(in_gap, below)), slots, bands);
            }
        }
    }

    void store_sides(std::size_t slot, IntLanes sides) {
        constexpr hn::Rebind<std::uint8_t, Ints> bytes;
        hn::StoreU(hn::DemoteTo(bytes, sides), bytes, &sides_[begin_ + slot]);
    }

    IntLanes sides_of(IntLanes windings) const {
        constexpr Ints i;
        const IntLanes one = hn::Set(i, kInside);
        if (map_.rule == InsideRule::Parity) return hn::And(windings, one);
        return hn::IfThenZeroElse(hn::Eq(windings, hn::Zero(i)), one);
    }

    Side side_of_winding(int winding) const { return is_inside(map_.rule, winding) ? kInside : 0; }

    void answer_in_gaps() {
        for (std::size_t k = 0; k < in_gaps_.size; ++k) {
            const std::int32_t slot = in_gaps_.slots[k];
            const std::int16_t winding = map_.winding_below[static_cast<std::uint32_t>(in_gaps_.bands[k])];
            sides_[begin_ + static_cast<std::size_t>(slot)] = side_of_winding(winding);
            if (winding == ExactMapView::kUncertain) [[unlikely]]
                refer_later(slot);
        }
    }

    void list_in_bands() {
        for (std::size_t k = 0; k < in_bands_.size; ++k) {
            const std::size_t particle = begin_ + static_cast<std::size_t>(in_bands_.slots[k]);
            const std::size_t bucket =
                buckets_.add({points_[particle], static_cast<std::uint32_t>(particle),
                              static_cast<std::uint32_t>(in_bands_.bands[k]) << Unsettled::kBandShift |
                                  (k < outermost_count_ ? Unsettled::kOutermost : 0)});
            if (buckets_.is_full(bucket)) [[unlikely]]
                resolve(bucket);
        }
    }

    /// Answers for those in bands.
    void resolve(std::size_t bucket) {
        std::span<const Unsettled> rest = buckets_.take(bucket);
        while (!rest.empty()) {
            const std::uint32_t band = rest.front().band();
            std::size_t count = 1;
            while (count < rest.size() && rest[count].band() == band) ++count;
            resolve_band(rest.first(count));
            rest = rest.subspan(count);
        }
    }

    void resolve_band(std::span<const Unsettled> particles) {
        const std::uint32_t band = particles.front().band();
        const int beyond = particles.front().outermost() ? 0 : map_.winding_below[band + 1];
        if (beyond == ExactMapView::kUncertain || !prepare_faces(band, parts_of(particles))) {
            for (const Unsettled& particle : particles) refer(particle.particle);
            return;
        }
        for (; !particles.empty();
             particles = particles.subspan(std::min(particles.size(), hn::Lanes(Floats()))))
            if (beyond == ExactMapView::kSplit)
                count_crossings<RaySide::Before>(particles, map_.winding_below[band]);
            else
                count_crossings<RaySide::Beyond>(particles, beyond);
    }

    /// The parts of the cell in which particles lie, a bit each; all of them where there are many particles.
    std::uint32_t parts_of(std::span<const Unsettled> particles) const {
        constexpr std::size_t kMany = 8;
        constexpr std::uint32_t kAll = (1U << OctahedralCells::kPartCount) - 1;
        if (particles.size() >= kMany) return kAll;
        std::uint32_t parts = 0;
        for (const Unsettled& particle : particles)
            parts |= 1U << cells_of_map_.locate(rounded(frame_.to_lattice(particle.point_local))).part;
        return parts;
    }

    /// The faces of a band that touch some of its cell's parts. Returns false where they are too many.
    bool prepare_faces(std::uint32_t band, std::uint32_t parts) {
        const std::uint32_t end = map_.bands[band + 1].first_reference;
        faces_.clear();
        for (std::uint32_t r = map_.bands[band].first_reference; r < end; ++r) {
            if ((map_.reference_parts[r] & parts) == 0) continue;
            if (faces_.full()) return false;
            const std::size_t corner = 3 * std::size_t{map_.references[r]};
            faces_.add(map_.vertices[map_.corners[corner]], map_.vertices[map_.corners[corner + 1]],
                       map_.vertices[map_.corners[corner + 2]]);
        }
        faces_.prepare();
        return true;
    }

    /// Answers for the first particles of a band, as many as there are lanes.
    /// @param winding  on the side of the band that is away from the side where crossings are counted
    template <RaySide kSide>
    void count_crossings(std::span<const Unsettled> particles, int winding) {
        constexpr Floats f;
        constexpr Ints i;
        const std::size_t count = std::min(particles.size(), hn::Lanes(f));
        const LatticeLanes p = snap_(
            gather(count, [&](std::size_t lane) -> const Vec3f& { return particles[lane].point_local; }));
        const auto [sum, sure] = faces_.crossings<kSide>(p);
        // Who only might have been in the band was not.
        const Band& band = map_.bands[particles.front().band()];
        const FloatLanes l1 = p.l1_norm();
        constexpr float kUnit = ExactMapView::kBandUnit;
        const FloatMask in_band =
            hn::And(hn::Ge(l1, hn::Set(f, band.lower * kUnit)), hn::Lt(l1, hn::Set(f, band.upper * kUnit)));
        const FloatLanes here = hn::Set(f, static_cast<float>(winding));
        const IntLanes windings =
            hn::ConvertTo(i, kSide == RaySide::Before ? hn::Sub(here, sum) : hn::Add(here, sum));
        alignas(64) std::array<std::int32_t, Group::kMargin> inside;
        hn::Store(sides_of(windings), i, inside.data());
        for (std::size_t lane = 0; lane < count; ++lane)
            sides_[particles[lane].particle] = static_cast<Side>(inside[lane]);
        const FloatMask settled = hn::And(sure, in_band);
        if (hn::AllTrue(f, settled)) [[likely]]
            return;
        hn::Store(hn::VecFromMask(i, hn::RebindMask(i, settled)), i, inside.data());
        for (std::size_t lane = 0; lane < count; ++lane)
            if (inside[lane] == 0) refer(particles[lane].particle);
    }

    const ExactMapView& map_;
    bool is_open_ = !map_.border.empty();
    LatticeFrame frame_ = frame_of(map_);
    SnapLanes snap_{frame_};
    LocateLanes locate_{map_.centre, frame_, map_.divisions};
    OctahedralCells cells_of_map_{map_.divisions};
    StridedSpan<const Vec3f> points_;
    bool is_packed_ = points_.size() > 1 && &points_[1] == &points_[0] + 1;
    std::span<Side> sides_;
    BandBuckets& buckets_;

    // The piece of the batch at hand, [begin_, begin_ + size_).
    std::size_t begin_ = 0, size_ = 0;
    alignas(64) std::array<float, kPiece> l1_, inner_l1_;
    alignas(64) Numbers cells_, first_bands_, bands_, limits_;
    Group below_, in_bands_, in_gaps_;
    std::size_t outermost_count_ = 0;            ///< so many of in_bands_ are in the outermost of their cell
    std::array<std::int32_t, 4 * kPiece> refer_; ///< some perhaps several times
    std::size_t refer_count_ = 0;

    alignas(64) std::array<std::array<float, Group::kMargin>, 3> rows_{};
    PreparedFaces faces_;
};

} // namespace

void find_sides(const ExactMapView& map, const StridedSpan<const Vec3f>& points_local, std::span<Side> sides,
                BandBuckets& buckets) {
    SideFinder(map, points_local, sides, buckets).run();
}

#else

void find_sides(const ExactMapView& map, const StridedSpan<const Vec3f>& points_local, std::span<Side> sides,
                BandBuckets&) {
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
    constexpr std::size_t kMostBands = 1 << 27; // so that int32 holds byte offsets
    constexpr std::size_t kFewest = 512;        // below, hardly two particles share a band
    if (use_kernels() && sides.size() >= kFewest && map.bands.size() < kMostBands) {
        try {
            BandBuckets buckets(map.bands.size(), sides.size());
            ECHINUS_DISPATCH(find_sides)(map, points_local, sides, buckets);
            return;
        } catch (const std::bad_alloc&) { // the reference needs no memory
        }
    }
    for (std::size_t i = 0; i < sides.size(); ++i) sides[i] = side_of(classify(map, points_local[i]));
}

} // namespace echinus
#endif
