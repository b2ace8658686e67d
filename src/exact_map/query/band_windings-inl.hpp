// Included once per instruction set, as Highway requires; hence the unusual include guard.
#if defined(ECHINUS_BAND_WINDINGS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ECHINUS_BAND_WINDINGS_INL
#undef ECHINUS_BAND_WINDINGS_INL
#else
#define ECHINUS_BAND_WINDINGS_INL
#endif

#include "exact_map/layout.hpp"
#include "exact_map/query/band_search-inl.hpp"
#include "exact_map/query/place_in_bands.hpp"
#include "exact_map/query/ray_crossing.hpp"
#include "simd/compress-inl.hpp"
#include "simd/lanes-inl.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#if HWY_TARGET != HWY_SCALAR // HWY_SCALAR uses the reference instead
HWY_BEFORE_NAMESPACE();
namespace echinus::HWY_NAMESPACE {

/// How faces count for particles: one pair of a face and a particle per lane.
template <typename D>
struct CrossingLanes {
    hn::Vec<hn::RebindToSigned<D>> crossing; ///< the result of crossing_on(), if sure
    hn::Mask<D> unsure;
};

/// A single-precision filter for crossing_on().
///
/// With corners a, b, c relative to the particle p, the ray from the origin through p passes an edge (a, b)
/// on the side given by the sign of p . (a x b), and p lies on the side of the plane given by the sign of a .
/// (b x c). Adding the latter to the sum of the former for all edges gives the volume as seen from the
/// origin.
///
/// Corners are exact here: differences of whole numbers up to 2^19. With m^2 the largest of |a|^2, |b|^2,
/// |c|^2 and u = 2^-24, each component of a x b is off by at most 4 u m^2, and its product with a vector v by
/// at most 10 u |v| m^2 in the L1 norm, which is at most 3 * 2^19 for p and 3 * 2^20 for a: less than m^2 and
/// 2 m^2. The error of three edges and the volume together is thus less than 5 m^2, plus a little for their
/// sum. The filter allows for three times as much.
/// @param f       the tag of the lanes
/// @param before  if its sign bit is set, crossings between the origin and p are wanted; otherwise those
///                beyond p
template <typename D, typename Lanes>
HWY_INLINE CrossingLanes<D> crossings_of(D f, const Vec3Lanes<Lanes>& a, const Vec3Lanes<Lanes>& b,
                                         const Vec3Lanes<Lanes>& c, const Vec3Lanes<Lanes>& p,
                                         hn::Vec<hn::RebindToSigned<D>> before) {
    constexpr hn::RebindToSigned<D> i;
    const Vec3Lanes<Lanes> b_c = fused_cross(b, c);
    const Lanes past_bc = fused_dot(p, b_c);
    const Lanes past_ca = fused_dot(p, fused_cross(c, a));
    const Lanes past_ab = fused_dot(p, fused_cross(a, b));
    const Lanes volume = fused_dot(a, b_c);
    const Lanes bound =
        hn::Mul(hn::Max(hn::Max(fused_dot(a, a), fused_dot(b, b)), fused_dot(c, c)), hn::Set(f, 16));

    // The least absolute value if all have the same sign; negative if their signs differ.
    const Lanes least = hn::Min(hn::Min(past_ab, past_bc), past_ca);
    const Lanes most = hn::Max(hn::Max(past_ab, past_bc), past_ca);
    const Lanes hit = hn::Max(least, hn::Neg(most));
    // If the face is hit from its front, the sign is +. The plane lies ahead of p if the first value is
    // positive, and behind the origin if the second is negative.
    const Lanes sign_bit = hn::SignBit(f);
    const Lanes side = hn::And(past_ab, sign_bit);
    const Lanes ahead = hn::Xor(volume, side);
    const Lanes from_origin = hn::Add(ahead, hn::Abs(hn::Add(hn::Add(past_ab, past_bc), past_ca)));
    const Lanes wanted = hn::Xor(ahead, hn::And(hn::BitCast(f, before), sign_bit));
    const Lanes clear_of_plane = hn::Min(hn::Abs(volume), from_origin);
    const hn::Mask<D> counts = hn::Gt(hn::Min(hit, wanted), bound);
    const hn::Mask<D> unsure = hn::Le(hn::Min(hn::Abs(hit), hn::Max(hn::Neg(hit), clear_of_plane)), bound);
    const auto sign = hn::Or(hn::BroadcastSignBit(hn::BitCast(i, past_ab)), hn::Set(i, 1));
    return {hn::IfThenElseZero(hn::RebindMask(i, counts), sign), unsure};
}

/// Crossings of one point's ray with the faces of its band; the lanes are faces.
template <typename Face, typename Vertex>
class BandOfOne {
  public:
    /// @param references, corners  the arrays of the map, with the width that they are stored in
    BandOfOne(const ExactMapView& map, const Face* references, const Vertex* corners, const LatticePoint& p)
        : map_(map), references_(references), corners_(corners), p_(p) {}

    int operator()(RaySide side, const PlaceInBands& at) const {
        const std::uint32_t first = map_.bands[at.band].first_reference;
        const std::uint32_t last = map_.bands[at.band + 1].first_reference;
        std::array<std::uint32_t, kPieceSize + kWidth> faces;
        int sum = 0;
        for (std::uint32_t begin = first; begin < last; begin += kPieceSize) {
            const std::uint32_t end = std::min(begin + kPieceSize, last);
            std::uint32_t count = 0; // number of faces that touch the part; they are listed without a branch
            for (std::uint32_t r = begin; r < end; ++r) {
                faces[count] = references_[r];
                count += std::uint32_t{map_.reference_parts[r]} >> at.part & 1U;
            }
            if (count == 0) continue;
            std::fill_n(&faces[count], kWidth - 1, faces[0]);
            for (std::uint32_t i = 0; i < count; i += kWidth)
                sum += crossings(side, &faces[i], std::min<std::uint32_t>(kWidth, count - i));
        }
        return sum;
    }

  private:
    static constexpr std::uint32_t kPieceSize = 64, kWidth = 8;
    using Eight = hn::CappedTag<float, kWidth>;
    using Points = Vec3Lanes<hn::Vec<Eight>>;

    HWY_INLINE int crossings(RaySide side, const std::uint32_t* faces, std::uint32_t count) const {
        constexpr Eight f;
        constexpr hn::RebindToSigned<Eight> i;
        const Points p{hn::Set(f, static_cast<float>(p_.x)), hn::Set(f, static_cast<float>(p_.y)),
                       hn::Set(f, static_cast<float>(p_.z))};
        const auto before = hn::Set(i, side == RaySide::Before ? -1 : 0);
        int sum = 0;
        for (std::uint32_t lane = 0; lane < count; lane += static_cast<std::uint32_t>(hn::Lanes(f))) {
            const auto valid = hn::FirstN(i, count - lane);
            const auto [crossing, unsure] =
                crossings_of(f, corner(faces + lane, 0) - p, corner(faces + lane, 1) - p,
                             corner(faces + lane, 2) - p, p, before);
            const auto sure = hn::AndNot(hn::RebindMask(i, unsure), valid);
            sum += hn::GetLane(hn::SumOfLanes(i, hn::IfThenElseZero(sure, crossing)));
            const auto left = hn::And(valid, hn::RebindMask(i, unsure));
            if (!hn::AllFalse(i, left)) [[unlikely]]
                sum += decided(side, faces + lane, left);
        }
        return sum;
    }

    template <typename Mask>
    HWY_NOINLINE int decided(RaySide side, const std::uint32_t* faces, Mask unsure) const {
        std::array<std::uint8_t, 8> bytes{};
        hn::StoreMaskBits(hn::RebindToSigned<Eight>(), unsure, bytes.data());
        int sum = 0;
        for (std::uint32_t bits = bytes[0]; bits != 0; bits &= bits - 1)
            sum += crossing_on(side, face_corners(map_, faces[std::countr_zero(bits)]), p_);
        return sum;
    }

    HWY_INLINE Points corner(const std::uint32_t* faces, std::size_t k) const {
        constexpr Eight f;
        const std::int32_t* vertices = &map_.vertices.data()->x;
        const Vertex* corners = corners_ + k;
        // Loads the vertex as the last three numbers of a row.
        const auto [before, x, y, z] =
            load_rows(hn::RebindToSigned<Eight>(), [=](std::size_t lane) HWY_ATTR {
                const std::size_t vertex = corners[3 * std::size_t{faces[lane]}];
                return hn::LoadU(hn::FixedTag<std::int32_t, 4>(), vertices + 3 * vertex - 1);
            }).at;
        return {hn::ConvertTo(f, x), hn::ConvertTo(f, y), hn::ConvertTo(f, z)};
    }

    const ExactMapView& map_;
    const Face* references_;
    const Vertex* corners_;
    LatticePoint p_;
};

/// winding_in_bands() of a lattice point.
HWY_INLINE int winding_of_one(const ExactMapView& map, const PlaceInBands& at, const LatticePoint& p) {
    const auto by = [&](const auto* references, const auto* corners) {
        return winding_in_bands(map, at, BandOfOne(map, references, corners, p));
    };
    const auto by_references = [&](const auto* references) {
        return map.corners.wide.empty() ? by(references, map.corners.narrow.data())
                                        : by(references, map.corners.wide.data());
    };
    return map.references.wide.empty() ? by_references(map.references.narrow.data())
                                       : by_references(map.references.wide.data());
}

/// Winding numbers around particles in bands.
///
/// A particle in a band has only a few faces to test, too few to fill the lanes of a vector. So pairs of a
/// particle and a face are listed first, for many particles, and then tested, one pair to a lane.
class BandWindings {
  public:
    /// Marks a winding number that is left to the scalar query.
    static constexpr std::int32_t kUnsettled = INT32_MAX;

    explicit BandWindings(const ExactMapView& map) : map_(map) {}

    /// The winding number around each particle of a group, or kUnsettled. Valid until the next call.
    /// @param group   particles with their bands; for the first `outermost_count`, these are the last of
    ///               their cells
    /// @param points  local positions, by slot
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
    static constexpr std::size_t kPairCapacity = 8 * BandGroup::kCapacity; // twice the usual number
    static constexpr std::uint32_t kBefore = 0x8000'0000;

    template <typename T>
    using Column = std::array<T, BandGroup::kCapacity + BandGroup::kMargin>;

    /// A particle's sum of crossings.
    struct Sum {
        std::int32_t winding; ///< beyond the faces or before them, or kUnsettled
        std::int32_t sign;    ///< -1 if crossings count between the origin and the particle
        std::size_t last_pair;
    };

    /// Snaps particles to the lattice and finds the parts of their cells in which they lie.
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

    /// Lists the faces that touch the particles' parts, starting with particle `first`.
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
                winding = beyond ^ ((beyond ^ below) & before); // selects without a branch
            }
            const bool left_out = (winding == ExactMapView::kUncertain) | (end - begin > kPairCapacity) |
                                  (end + kMargin > reference_count); // loads may also read beyond the lists
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
        // Always runs twice: few lists are longer, and one branch fewer means fewer mispredictions.
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

    /// Sets the winding numbers of particles [first, last), whose pairs have been tested.
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
        // Fills the last vector with pairs that do no harm.
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

    /// The particles of a vector of pairs. Pairs are in the order of the particles, few of which have none,
    /// so their particles nearly always lie within the length of a vector.
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

    /// A corner of the faces of a vector of pairs, relative to the particles.
    /// @param corners  the same corner of face 0
    template <typename Vertex>
    HWY_INLINE PointLanes corner_from_p(const Vertex* corners, std::size_t first_pair,
                                        const PointLanes& p) const {
        constexpr Floats f;
        const std::int32_t* corner_of = &pair_corners_[first_pair];
        const std::int32_t* vertices = &map_.vertices.data()->x;
        // Loads the vertex as the last three numbers of a row.
        const auto [before, x, y, z] =
            load_rows(Ints(), [=](std::size_t lane) HWY_ATTR {
                const std::size_t vertex = corners[static_cast<std::uint32_t>(corner_of[lane])];
                return hn::LoadU(hn::FixedTag<std::int32_t, 4>(), vertices + 3 * vertex - 1);
            }).at;
        return {hn::Sub(hn::ConvertTo(f, x), p.x), hn::Sub(hn::ConvertTo(f, y), p.y),
                hn::Sub(hn::ConvertTo(f, z), p.z)};
    }

    /// Decides pairs with integer arithmetic.
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

    /// Sums eight numbers at a time: in the product with a number of eight ones, the highest digit to base
    /// 256 is the sum of all digits.
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

    // Indexed by a particle's number in the group.
    alignas(64) Column<float> x_, y_, z_;    ///< position on the lattice
    alignas(64) Column<std::int32_t> parts_; ///< parts of the cell that may hold the particle, one bit each
    std::array<std::int32_t, BandGroup::kCapacity> windings_;
    std::array<Sum, BandGroup::kCapacity> sums_;
    std::size_t pair_count_ = 0;
    alignas(64) std::array<std::int32_t, kPairCapacity + kMargin> pair_corners_; ///< each face's first corner
    alignas(64) std::array<std::int32_t, kPairCapacity + kMargin> pair_particles_; ///< the particle's number,
                                                                                   ///< with kBefore if set
    alignas(64) std::array<std::uint8_t, kPairCapacity + kMargin> raised_crossings_; ///< crossing_on() + 1
};

} // namespace echinus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

#endif
