// The queries of query.cpp on vectors of particles: the same operations in the same order, hence the same
// bits.
//
// The corners of a cell are in two rows, as two neighbours each, so that two loads of four numbers give the
// offsets of all four samples, and one load for each sample gives its first four entries. If that does not
// suffice (at the seam and the poles, at the ends of the arrays, with more than four layers), the particle is
// one of the "others", for which gathers are used.

#include "distance_map/layout.hpp"

#include <cstring>
#include <limits>

#if defined(ECHINUS_DISTANCE_MAP_QUERY_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef ECHINUS_DISTANCE_MAP_QUERY_LANES_INL_HPP
#undef ECHINUS_DISTANCE_MAP_QUERY_LANES_INL_HPP
#else
#define ECHINUS_DISTANCE_MAP_QUERY_LANES_INL_HPP
#endif

#include "distance_map/query/entry_lanes-inl.hpp"

#if HWY_TARGET != HWY_SCALAR // whose vectors have one lane
HWY_BEFORE_NAMESPACE();
namespace echinus {
namespace HWY_NAMESPACE {
namespace { // private to this folder

// ---- The intermediate results for a vector of particles, step by step

template <typename Grid>
struct Rays {
    PointLanes along;
    FloatLanes length;
    typename Grid::Coordinates at;
};

/// The lanes of Interpolation of interpolation.hpp.
template <typename Grid>
struct Samples {
    typename Grid::Cell cell;
    std::array<FloatLanes, 4> weight;
    std::array<FloatMask, 4> usable;
    FloatLanes weight_sum;
    IntLanes entry_count;
};

struct Intervals {
    IntLanes number;
    FloatLanes below, above;
};

struct Ends {
    FloatMask exist;
    IntLanes k;
    FloatLanes distance;
};

struct Contacts {
    PointLanes point, normal;
    FloatLanes depth;
    FloatMask inside;
};

/// The first four entries of each sample: rows[corner].at[k].
template <typename Grid>
struct LoadedEntries {
    static constexpr std::int32_t kMaxEntries = 4;

    const Grid& grid;
    const EntryLanes& entries;
    std::array<Rows, 4> rows;

    HWY_INLINE LoadedEntries(const Grid& grid_, const EntryLanes& entries_,
                             const std::array<IntLanes, 4>& first, FloatMask wanted)
        : grid(grid_), entries(entries_), rows(at_corners([&](std::size_t corner) HWY_ATTR {
              return entries_.load_rows(hn::IfThenElseZero(as_int_mask(wanted), first[corner]));
          })) {}

    /// The interpolants of the k-th entries, the same k for all lanes.
    HWY_INLINE std::array<FloatLanes, 4> operator()(std::int32_t k) const {
        return at_corners([&](std::size_t corner)
                              HWY_ATTR { return interpolant(rows[corner].at[static_cast<std::size_t>(k)]); });
    }
    HWY_INLINE std::array<FloatLanes, 4> operator()(IntLanes k) const {
        const FloatMask odd = is_odd(k);
        const FloatMask late = as_mask(hn::Gt(k, splat_int(1)));
        return at_corners([&](std::size_t corner) HWY_ATTR {
            const auto& at = rows[corner].at;
            return interpolant(choose(late, choose(odd, at[3], at[2]), choose(odd, at[1], at[0])));
        });
    }

  private:
    HWY_INLINE FloatLanes interpolant(FloatLanes loaded) const {
        return grid.interpolant(entries.entry_of(loaded));
    }
};

/// Entries at any position.
template <typename Grid>
struct GatheredEntries {
    static constexpr std::int32_t kMaxEntries = std::numeric_limits<std::int32_t>::max();

    const Grid& grid;
    const EntryLanes& entries;
    std::array<IntLanes, 4> first;
    IntLanes count;

    HWY_INLINE std::array<FloatLanes, 4> operator()(std::int32_t k) const { return (*this)(splat_int(k)); }
    HWY_INLINE std::array<FloatLanes, 4> operator()(IntLanes k) const {
        const IntMask exists = hn::Lt(k, count);
        return at_corners([&](std::size_t corner) HWY_ATTR {
            const IntLanes position = hn::IfThenElseZero(exists, hn::Add(first[corner], k));
            return grid.interpolant(entries.gather(position));
        });
    }
};

template <typename Grid>
class Kernel {
  public:
    explicit Kernel(const DistanceMapView& map)
        : map_(map), grid_(map), entries_(map),
          direction_count_(static_cast<std::int32_t>(map.direction_count())),
          entry_count_(static_cast<std::int32_t>(map.entry_count())),
          centre_inside_(splat_mask(map.centre_inside)) {}

    /// Answers a vector of consecutive particles, except those for which rows of entries do not suffice.
    /// @return the particles without an answer
    HWY_INLINE FloatMask contains_most(const Vec3f* points, std::uint8_t* inside) const {
        const Rays<Grid> rays = aim(load(points));
        const FloatMask reaches = hn::Le(rays.length, splat(map_.radius));
        Neighbours found = look_at_rows(rays, reaches);
        const LoadedEntries<Grid> entries(grid_, entries_, found.first, found.known);
        store(is_inside_at(rays, found, entries), inside);
        return hn::AndNot(found.known, reaches);
    }

    HWY_INLINE FloatMask contacts_most(const Vec3f* points, float margin, Contact* contacts) const {
        const PointLanes point = load(points);
        const Rays<Grid> rays = aim(point);
        const FloatMask reaches = reaches_sphere(rays, margin);
        const Neighbours found = look_at_rows(rays, reaches);
        const LoadedEntries<Grid> entries(grid_, entries_, found.first, found.known);
        store(contacts_of(point, rays, found, entries, margin), contacts);
        return hn::AndNot(found.known, reaches);
    }

    /// Answers any vector of particles.
    HWY_INLINE void contains_any(const Vec3f* points, std::uint8_t* inside) const {
        const Rays<Grid> rays = aim(load(points));
        const Neighbours found = look_at(rays, hn::Le(rays.length, splat(map_.radius)));
        store(is_inside_at(rays, found, gathered(found)), inside);
    }

    HWY_INLINE void contacts_any(const Vec3f* points, float margin, Contact* contacts) const {
        const PointLanes point = load(points);
        const Rays<Grid> rays = aim(point);
        const Neighbours found = look_at(rays, reaches_sphere(rays, margin));
        store(contacts_of(point, rays, found, gathered(found), margin), contacts);
    }

  private:
    /// The samples around the rays.
    struct Neighbours {
        Samples<Grid> samples;
        std::array<IntLanes, 4> first; ///< where the entries of each sample begin
        FloatMask known;               ///< the lanes for which all of this is known
    };

    static HWY_INLINE PointLanes load(const Vec3f* points) {
        FloatLanes x, y, z;
        hn::LoadInterleaved3(kFloat, &points->x, x, y, z);
        return {x, y, z};
    }

    static HWY_INLINE void store(FloatMask inside, std::uint8_t* bytes) {
        const IntLanes ones = hn::IfThenElseZero(as_int_mask(inside), splat_int(1));
        const hn::Rebind<std::uint8_t, Ints> narrow;
        hn::StoreU(hn::DemoteTo(narrow, ones), narrow, bytes);
    }

    HWY_INLINE Rays<Grid> aim(const PointLanes& point) const {
        const PointLanes d = grid_.to_grid(point - splat(map_.centre));
        const FloatLanes d_length = length(d);
        const FloatMask is_short = hn::Lt(d_length, splat(kShortRay));
        const PointLanes along = d * choose(is_short, splat(kRayLengthening), splat(1));
        return {along, d_length, grid_.coordinates_of(along)};
    }

    HWY_INLINE FloatMask reaches_sphere(const Rays<Grid>& rays, float margin) const {
        return hn::And(hn::Le(rays.length, splat(map_.radius + margin)),
                       hn::Lt(rays.length, splat(std::numeric_limits<float>::infinity())));
    }

    HWY_INLINE FloatMask is_inside(IntLanes interval) const {
        return hn::Xor(is_odd(interval), centre_inside_);
    }

    HWY_INLINE GatheredEntries<Grid> gathered(const Neighbours& found) const {
        return {grid_, entries_, found.first, found.samples.entry_count};
    }

    /// Loads the samples around the rays, if rows of offsets and of entries contain everything that is
    /// needed.
    HWY_INLINE Neighbours look_at_rows(const Rays<Grid>& rays, FloatMask reaches) const {
        const typename Grid::Cell cell = grid_.cell_at(rays.at, reaches);
        const typename Grid::CornerRows rows = grid_.corner_rows(cell);
        // A row of offsets contains the beginnings of two directions, the end of the second, and one more
        // number.
        const IntMask offsets_end = hn::Gt(rows.upper, splat_int(direction_count_ - 3));
        const FloatMask has_rows = hn::And(reaches, hn::AndNot(as_mask(offsets_end), rows.exist));
        const OffsetRows offsets{map_.entry_offsets.data()};
        const Rows lower = load_rows_at(offsets, hn::IfThenElseZero(as_int_mask(has_rows), rows.lower));
        const Rows upper = load_rows_at(offsets, hn::IfThenElseZero(as_int_mask(has_rows), rows.upper));
        const auto as_ints = [](FloatLanes bits) HWY_ATTR { return hn::BitCast(kInt, bits); };
        std::array<IntLanes, 4> first{as_ints(lower.at[0]), as_ints(lower.at[1]), as_ints(upper.at[0]),
                                      as_ints(upper.at[1])};
        std::array<IntLanes, 4> count{hn::Sub(first[1], first[0]), hn::Sub(as_ints(lower.at[2]), first[1]),
                                      hn::Sub(first[3], first[2]), hn::Sub(as_ints(upper.at[2]), first[3])};
        Neighbours found =
            neighbours(cell, grid_.corners_of_cell(cell, first), grid_.corners_of_cell(cell, count));
        const IntLanes last =
            hn::Max(hn::Max(found.first[0], found.first[1]), hn::Max(found.first[2], found.first[3]));
        const IntMask entries_end = hn::Or(hn::Gt(last, splat_int(entry_count_ - 4)),
                                           hn::Gt(found.samples.entry_count, splat_int(4)));
        found.known = hn::AndNot(as_mask(entries_end), has_rows);
        return found;
    }

    /// Loads the samples around any rays.
    HWY_INLINE Neighbours look_at(const Rays<Grid>& rays, FloatMask reaches) const {
        const typename Grid::Cell cell = grid_.cell_at(rays.at, reaches);
        const std::array<IntLanes, 4> corners = grid_.corners(cell);
        const auto* offsets = reinterpret_cast<const std::int32_t*>(map_.entry_offsets.data());
        const auto first = at_corners(
            [&](std::size_t corner) HWY_ATTR { return hn::GatherIndex(kInt, offsets, corners[corner]); });
        const auto count = at_corners([&](std::size_t corner) HWY_ATTR {
            return hn::Sub(hn::GatherIndex(kInt, offsets + 1, corners[corner]), first[corner]);
        });
        Neighbours found = neighbours(cell, first, count);
        found.known = reaches;
        return found;
    }

    /// interpolation_at() of interpolation.hpp.
    HWY_INLINE Neighbours neighbours(const typename Grid::Cell& cell, const std::array<IntLanes, 4>& first,
                                     const std::array<IntLanes, 4>& count) const {
        const auto weights = grid_.weights(cell);
        const IntLanes entry_count = grid_.of_reference(cell, count);
        const IntLanes first_of_reference = grid_.of_reference(cell, first);
        const auto usable = at_corners([&](std::size_t corner)
                                           HWY_ATTR { return as_mask(hn::Eq(count[corner], entry_count)); });
        const FloatMask all = hn::And(hn::And(usable[0], usable[1]), hn::And(usable[2], usable[3]));
        const auto of_usable = at_corners(
            [&](std::size_t corner) HWY_ATTR { return hn::IfThenElseZero(usable[corner], weights[corner]); });
        FloatLanes weight_sum = hn::Zero(kFloat);
        for (const FloatLanes& weight : of_usable) weight_sum = hn::Add(weight_sum, weight);
        const auto weight = at_corners([&](std::size_t corner) HWY_ATTR {
            return choose(all, of_usable[corner], hn::Div(of_usable[corner], weight_sum));
        });
        const auto found_first = at_corners([&](std::size_t corner) HWY_ATTR {
            return choose(usable[corner], first[corner], first_of_reference);
        });
        return {{cell, weight, usable, weight_sum, entry_count}, found_first, all};
    }

    /// interval_of() of query.cpp.
    template <typename EntriesAt>
    HWY_INLINE Intervals intervals_of(const Rays<Grid>& rays, const Neighbours& found,
                                      const EntriesAt& entries_at) const {
        const Samples<Grid>& samples = found.samples;
        Intervals intervals{hn::Zero(kInt), hn::Zero(kFloat), splat(map_.radius)};
        FloatMask looking = hn::And(found.known, as_mask(hn::Gt(samples.entry_count, hn::Zero(kInt))));
        for (std::int32_t k = 0; k < EntriesAt::kMaxEntries && !hn::AllFalse(kFloat, looking); ++k) {
            const FloatLanes distance = grid_.distance_of(interpolated(samples, entries_at(k)), rays.at);
            const FloatMask beyond = hn::AndNot(hn::Gt(distance, rays.length), looking);
            intervals.above = choose(hn::AndNot(beyond, looking), distance, intervals.above);
            intervals.below = choose(beyond, distance, intervals.below);
            intervals.number = choose(beyond, splat_int(k + 1), intervals.number);
            looking = hn::And(beyond, as_mask(hn::Gt(samples.entry_count, splat_int(k + 1))));
        }
        return intervals;
    }

    template <typename EntriesAt>
    HWY_INLINE FloatMask is_inside_at(const Rays<Grid>& rays, const Neighbours& found,
                                      const EntriesAt& entries_at) const {
        return hn::And(found.known, is_inside(intervals_of(rays, found, entries_at).number));
    }

    /// interpolated() of interpolation.hpp.
    HWY_INLINE FloatLanes interpolated(const Samples<Grid>& samples,
                                       const std::array<FloatLanes, 4>& entries) const {
        FloatLanes sum = hn::Zero(kFloat);
        for (std::size_t corner = 0; corner < 4; ++corner)
            sum = hn::Add(sum, hn::Mul(samples.weight[corner], entries[corner]));
        return sum;
    }

    /// nearest_end() of query.cpp.
    HWY_INLINE Ends nearest_ends(const Samples<Grid>& samples, const Intervals& intervals,
                                 FloatLanes d_length) const {
        const FloatMask has_below = as_mask(hn::Gt(intervals.number, hn::Zero(kInt)));
        const FloatMask has_above =
            hn::Or(as_mask(hn::Lt(intervals.number, samples.entry_count)), is_inside(intervals.number));
        const FloatMask below_is_nearer =
            hn::Lt(hn::Sub(d_length, intervals.below), hn::Sub(intervals.above, d_length));
        const FloatMask below = hn::And(has_below, hn::Or(none_of(has_above), below_is_nearer));
        return {hn::Or(has_below, has_above),
                choose(below, hn::Sub(intervals.number, splat_int(1)), intervals.number),
                choose(below, intervals.below, intervals.above)};
    }

    /// direction_of() of query.cpp.
    static HWY_INLINE PointLanes direction_of(const PointLanes& along) {
        const FloatLanes l = length(along);
        const PointLanes z{hn::Zero(kFloat), hn::Zero(kFloat), splat(1)};
        return choose(hn::Gt(l, hn::Zero(kFloat)), along * hn::Div(splat(1), l), z);
    }

    /// surface_normal() of query.cpp.
    HWY_INLINE PointLanes surface_normals(const Samples<Grid>& samples,
                                          const std::array<FloatLanes, 4>& entries, const PointLanes& e_r,
                                          const Ends& ends) const {
        const typename Grid::Derivatives derivative = grid_.weight_derivatives(samples.cell);
        const FloatLanes value = interpolated(samples, entries);
        FloatLanes slope_u = hn::Zero(kFloat);
        FloatLanes slope_v = hn::Zero(kFloat);
        for (std::size_t corner = 0; corner < 4; ++corner) {
            const FloatLanes excess =
                hn::IfThenElseZero(samples.usable[corner], hn::Sub(entries[corner], value));
            slope_u = hn::Add(slope_u, hn::Mul(derivative.along_u[corner], excess));
            slope_v = hn::Add(slope_v, hn::Mul(derivative.along_v[corner], excess));
        }
        const PointLanes gradient = grid_.surface_gradient(e_r, samples.cell, ends.distance, value,
                                                           hn::Div(slope_u, samples.weight_sum),
                                                           hn::Div(slope_v, samples.weight_sum));
        const FloatLanes steepness = length(gradient);
        const FloatMask finite = hn::Lt(steepness, splat(std::numeric_limits<float>::infinity()));
        const PointLanes unit = choose(finite, gradient * hn::Div(splat(1), steepness), e_r);
        const FloatMask on_sphere = as_mask(hn::Eq(ends.k, samples.entry_count));
        const FloatMask inward = hn::AndNot(on_sphere, none_of(is_inside(ends.k)));
        return grid_.from_grid(choose(inward, -unit, choose(on_sphere, e_r, unit)));
    }

    /// contact() of query.cpp for lanes whose samples are known; no contact for the others.
    template <typename EntriesAt>
    HWY_INLINE Contacts contacts_of(const PointLanes& point, const Rays<Grid>& rays,
                                    const Neighbours& neighbours, const EntriesAt& entries_at,
                                    float margin) const {
        const Samples<Grid>& samples = neighbours.samples;
        const Intervals intervals = intervals_of(rays, neighbours, entries_at);
        const FloatLanes zero = hn::Zero(kFloat);
        const Ends ends = nearest_ends(samples, intervals, rays.length);
        const FloatMask inside =
            hn::And(hn::Le(rays.length, splat(map_.radius)), is_inside(intervals.number));
        const FloatLanes distance = hn::Abs(hn::Sub(ends.distance, rays.length));
        const FloatMask near = hn::Or(inside, hn::Le(distance, splat(margin)));
        const FloatMask found = hn::And(hn::And(neighbours.known, ends.exist), near);
        if (hn::AllFalse(kFloat, found)) return {point, {zero, zero, zero}, zero, found};

        const PointLanes e_r = direction_of(rays.along);
        const PointLanes normal = surface_normals(samples, entries_at(ends.k), e_r, ends);
        const PointLanes offset = grid_.from_grid(e_r) * ends.distance;
        const PointLanes end_point = splat(map_.centre) + offset;
        return {choose(found, end_point, point), choose(found, normal, {zero, zero, zero}),
                hn::IfThenElseZero(found, choose(inside, distance, hn::Neg(distance))),
                hn::And(found, inside)};
    }

    static HWY_INLINE void store(const Contacts& from, Contact* contacts) {
        static_assert(sizeof(Contact) == 36 && offsetof(Contact, normal) == 12 &&
                      offsetof(Contact, depth) == 24 && offsetof(Contact, face) == 28 &&
                      offsetof(Contact, inside) == 32 && offsetof(Contact, certain) == 33 &&
                      offsetof(Contact, feature) == 34);
        const FloatLanes no_face = hn::BitCast(kFloat, splat_int(static_cast<std::int32_t>(kNoIndex)));
        HWY_ALIGN float head[4 * kLanes];
        HWY_ALIGN float body[4 * kLanes];
        hn::StoreInterleaved4(from.point.x, from.point.y, from.point.z, from.normal.x, kFloat, head);
        hn::StoreInterleaved4(from.normal.y, from.normal.z, from.depth, no_face, kFloat, body);
        // The three flags are bytes, the first in the lowest byte of a word; the bytes after them are
        // padding.
        HWY_ALIGN std::int32_t flags[kLanes];
        constexpr std::int32_t kCertain = 0x100;
        hn::Store(hn::Add(splat_int(kCertain), hn::IfThenElseZero(as_int_mask(from.inside), splat_int(1))),
                  kInt, flags);
        auto* bytes = reinterpret_cast<std::byte*>(contacts);
        for (std::size_t lane = 0; lane < kLanes; ++lane, bytes += sizeof(Contact)) {
            std::memcpy(bytes, head + 4 * lane, 16);
            std::memcpy(bytes + 16, body + 4 * lane, 16);
            std::memcpy(bytes + 32, flags + lane, 4);
        }
    }

    const DistanceMapView& map_;
    Grid grid_;
    EntryLanes entries_;
    std::int32_t direction_count_, entry_count_;
    FloatMask centre_inside_;
};

} // namespace
} // namespace HWY_NAMESPACE
} // namespace echinus
HWY_AFTER_NAMESPACE();
#endif

#endif
