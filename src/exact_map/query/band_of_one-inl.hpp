// Included once for each instruction set, as Highway wants it: no guard against a second time.
#if defined(ECHINUS_BAND_OF_ONE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ECHINUS_BAND_OF_ONE_INL
#undef ECHINUS_BAND_OF_ONE_INL
#else
#define ECHINUS_BAND_OF_ONE_INL
#endif

#include "exact_map/query/crossing_lanes-inl.hpp"
#include "exact_map/query/place_in_bands.hpp"
#include "exact_map/query/ray_crossing.hpp"
#include "simd/rows-inl.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#if HWY_TARGET != HWY_SCALAR // where the reference is used instead
HWY_BEFORE_NAMESPACE();
namespace echinus::HWY_NAMESPACE {

/// Crossings of one place's ray with the faces of its band, which are the lanes.
template <typename Face, typename Vertex>
class BandOfOne {
  public:
    /// @param references, corners  those of the map, in their width
    BandOfOne(const ExactMapView& map, const Face* references, const Vertex* corners, const LatticePoint& p)
        : map_(map), references_(references), corners_(corners), p_(p) {}

    int operator()(RaySide side, const PlaceInBands& at) const {
        const std::uint32_t first = map_.bands[at.band].first_reference;
        const std::uint32_t last = map_.bands[at.band + 1].first_reference;
        std::array<std::uint32_t, kPieceSize + kWidth> faces;
        int sum = 0;
        for (std::uint32_t begin = first; begin < last; begin += kPieceSize) {
            const std::uint32_t end = std::min(begin + kPieceSize, last);
            std::uint32_t count = 0; // of the faces that touch the part; listed without a branch
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
        // The vertex as the last three numbers of a row.
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

/// winding_in_bands() of a place of the lattice.
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

} // namespace echinus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

#endif
