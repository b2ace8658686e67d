// Included once for each instruction set, as Highway wants it: no guard against a second time.
#if defined(ECHINUS_CELL_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ECHINUS_CELL_LANES_INL
#undef ECHINUS_CELL_LANES_INL
#else
#define ECHINUS_CELL_LANES_INL
#endif

#include "directions/lattice.hpp"
#include "directions/octahedral_cells.hpp"
#include "simd/lanes-inl.hpp"

#include <cstdint>

#if HWY_TARGET != HWY_SCALAR // where the reference is used instead
HWY_BEFORE_NAMESPACE();
namespace echinus::HWY_NAMESPACE {

/// Where particles are, in single precision.
struct CellLanes {
    FloatLanes l1; ///< the L1 norm in lattice steps; that of the snapped particle is within kL1Error of it
    FloatLanes farthest; ///< the largest coordinate, in lattice steps
    IntLanes cell; ///< below 2^21 where it is sure; elsewhere any number: conversions saturate, products wrap
    FloatMask sure; ///< the snapped particle surely lies in that cell

    static constexpr float kL1Error = 2;
};

/// LatticeFrame::to_lattice() and OctahedralCells::locate(), but for rounding: a difference, the inverse of a
/// step and their product are rounded, by 2^-24 of at most 2^19 each; together less than 1/8 of a step.
/// Snapping moves it by another 1/2.
class LocateLanes {
  public:
    LocateLanes(const Vec3f& centre, const LatticeFrame& frame, std::uint32_t divisions)
        : centre_(centre), inverse_step_(static_cast<float>(frame.inverse_step)),
          n_(static_cast<std::int32_t>(divisions)) {}

    CellLanes operator()(const PointLanes& point_local) const {
        constexpr Floats f;
        constexpr Ints i;
        const FloatLanes x = on_lattice(point_local.x, centre_.x);
        const FloatLanes y = on_lattice(point_local.y, centre_.y);
        const FloatLanes z = on_lattice(point_local.z, centre_.z);
        const FloatLanes abs_x = hn::Abs(x), abs_y = hn::Abs(y), abs_z = hn::Abs(z);
        const FloatLanes l1 = hn::Add(hn::Add(abs_x, abs_y), abs_z);

        const FloatLanes cells_per_step = hn::Div(hn::Set(f, static_cast<float>(n_)), l1);
        const FloatLanes along_x = hn::Mul(abs_x, cells_per_step), along_y = hn::Mul(abs_y, cells_per_step);
        const IntLanes row = hn::ConvertTo(i, along_x), column = hn::ConvertTo(i, along_y);
        const FloatLanes rest_x = hn::Sub(along_x, hn::ConvertTo(f, row));
        const FloatLanes rest_y = hn::Sub(along_y, hn::ConvertTo(f, column));
        const FloatLanes rest = hn::Add(rest_x, rest_y);
        // Of n times a share of the norm: both of them are off by less than 2 steps, and there are 4
        // roundings.
        const FloatLanes slack =
            hn::MulAdd(hn::Set(f, 4), cells_per_step, hn::Set(f, static_cast<float>(n_) * 0x1p-21F));
        const FloatLanes one = hn::Set(f, 1);
        const FloatLanes clearance =
            hn::Min(hn::Min(hn::Min(rest_x, rest_y), hn::Sub(one, hn::Max(rest_x, rest_y))),
                    hn::Abs(hn::Sub(rest, one)));

        // index(), in which `down` is 1: as a number, a mask is 0 or -1.
        const IntLanes minus_down = hn::BitCast(i, hn::VecFromMask(f, hn::Gt(rest, one)));
        const IntLanes before_row = hn::Mul(row, hn::Sub(hn::Set(i, 2 * n_), row));
        const IntLanes in_octant = hn::Sub(hn::Add(before_row, hn::Add(column, column)), minus_down);
        const IntLanes cell = hn::Add(hn::Mul(octant(x, y, z), hn::Set(i, n_ * n_)), in_octant);
        return {l1, hn::Max(hn::Max(abs_x, abs_y), abs_z), cell, hn::Gt(clearance, slack)};
    }

  private:
    FloatLanes on_lattice(FloatLanes local, float centre) const {
        constexpr Floats f;
        return hn::Mul(hn::Sub(local, hn::Set(f, centre)), hn::Set(f, inverse_step_));
    }

    static IntLanes octant(FloatLanes x, FloatLanes y, FloatLanes z) {
        constexpr Ints i;
        const auto bit = [&](FloatLanes coordinate, std::int32_t value) {
            return hn::And(hn::BroadcastSignBit(hn::BitCast(i, coordinate)), hn::Set(i, value));
        };
        return hn::Or(hn::Or(bit(x, 1), bit(y, 2)), bit(z, 4));
    }

    Vec3f centre_;
    float inverse_step_;
    std::int32_t n_;
};

/// LatticeFrame::to_lattice() and rounded(), in the same arithmetic: whole numbers. What is not on the
/// lattice goes to 2^20.
class SnapLanes {
  public:
    explicit SnapLanes(const LatticeFrame& frame) : frame_(frame) {}

    PointLanes operator()(const PointLanes& point_local) const {
        return {snapped(point_local.x, frame_.centre.x), snapped(point_local.y, frame_.centre.y),
                snapped(point_local.z, frame_.centre.z)};
    }

  private:
    FloatLanes snapped(FloatLanes local, double centre) const {
        constexpr hn::Half<Floats> half;
        return hn::Combine(Floats(), snapped_half(hn::UpperHalf(half, local), centre),
                           snapped_half(hn::LowerHalf(half, local), centre));
    }

    hn::Vec<hn::Half<Floats>> snapped_half(hn::Vec<hn::Half<Floats>> local, double centre) const {
        constexpr hn::Repartition<double, Floats> d;
        const auto place =
            hn::Mul(hn::Sub(hn::PromoteTo(d, local), hn::Set(d, centre)), hn::Set(d, frame_.inverse_step));
        constexpr auto kExtent = static_cast<double>(kLatticeExtent);
        const auto on_lattice = hn::Le(hn::Abs(place), hn::Set(d, kExtent + 0.5)); // not NaN
        const auto usable = hn::IfThenElse(on_lattice, place, hn::Set(d, 2 * kExtent));
        return hn::DemoteTo(hn::Half<Floats>(), hn::Round(usable));
    }

    LatticeFrame frame_;
};

/// Parts of cells in which particles on the lattice lie, a bit each, as of ExactMapView::reference_parts.
class PartLanes {
  public:
    explicit PartLanes(std::uint32_t divisions)
        : fine_n_(static_cast<float>(OctahedralCells::kPartsPerSide * divisions)) {}

    /// All of them for a particle that is so close to a wall that rounding may decide, and for the origin,
    /// whose quotients are NaN. Else row and column are below 2^11.
    IntLanes operator()(const PointLanes& p) const {
        constexpr Floats f;
        constexpr Ints i;
        const FloatLanes parts_per_step = hn::Div(hn::Set(f, fine_n_), l1_norm(p));
        const FloatLanes along_x = hn::Mul(hn::Abs(p.x), parts_per_step);
        const FloatLanes along_y = hn::Mul(hn::Abs(p.y), parts_per_step);
        const IntLanes row = hn::ConvertTo(i, along_x), column = hn::ConvertTo(i, along_y);
        const FloatLanes rest_x = hn::Sub(along_x, hn::ConvertTo(f, row));
        const FloatLanes rest_y = hn::Sub(along_y, hn::ConvertTo(f, column));
        const FloatLanes rest = hn::Add(rest_x, rest_y);
        const FloatLanes one = hn::Set(f, 1);
        const FloatLanes clearance =
            hn::Min(hn::Min(hn::Min(rest_x, rest_y), hn::Sub(one, hn::Max(rest_x, rest_y))),
                    hn::Abs(hn::Sub(rest, one)));
        const FloatMask sure = hn::Gt(clearance, hn::Set(f, fine_n_ * 0x1p-21F));

        const IntLanes three = hn::Set(i, OctahedralCells::kPartsPerSide - 1);
        const IntLanes minus_down = hn::BitCast(i, hn::VecFromMask(f, hn::Gt(rest, one)));
        const IntLanes part_row = hn::And(row, three), part_column = hn::And(column, three);
        // A cell that is down counts from the other end.
        const IntLanes turned =
            hn::VecFromMask(i, hn::Gt(hn::Sub(hn::Add(part_row, part_column), minus_down), three));
        const IntLanes flip = hn::And(turned, three);
        const IntLanes part_i = hn::Xor(part_row, flip), part_j = hn::Xor(part_column, flip);
        const IntLanes down = hn::Xor(minus_down, turned); // 0 or -1
        const IntLanes part =
            hn::Sub(hn::Add(hn::Mul(part_i, hn::Sub(hn::Set(i, 8), part_i)), hn::Add(part_j, part_j)), down);
        const IntLanes all = hn::Set(i, (1 << OctahedralCells::kPartCount) - 1);
        return hn::IfThenElse(hn::RebindMask(i, sure), hn::Shl(hn::Set(i, 1), part), all);
    }

  private:
    float fine_n_;
};

} // namespace echinus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

#endif
