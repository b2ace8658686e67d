// Compiled once per instruction set, hence the guard that toggles: which cell particles lie in, and the
// corners of faces, several at a time.

#if defined(ECHINUS_CLASSIFIED_GRID_LOOKUP_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ECHINUS_CLASSIFIED_GRID_LOOKUP_INL
#undef ECHINUS_CLASSIFIED_GRID_LOOKUP_INL
#else
#define ECHINUS_CLASSIFIED_GRID_LOOKUP_INL
#endif

#include "rivals/classified_grid/layout.hpp"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
#if HWY_TARGET != HWY_SCALAR // the reference stands for it
namespace echinus::rivals::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, 16>;
using Ints = hn::Rebind<std::int32_t, Floats>;

template <class V>
struct Vectors {
    V x, y, z;
};
using FloatVectors = Vectors<hn::VFromD<Floats>>;
using IntVectors = Vectors<hn::VFromD<Ints>>;

template <class V>
HWY_ATTR HWY_INLINE Vectors<V> sub(const Vectors<V>& a, const Vectors<V>& b) {
    return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
template <class V>
HWY_ATTR HWY_INLINE Vectors<V> scaled(const Vectors<V>& a, const V s) {
    return {hn::Mul(a.x, s), hn::Mul(a.y, s), hn::Mul(a.z, s)};
}
template <class V>
HWY_ATTR HWY_INLINE Vectors<V> cross(const Vectors<V>& a, const Vectors<V>& b) {
    return {hn::MulSub(a.y, b.z, hn::Mul(a.z, b.y)), hn::MulSub(a.z, b.x, hn::Mul(a.x, b.z)),
            hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x))};
}
template <class V>
HWY_ATTR HWY_INLINE V dot(const Vectors<V>& a, const Vectors<V>& b) {
    return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}
/// The longest component.
template <class V>
HWY_ATTR HWY_INLINE V longest(const Vectors<V>& a) {
    return hn::Max(hn::Max(hn::Abs(a.x), hn::Abs(a.y)), hn::Abs(a.z));
}
HWY_ATTR HWY_INLINE hn::Mask<Floats> is_zero(const FloatVectors& a) {
    return hn::Eq(longest(a), hn::Zero(Floats()));
}

HWY_ATTR HWY_INLINE hn::VFromD<Ints> mul_add(hn::VFromD<Ints> a, std::int32_t factor, hn::VFromD<Ints> b) {
    return hn::Add(hn::Mul(a, hn::Set(Ints(), factor)), b);
}

/// Numbers of Indices, 16 at a time. @pre one element more than is asked for can be read
class IndexGather {
  public:
    explicit IndexGather(const Indices& indices)
        : base_(indices.wide.empty() ? reinterpret_cast<const std::int32_t*>(indices.narrow.data())
                                     : reinterpret_cast<const std::int32_t*>(indices.wide.data())),
          narrow_(indices.wide.empty()) {}

    HWY_ATTR HWY_INLINE hn::VFromD<Ints> operator()(hn::VFromD<Ints> i) const {
        const Ints di;
        if (narrow_) return hn::And(hn::GatherOffset(di, base_, hn::ShiftLeft<1>(i)), hn::Set(di, 0xFFFF));
        return hn::GatherIndex(di, base_, i);
    }

  private:
    const std::int32_t* base_;
    bool narrow_;
};

/// Where particles are in the grid. Rounds as GridFrame::in_cells() does.
class CellLookup {
  public:
    HWY_ATTR explicit CellLookup(const GridArrays& grid)
        : frame_(grid.frame), numbers_(grid.brick_numbers),
          bricks_(reinterpret_cast<const std::int32_t*>(grid.bricks.data())) {}

    struct Found {
        hn::VFromD<Ints> state; ///< CellState; 0 beyond the grid
        hn::VFromD<Ints> cell;  ///< number of the brick << 6 | number in the brick
    };

    HWY_ATTR HWY_INLINE Found operator()(hn::VFromD<Floats> x, hn::VFromD<Floats> y,
                                         hn::VFromD<Floats> z) const {
        const Floats df;
        const Ints di;
        const FloatVectors g = in_cells(x, y, z);
        const auto within =
            hn::And(hn::And(is_within(g.x, frame_.cell_limits.x), is_within(g.y, frame_.cell_limits.y)),
                    is_within(g.z, frame_.cell_limits.z));
        const auto whole = [&](hn::VFromD<Floats> v)
                               HWY_ATTR { return hn::ConvertTo(di, hn::IfThenElseZero(within, v)); };
        const auto cx = whole(g.x), cy = whole(g.y), cz = whole(g.z);
        const auto row = mul_add(hn::ShiftRight<2>(cz), frame_.brick_counts[1], hn::ShiftRight<2>(cy));
        const auto place = mul_add(row, frame_.brick_counts[0], hn::ShiftRight<2>(cx));
        const auto number = numbers_(place);
        const auto three = hn::Set(di, 3);
        const auto layer = hn::And(cz, three);
        const auto in_layer = hn::Or(hn::And(cx, three), hn::ShiftLeft<2>(hn::And(cy, three)));
        static_assert(sizeof(Brick) == 6 * sizeof(std::int32_t));
        const auto states = hn::GatherIndex(di, bricks_, mul_add(number, 6, layer));
        const hn::Rebind<std::uint32_t, Floats> du;
        const auto state = hn::Shr(hn::BitCast(du, states), hn::BitCast(du, hn::Add(in_layer, in_layer)));
        return {hn::IfThenElseZero(hn::RebindMask(di, within), hn::And(hn::BitCast(di, state), three)),
                hn::Or(hn::ShiftLeft<6>(number), hn::Or(hn::ShiftLeft<4>(layer), in_layer))};
    }

    struct InCell {
        FloatVectors place; ///< from the centre of the cell, snapped: whole numbers
        IntVectors centre;
    };

    /// @pre within the grid
    HWY_ATTR HWY_INLINE InCell from_centre(hn::VFromD<Floats> x, hn::VFromD<Floats> y,
                                           hn::VFromD<Floats> z) const {
        const FloatVectors g = in_cells(x, y, z);
        const Vec3d& c = frame_.lattice.centre;
        const IntVectors centre{centre_of(g.x, frame_.origin.x), centre_of(g.y, frame_.origin.y),
                                centre_of(g.z, frame_.origin.z)};
        return {{from_centre(x, c.x, centre.x), from_centre(y, c.y, centre.y), from_centre(z, c.z, centre.z)},
                centre};
    }

    HWY_ATTR HWY_INLINE FloatVectors in_cells(hn::VFromD<Floats> x, hn::VFromD<Floats> y,
                                              hn::VFromD<Floats> z) const {
        const Floats df;
        const auto scale = hn::Set(df, frame_.cells_per_unit);
        const auto along = [&](hn::VFromD<Floats> v, float centre, float shift) HWY_ATTR {
            return hn::Add(hn::Mul(hn::Sub(v, hn::Set(df, centre)), scale), hn::Set(df, shift));
        };
        return {along(x, frame_.centre.x, frame_.shift.x), along(y, frame_.centre.y, frame_.shift.y),
                along(z, frame_.centre.z, frame_.shift.z)};
    }

  private:
    HWY_ATTR HWY_INLINE static hn::Mask<Floats> is_within(hn::VFromD<Floats> g, float limit) {
        const Floats df;
        return hn::And(hn::Ge(g, hn::Zero(df)), hn::Lt(g, hn::Set(df, limit)));
    }

    HWY_ATTR HWY_INLINE hn::VFromD<Ints> centre_of(hn::VFromD<Floats> in_cells, std::int32_t origin) const {
        const Ints di;
        return mul_add(hn::ConvertTo(di, in_cells), frame_.cell_steps,
                       hn::Set(di, origin + frame_.cell_steps / 2));
    }

    HWY_ATTR HWY_INLINE hn::VFromD<Floats> from_centre(hn::VFromD<Floats> v, double lattice_centre,
                                                       hn::VFromD<Ints> centre) const {
        const Floats df;
        const Ints di;
        const hn::Half<Floats> df_half;
        const hn::Rebind<double, hn::Half<Floats>> dd;
        const auto snapped = [&](hn::VFromD<hn::Half<Floats>> part) HWY_ATTR {
            const auto place = hn::Mul(hn::Sub(hn::PromoteTo(dd, part), hn::Set(dd, lattice_centre)),
                                       hn::Set(dd, frame_.lattice.inverse_step));
            return hn::DemoteTo(df_half, hn::Round(place)); // whole and below 2^20: exact
        };
        const auto lattice =
            hn::Combine(df, snapped(hn::UpperHalf(df_half, v)), snapped(hn::LowerHalf(df_half, v)));
        return hn::ConvertTo(df, hn::Sub(hn::ConvertTo(di, lattice), centre));
    }

    const GridFrame& frame_;
    IndexGather numbers_;
    const std::int32_t* bricks_;
};

struct FaceVectors {
    FloatVectors a, b, c;
};

/// Corners of faces, counted from a centre each: whole numbers below 2^22, exact as floats. Loads one face
/// after the other: gather instructions took longer.
class FaceGather {
  public:
    HWY_ATTR explicit FaceGather(const GridArrays& grid)
        : narrow_(grid.corners.narrow.data()),
          wide_(grid.corners.wide.empty() ? nullptr : grid.corners.wide.data()),
          vertices_(grid.vertices.data()) {}

    /// @param face_of  the face of a lane, by its number
    template <class FaceOf>
    HWY_ATTR HWY_INLINE FaceVectors operator()(const FaceOf& face_of, const IntVectors& centre) const {
        return wide_ != nullptr ? load(wide_, face_of, centre) : load(narrow_, face_of, centre);
    }

  private:
    template <class Index, class FaceOf>
    HWY_ATTR HWY_INLINE FaceVectors load(const Index* corners, const FaceOf& face_of,
                                         const IntVectors& centre) const {
        alignas(64) PackedPoint points[3][16];
        for (std::size_t lane = 0; lane < hn::Lanes(Ints()); ++lane) {
            const Index* face = corners + 3 * std::size_t{face_of(lane)};
            points[0][lane] = vertices_[face[0]];
            points[1][lane] = vertices_[face[1]];
            points[2][lane] = vertices_[face[2]];
        }
        return {places(points[0], centre), places(points[1], centre), places(points[2], centre)};
    }

    HWY_ATTR HWY_INLINE static FloatVectors places(const PackedPoint* points, const IntVectors& centre) {
        const Floats df;
        const Ints di;
        const hn::Rebind<std::uint32_t, Floats> du;
        hn::VFromD<decltype(du)> low_bits, high_bits;
        hn::LoadInterleaved2(du, &points[0].low, low_bits, high_bits);
        const auto low = hn::BitCast(di, low_bits), high = hn::BitCast(di, high_bits);
        // As unpacked() does.
        const auto x = hn::ShiftRight<11>(hn::ShiftLeft<11>(low));
        const auto y = hn::Or(hn::ShiftRight<11>(hn::ShiftLeft<22>(high)),
                              hn::BitCast(di, hn::ShiftRight<21>(low_bits)));
        const auto z = hn::ShiftRight<11>(high);
        return {hn::ConvertTo(df, hn::Sub(x, centre.x)), hn::ConvertTo(df, hn::Sub(y, centre.y)),
                hn::ConvertTo(df, hn::Sub(z, centre.z))};
    }

    const std::uint16_t* narrow_;
    const std::uint32_t* wide_; ///< null where the other is used
    const PackedPoint* vertices_;
};

} // namespace echinus::rivals::HWY_NAMESPACE
#endif
HWY_AFTER_NAMESPACE();

#endif
