// Included once for each instruction set, as Highway wants it: no guard against a second time.
#if defined(ECHINUS_BAND_WINDINGS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ECHINUS_BAND_WINDINGS_INL
#undef ECHINUS_BAND_WINDINGS_INL
#else
#define ECHINUS_BAND_WINDINGS_INL
#endif

#include "exact_map/layout.hpp"
#include "exact_map/query/band_search-inl.hpp"
#include "exact_map/query/cell_lanes-inl.hpp"
#include "exact_map/query/crossing_lanes-inl.hpp"
#include "exact_map/query/ray_crossing.hpp"
#include "simd/compress-inl.hpp"
#include "simd/rows-inl.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#if HWY_TARGET != HWY_SCALAR // where the reference is used instead
HWY_BEFORE_NAMESPACE();
namespace echinus::HWY_NAMESPACE {

/// Winding numbers around particles in bands.
///
/// A particle in a band has only a few faces to test, too few to fill the lanes of a vector. So pairs of a
/// particle and a face are listed first, for many particles, and then tested, one pair to a lane.
class BandWindings {
  public:
    /// Replaces a winding number that is left to the scalar query.
    static constexpr std::int32_t kUnsettled = INT32_MAX;

    explicit BandWindings(const ExactMapView& map) : map_(map) {}

    /// The winding number around each particle of a group, or kUnsettled. Valid until the next call.
    /// @param group   bands of particles; of the first `outermost_count` they are the last of their cells
    /// @param points  local, by slot
    std::span<const std::int32_t> find(const BandGroup& group, std::size_t outermost_count,
                                       const StridedSpan<const Vec3f>& points) {
        place(group, points);
        for (std::size_t k = 0; k < group.size;) {
            const std::size_t first = k;
            pair_count_ = 0;
            if (k < outermost_count) k = list_pairs<true>(group, k, outermost_count);
            if (k >= outermost_count) k = list_pairs<false>(group, k, group.size);
            if (map_.corners.wide.empty())
                test_pairs(map_.corners.narrow.data());
            else
                test_pairs(map_.corners.wide.data());
            add_up(first, k);
        }
        return {windings_.data(), group.size};
    }

  private:
    static constexpr std::uint32_t kLanes = hn::MaxLanes(Ints());
    static constexpr std::size_t kMargin = 2 * BandGroup::kMargin;
    static constexpr std::size_t kPairCapacity = 8 * BandGroup::kCapacity; // twice what is usual
    static constexpr std::uint32_t kBefore = 0x8000'0000;

    template <typename T>
    using Column = std::array<T, BandGroup::kCapacity + BandGroup::kMargin>;

    /// A particle's sum of crossings.
    struct Sum {
        std::int32_t winding; ///< beyond the faces, or before them; or kUnsettled
        std::int32_t sign;    ///< -1 where crossings count between the origin and the particle
        std::size_t last_pair;
    };

    /// Snaps particles to the lattice and finds the parts of their cells that they are in.
    void place(const BandGroup& group, const StridedSpan<const Vec3f>& points) {
        constexpr Floats f;
        for (std::size_t k = 0; k < group.size; ++k) {
            const Vec3f& point = points[static_cast<std::uint32_t>(group.slots[k])];
            x_[k] = point.x;
            y_[k] = point.y;
            z_[k] = point.z;
        }
        for (std::size_t k = 0; k < group.size; k += hn::Lanes(f)) {
            const PointLanes p = snap_({hn::Load(f, &x_[k]), hn::Load(f, &y_[k]), hn::Load(f, &z_[k])});
            hn::Store(p.x, f, &x_[k]);
            hn::Store(p.y, f, &y_[k]);
            hn::Store(p.z, f, &z_[k]);
            hn::Store(parts_of_(p), Ints(), &parts_[k]);
        }
    }

    /// Lists the faces that touch the particles' parts, for particles from the first on.
    /// @returns the first particle whose faces no longer fit, or last
    template <bool kOutermost>
    std::size_t list_pairs(const BandGroup& group, std::size_t first, std::size_t last) {
        return map_.references.wide.empty()
                   ? list_pairs<kOutermost>(map_.references.narrow.data(), group, first, last)
                   : list_pairs<kOutermost>(map_.references.wide.data(), group, first, last);
    }
    template <bool kOutermost, typename Face>
    std::size_t list_pairs(const Face* references, const BandGroup& group, std::size_t first,
                           std::size_t last) {
        const std::size_t reference_count = map_.reference_parts.size();
        const Band* bands = map_.bands.data();
        const std::int16_t* winding_below = map_.winding_below.data();
        std::size_t k = first;
        for (; k < last; ++k) {
            const auto band = static_cast<std::uint32_t>(group.bands[k]);
            const std::uint32_t begin = bands[band].first_reference, end = bands[band + 1].first_reference;
            std::int32_t winding = 0, before = 0;
            if constexpr (!kOutermost) {
                const std::int32_t beyond = winding_below[band + 1], below = winding_below[band];
                before = beyond == ExactMapView::kSplit ? -1 : 0;
                winding = beyond ^ ((beyond ^ below) & before); // without a branch
            }
            const bool left_out = (winding == ExactMapView::kUncertain) | (end - begin > kPairCapacity) |
                                  (end + kMargin > reference_count); // beyond lists is read, too
            if (left_out) [[unlikely]] {
                sums_[k] = {kUnsettled, 1, pair_count_};
                continue;
            }
            if (pair_count_ + (end - begin) > kPairCapacity) [[unlikely]]
                break;
            const auto particle = static_cast<std::int32_t>(static_cast<std::uint32_t>(k) |
                                                            (static_cast<std::uint32_t>(before) & kBefore));
            pair_count_ = add_pairs(references, begin, end, k, particle, pair_count_);
            sums_[k] = {winding, before | 1, pair_count_};
        }
        return k;
    }

    /// @returns the number of pairs
    template <typename Face>
    HWY_INLINE std::size_t add_pairs(const Face* references, std::uint32_t begin, std::uint32_t end,
                                     std::size_t k, std::int32_t particle, std::size_t pair_count) {
        constexpr Ints i;
        const std::uint16_t* parts_of = map_.reference_parts.data();
        const IntLanes wanted = hn::Set(i, parts_[k]);
        const auto add = [&](std::uint32_t from) HWY_ATTR {
            const IntLanes touched = hn::And(load(&parts_of[from]), wanted);
            const IntLanes left = hn::Set(i, static_cast<std::int32_t>(end - from));
            const Compressor compress(hn::AndNot(hn::Eq(touched, hn::Zero(i)), hn::Lt(hn::Iota(i, 0), left)));
            const IntLanes faces = load(&references[from]); // three times kMostFaces is below 2^32
            hn::StoreU(compress(hn::Add(hn::Add(faces, faces), faces)), i, &pair_corners_[pair_count]);
            pair_count += compress.count();
        };
        std::size_t first = pair_count;
        // Twice in any case: few lists are longer, and a branch less is mispredicted less.
        do {
            add(begin);
            add(begin + kLanes);
            begin += 2 * kLanes;
        } while (begin < end);
        do {
            hn::StoreU(hn::Set(i, particle), i, &pair_particles_[first]);
            first += kLanes;
        } while (first < pair_count);
        return pair_count;
    }

    /// Sets the winding numbers of particles [first, last), whose pairs are tested.
    HWY_INLINE void add_up(std::size_t first, std::size_t last) {
        std::size_t pair = 0;
        for (std::size_t k = first; k < last; ++k) {
            const auto [winding, sign, last_pair] = sums_[k];
            const std::int32_t crossings = sum_of(pair, last_pair - pair);
            windings_[k] = winding == kUnsettled ? kUnsettled : winding + sign * crossings;
            pair = last_pair;
        }
    }

    static IntLanes load(const std::uint16_t* numbers) {
        return hn::PromoteTo(Ints(), hn::LoadU(hn::Rebind<std::uint16_t, Ints>(), numbers));
    }
    static IntLanes load(const std::uint32_t* numbers) {
        return hn::BitCast(Ints(), hn::LoadU(hn::RebindToUnsigned<Ints>(), numbers));
    }

    template <typename Vertex>
    void test_pairs(const Vertex* corners) {
        constexpr Floats f;
        constexpr Ints i;
        constexpr hn::Rebind<std::uint8_t, Ints> bytes;
        if (pair_count_ == 0) return;
        // The last vector is filled up with what does no harm.
        hn::StoreU(hn::Zero(i), i, &pair_corners_[pair_count_]);
        hn::StoreU(hn::Set(i, pair_particles_[pair_count_ - 1]), i, &pair_particles_[pair_count_]);
        for (std::size_t first = 0; first < pair_count_; first += hn::Lanes(i)) {
            const IntLanes numbers = hn::Load(i, &pair_particles_[first]);
            const PointLanes p = places_of(first, numbers);
            const auto [crossing, unsure] =
                crossings_of(f, corner_from_p(corners, first, p), corner_from_p(corners + 1, first, p),
                             corner_from_p(corners + 2, first, p), p, numbers);
            const auto raised = hn::BitCast(hn::RebindToUnsigned<Ints>(), hn::Add(crossing, hn::Set(i, 1)));
            hn::Store(hn::TruncateTo(bytes, raised), bytes, &raised_crossings_[first]);
            if (!hn::AllFalse(f, unsure)) [[unlikely]]
                decide(first, unsure);
        }
    }

    /// The particles of a vector of pairs. They are in order, and few have no pair: so they nearly always lie
    /// within a vector's length.
    HWY_INLINE PointLanes places_of(std::size_t first_pair, IntLanes numbers) const {
        constexpr Floats f;
        constexpr Ints i;
        const std::int32_t first = pair_particles_[first_pair] & INT32_MAX;
        const IntLanes lane = hn::Sub(hn::And(numbers, hn::Set(i, INT32_MAX)), hn::Set(i, first));
        const IntLanes within = hn::And(lane, hn::Set(i, static_cast<std::int32_t>(kLanes) - 1));
        if (!hn::AllTrue(i, hn::Eq(lane, within))) [[unlikely]]
            return far_places_of(first_pair);
        const auto from = hn::IndicesFromVec(f, within);
        const auto column = [&](const Column<float>& numbers_of) HWY_ATTR {
            return hn::TableLookupLanes(hn::LoadU(f, &numbers_of[static_cast<std::size_t>(first)]), from);
        };
        return {column(x_), column(y_), column(z_)};
    }

    HWY_NOINLINE PointLanes far_places_of(std::size_t first_pair) const {
        constexpr Floats f;
        alignas(64) std::array<std::array<float, BandGroup::kMargin>, 3> rows;
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
            const auto k = static_cast<std::size_t>(pair_particles_[first_pair + lane] & INT32_MAX);
            rows[0][lane] = x_[k];
            rows[1][lane] = y_[k];
            rows[2][lane] = z_[k];
        }
        return {hn::Load(f, rows[0].data()), hn::Load(f, rows[1].data()), hn::Load(f, rows[2].data())};
    }

    /// A corner of the faces of a vector of pairs, counted from the particles.
    /// @param corners  that corner of face 0
    template <typename Vertex>
    HWY_INLINE PointLanes corner_from_p(const Vertex* corners, std::size_t first_pair,
                                        const PointLanes& p) const {
        constexpr Floats f;
        const std::int32_t* corner_of = &pair_corners_[first_pair];
        const std::int32_t* vertices = &map_.vertices.data()->x;
        // The vertex as the last three numbers of a row.
        const auto [before, x, y, z] =
            load_rows(Ints(), [=](std::size_t lane) HWY_ATTR {
                const std::size_t vertex = corners[static_cast<std::uint32_t>(corner_of[lane])];
                return hn::LoadU(hn::FixedTag<std::int32_t, 4>(), vertices + 3 * vertex - 1);
            }).at;
        return {hn::Sub(hn::ConvertTo(f, x), p.x), hn::Sub(hn::ConvertTo(f, y), p.y),
                hn::Sub(hn::ConvertTo(f, z), p.z)};
    }

    /// Decides pairs by integers.
    HWY_NOINLINE void decide(std::size_t first, FloatMask unsure) {
        constexpr Ints i;
        alignas(64) std::array<std::int32_t, BandGroup::kMargin> lanes;
        hn::Store(hn::VecFromMask(i, hn::RebindMask(i, unsure)), i, lanes.data());
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
            if (lanes[lane] == 0) continue;
            const auto particle = static_cast<std::uint32_t>(pair_particles_[first + lane]);
            const std::size_t k = particle & ~kBefore;
            const LatticePoint p{static_cast<std::int64_t>(x_[k]), static_cast<std::int64_t>(y_[k]),
                                 static_cast<std::int64_t>(z_[k])};
            const auto face = static_cast<std::uint32_t>(pair_corners_[first + lane]) / 3;
            const int crossing = crossing_on(particle & kBefore ? RaySide::Before : RaySide::Beyond,
                                             face_corners(map_, face), p);
            raised_crossings_[first + lane] = static_cast<std::uint8_t>(1 + crossing);
        }
    }

    /// Eight at a time: times a number of eight ones, the highest digit to base 256 is the sum of all digits.
    std::int32_t sum_of(std::size_t first, std::size_t count) const {
        auto sum = -static_cast<std::int32_t>(count);
        for (;; first += 8, count -= 8) {
            std::uint64_t digits;
            std::memcpy(&digits, &raised_crossings_[first], sizeof digits);
            if (count < 8) digits &= (std::uint64_t{1} << 8 * count) - 1;
            sum += static_cast<std::int32_t>(digits * 0x0101'0101'0101'0101U >> 56);
            if (count <= 8) [[likely]]
                return sum;
        }
    }

    const ExactMapView& map_;
    SnapLanes snap_{frame_of(map_)};
    PartLanes parts_of_{map_.divisions};

    // By number in the group.
    alignas(64) Column<float> x_, y_, z_;    ///< on the lattice
    alignas(64) Column<std::int32_t> parts_; ///< of its cell, which may hold the particle: a bit each
    std::array<std::int32_t, BandGroup::kCapacity> windings_;
    std::array<Sum, BandGroup::kCapacity> sums_;
    std::size_t pair_count_ = 0;
    alignas(64) std::array<std::int32_t, kPairCapacity + kMargin> pair_corners_;   ///< the first of each face
    alignas(64) std::array<std::int32_t, kPairCapacity + kMargin> pair_particles_; ///< perhaps with kBefore
    alignas(64) std::array<std::uint8_t, kPairCapacity + kMargin> raised_crossings_; ///< crossing_on() + 1
};

} // namespace echinus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

#endif
