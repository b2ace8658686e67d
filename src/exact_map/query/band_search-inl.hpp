// Included once per instruction set, as Highway requires; hence the unusual include guard.
#if defined(ECHINUS_BAND_SEARCH_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ECHINUS_BAND_SEARCH_INL
#undef ECHINUS_BAND_SEARCH_INL
#else
#define ECHINUS_BAND_SEARCH_INL
#endif

#include "directions/lattice.hpp"
#include "directions/octahedral_cells.hpp"
#include "exact_map/layout.hpp"
#include "simd/compress-inl.hpp"
#include "simd/lanes-inl.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#if HWY_TARGET != HWY_SCALAR // HWY_SCALAR uses the reference instead
HWY_BEFORE_NAMESPACE();
namespace echinus::HWY_NAMESPACE {

/// Where particles lie, computed in single precision.
struct CellLanes {
    FloatLanes l1;       ///< L1 norm in lattice steps; that of the snapped particle is within kL1Error of it
    FloatLanes farthest; ///< the largest coordinate, in lattice steps
    IntLanes cell;       ///< below 2^21 if sure, otherwise any number: conversions saturate, products wrap
    FloatMask sure;      ///< the snapped particle certainly lies in that cell

    static constexpr float kL1Error = 2;
};

/// LatticeFrame::to_lattice() and OctahedralCells::locate(), except for rounding: a difference, the inverse
/// of a step and their product are each rounded by 2^-24 of at most 2^19, together by less than 1/8 of a
/// step. Snapping moves the particle by up to 1/2 more.
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
        // The error of n times a share of the norm: numerator and denominator are each off by less than 2
        // steps, and there are 4 roundings.
        const FloatLanes slack =
            hn::MulAdd(hn::Set(f, 4), cells_per_step, hn::Set(f, static_cast<float>(n_) * 0x1p-21F));
        const FloatLanes one = hn::Set(f, 1);
        const FloatLanes clearance =
            hn::Min(hn::Min(hn::Min(rest_x, rest_y), hn::Sub(one, hn::Max(rest_x, rest_y))),
                    hn::Abs(hn::Sub(rest, one)));

        // index(), in which `down` is 1; as a number, a mask is 0 or -1.
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

/// LatticeFrame::to_lattice() and rounded() with the same arithmetic; the results are whole numbers. Points
/// beyond the lattice are moved to 2^20.
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

/// The parts of their cells in which particles on the lattice lie, one bit each, as in
/// ExactMapView::reference_parts.
class PartLanes {
  public:
    explicit PartLanes(std::uint32_t divisions)
        : fine_n_(static_cast<float>(OctahedralCells::kPartsPerSide * divisions)) {}

    /// All parts for a particle so close to a wall that rounding might decide, and for the origin, whose
    /// quotients are NaN. For all others row and column are below 2^11.
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
        // A down cell is numbered from the other end.
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

/// Some particles of a piece of a batch, each with a band. Stores write a whole vector, of which only the
/// first few lanes count.
struct BandGroup {
    static constexpr std::size_t kCapacity = 512; ///< particles per piece
    static constexpr std::size_t kMargin = 16;    ///< lanes of the widest vector

    std::size_t size = 0;
    alignas(64) std::array<std::int32_t, kCapacity + kMargin> slots; ///< the particles' indices in the piece
    alignas(64) std::array<std::int32_t, kCapacity + kMargin> bands;

    void add(IntMask mask, IntLanes slot, IntLanes band) {
        constexpr Ints i;
        const Compressor compress(mask);
        hn::StoreU(compress(band), i, &bands[size]);
        hn::StoreU(compress(slot), i, &slots[size]);
        size += compress.count();
    }
};

/// Finds the gaps or bands of as many particles at once as there are lanes.
///
/// Values of a cell or a band are fetched by scalar loads in a separate loop rather than by gather
/// instructions, which are slower on many processors.
class BandSearch {
  public:
    explicit BandSearch(const ExactMapView& map) : map_(map) {}

    BandGroup in_bands;              ///< the particles in bands, with their bands
    std::size_t outermost_count = 0; ///< this many of in_bands, the first, are in outermost bands of cells
    BandGroup in_gaps; ///< particles in gaps, with the band beyond the gap; without those beyond all bands
    /// The slots of particles that may be in a gap or a band, some perhaps twice; for an open surface also of
    /// those beyond all bands.
    std::span<const std::int32_t> unsure() const { return {unsure_.data(), unsure_count_}; }

    /// @param points  local positions: whole vectors, at most BandGroup::kCapacity points. A particle's slot
    ///                is its index in them
    void find(const StridedSpan<const Vec3f>& points) {
        in_bands.size = in_gaps.size = below_.size = unsure_count_ = 0;
        locate(points);
        compare_with_outer_limits(points.size());
        compare_with_outermost();
        compare_with_inner();
    }

  private:
    static constexpr float kSurelyOnLattice = static_cast<float>(kLatticeExtent) - 1;
    static constexpr float kSurelyBeyondLattice = static_cast<float>(kLatticeExtent) + 2;
    /// An L1 norm greater than that of any point in the bounding sphere.
    static constexpr float kBeyondSphere = 1.75F * static_cast<float>(kLatticeExtent);
    /// An L1 norm that no band reaches, whatever its 16 bits are.
    static constexpr float kBeyondBands = 2.0F * (UINT16_MAX + 1) * ExactMapView::kBandUnit;
    template <typename T>
    using Column = std::array<T, BandGroup::kCapacity>;

    void leave_unsure(IntLanes slots, IntMask mask) {
        constexpr Ints i;
        if (hn::AllFalse(i, mask)) [[likely]]
            return;
        const Compressor compress(mask);
        hn::StoreU(compress(slots), i, &unsure_[unsure_count_]);
        unsure_count_ += compress.count();
    }

    static IntLanes slots_from(std::size_t slot) { return hn::Iota(Ints(), static_cast<std::int32_t>(slot)); }

    /// Loads as many points as there are lanes.
    /// @param is_packed  the points are contiguous
    static PointLanes load(const StridedSpan<const Vec3f>& points, std::size_t first, bool is_packed) {
        constexpr Floats f;
        if (is_packed) {
            FloatLanes x, y, z;
            hn::LoadInterleaved3(f, &points[first].x, x, y, z);
            return {x, y, z};
        }
        alignas(64) std::array<std::array<float, BandGroup::kMargin>, 3> rows;
        for (std::size_t lane = 0; lane < hn::Lanes(f); ++lane) {
            const Vec3f& point = points[first + lane];
            rows[0][lane] = point.x;
            rows[1][lane] = point.y;
            rows[2][lane] = point.z;
        }
        return {hn::Load(f, rows[0].data()), hn::Load(f, rows[1].data()), hn::Load(f, rows[2].data())};
    }

    void locate(const StridedSpan<const Vec3f>& points) {
        constexpr Floats f;
        constexpr Ints i;
        const bool is_packed = points.size() > 1 && &points[1] == &points[0] + 1;
        for (std::size_t slot = 0; slot < points.size(); slot += hn::Lanes(f)) {
            const CellLanes at = locate_(load(points, slot, is_packed));
            const FloatMask on_lattice = hn::Lt(at.farthest, hn::Set(f, kSurelyOnLattice));
            const FloatMask located = hn::And(at.sure, on_lattice);
            hn::Store(hn::IfThenElse(located, at.l1, hn::Set(f, kBeyondBands)), f, &l1_[slot]);
            hn::Store(hn::IfThenElseZero(hn::RebindMask(i, located), at.cell), i, &cells_[slot]);
            if (is_open_) continue; // a particle that was not located then counts as beyond all bands
            const FloatMask far = hn::Or(hn::Ge(at.l1, hn::Set(f, kBeyondSphere)),
                                         hn::Gt(at.farthest, hn::Set(f, kSurelyBeyondLattice)));
            leave_unsure(slots_from(slot), hn::RebindMask(i, hn::Not(hn::Or(located, far))));
        }
    }

    /// The limits of a band, in lattice steps.
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

    /// Packs both limits of a band into one number, as limits() expects them.
    std::int32_t limits_of(std::uint32_t band) const {
        const Band& limits = map_.bands[band];
        return static_cast<std::int32_t>(std::uint32_t{limits.upper} << 16 | limits.lower);
    }

    /// Is a particle certainly on one side of a limit?
    static IntMask surely_beyond(FloatLanes l1, FloatLanes limit) {
        return hn::RebindMask(Ints(), hn::Ge(l1, hn::Add(limit, hn::Set(Floats(), CellLanes::kL1Error))));
    }
    static IntMask surely_below(FloatLanes l1, FloatLanes limit) {
        return hn::RebindMask(Ints(), hn::Lt(l1, hn::Sub(limit, hn::Set(Floats(), CellLanes::kL1Error))));
    }

    /// Most particles are beyond all bands of their cell, so the outer limit of the last band suffices.
    void compare_with_outer_limits(std::size_t count) {
        constexpr Ints i;
        for (std::size_t slot = 0; slot < count; ++slot)
            limits_[slot] = map_.outer_limits[static_cast<std::size_t>(cells_[slot])];
        for (std::size_t slot = 0; slot < count; slot += hn::Lanes(i)) {
            const FloatLanes l1 = hn::Load(Floats(), &l1_[slot]);
            const FloatLanes limit = hn::Mul(hn::ConvertTo(Floats(), hn::Load(i, &limits_[slot])),
                                             hn::Set(Floats(), ExactMapView::kBandUnit));
            const IntMask beyond = surely_beyond(l1, limit);
            if (is_open_) [[unlikely]]
                leave_unsure(slots_from(slot), beyond);
            // Stored with the cell for now; its bands are looked up next. No such particle is in a cell
            // without bands, since the cell of a particle less than kL1Error from the centre is not sure.
            below_.add(hn::Not(beyond), slots_from(slot), hn::Load(i, &cells_[slot]));
        }
    }

    void compare_with_outermost() {
        constexpr Floats f;
        constexpr Ints i;
        const std::size_t count = below_.size;
        for (std::size_t k = 0; k < count; ++k) {
            const auto slot = static_cast<std::size_t>(below_.slots[k]);
            const auto cell = static_cast<std::size_t>(below_.bands[k]);
            const std::uint32_t band = map_.band_offsets[cell + 1] - 1;
            first_bands_[slot] = static_cast<std::int32_t>(map_.band_offsets[cell]);
            bands_[k] = static_cast<std::int32_t>(band); // below 2^31, as the build ensures
            limits_[k] = limits_of(band);
            inner_l1_[k] = l1_[slot];
        }
        below_.size = 0;
        for (std::size_t k = 0; k < count; k += hn::Lanes(i)) {
            const IntMask valid = hn::FirstN(i, count - k);
            const FloatLanes l1 = hn::Load(f, &inner_l1_[k]);
            const auto [lower, upper] = limits(hn::Load(i, &limits_[k]));
            const IntLanes slots = hn::Load(i, &below_.slots[k]), bands = hn::Load(i, &bands_[k]);
            const IntMask below = surely_below(l1, lower);
            const IntMask in_band = hn::And(surely_beyond(l1, lower), surely_below(l1, upper));
            in_bands.add(hn::And(valid, in_band), slots, bands);
            below_.add(hn::And(valid, below), slots, bands);
            leave_unsure(slots, hn::AndNot(hn::Or(in_band, below), valid));
        }
        outermost_count = in_bands.size;
    }

    /// Compares the particles below a band with the next band inwards, until none is left.
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
            below_.size = 0; // results are written before the entries that are still to be read
            for (std::size_t k = 0; k < count; k += hn::Lanes(i)) {
                const IntMask valid = hn::FirstN(i, count - k);
                const IntLanes slots = hn::Load(i, &below_.slots[k]), above = hn::Load(i, &below_.bands[k]);
                const IntLanes bands = hn::Load(i, &bands_[k]);
                const FloatLanes l1 = hn::Load(f, &inner_l1_[k]);
                const auto [lower, upper] = limits(hn::Load(i, &limits_[k]));
                const IntMask in_gap = surely_beyond(l1, upper), below = surely_below(l1, lower);
                const IntMask in_band = hn::And(surely_beyond(l1, lower), surely_below(l1, upper));
                in_gaps.add(hn::And(valid, in_gap), slots, above);
                in_bands.add(hn::And(valid, in_band), slots, bands);
                below_.add(hn::And(valid, below), slots, bands);
                leave_unsure(slots, hn::AndNot(hn::Or(hn::Or(in_gap, below), in_band), valid));
            }
        }
    }

    const ExactMapView& map_;
    bool is_open_ = !map_.border.empty();
    LocateLanes locate_{map_.centre, frame_of(map_), map_.divisions};

    alignas(64) Column<float> l1_, inner_l1_;
    alignas(64) Column<std::int32_t> cells_, first_bands_, bands_, limits_;
    BandGroup below_; ///< particles below the limit that they were last compared with
    std::array<std::int32_t, 2 * BandGroup::kCapacity + BandGroup::kMargin> unsure_;
    std::size_t unsure_count_ = 0;
};

} // namespace echinus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

#endif
