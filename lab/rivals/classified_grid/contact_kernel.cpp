// contacts_batch() in vector instructions. Signs first; then those that need a nearest point are sorted along
// a space-filling curve, and neighbours become the lanes of a group. By the triangle inequality only faces
// that are at most the group's diameter farther from its middle than the nearest face can be nearest to one
// of its particles. So a list of all faces within a distance of some place is kept as long as it provably
// holds these; for each group first faces are lanes (distances from the middle), then particles are, for the
// few faces that are left.

#include "rivals/classified_grid/layout.hpp"
#include "rivals/classified_grid/query.hpp"

#include <hwy/cache_control.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rivals/classified_grid/contact_kernel.cpp"
#include <hwy/foreach_target.h>

// After foreach_target.h, which includes this file once for each instruction set.
#include "rivals/classified_grid/lookup-inl.hpp"
#include "simd/dispatch.hpp"

#ifndef ECHINUS_CLASSIFIED_GRID_CONTACT_KERNEL_ONCE
#define ECHINUS_CLASSIFIED_GRID_CONTACT_KERNEL_ONCE
namespace echinus::rivals {

/// A particle that needs a nearest point.
struct Seeker {
    std::uint32_t key;    ///< along the curve
    std::uint32_t number; ///< << 1 | inside
    Vec3f point;          ///< carried along: neighbours in space lie anywhere in memory
};

/// The numbers that a group stores for each face, in lattice steps from the list's middle. A face's plane has
/// the unit normal n; edge k starts at v, runs along t for a length, and m = n x t leads from it to the
/// inside. Then the squared distance of a place in the plane from the edge is (m . q)^2 + w^2, where q is
/// counted from v and w is how far t . q lies beyond the edge's ends.
enum FaceNumber : std::size_t {
    kNormal,    ///< x, y, z, and -n . v
    kEdges = 4, ///< for each edge m and -m . v, t and -t . v, the length
    kNumbersPerEdge = 9,
    kFaceNumbers = kEdges + 3 * kNumbersPerEdge,
};

/// All faces within `reach` of a middle.
struct FaceList {
    static constexpr std::size_t kMaxLanes = 16;

    Vec3<std::int32_t> middle;
    double reach = -1; ///< less than any distance: no list yet
    std::size_t count = 0, capacity = 0;
    std::vector<std::uint32_t> faces;  ///< [face_count + kMaxLanes], the first `count` are in the list
    std::vector<float> numbers;        ///< [kFaceNumbers][capacity]
    std::vector<float> distances;      ///< [capacity] from the middle of a group
    std::vector<std::uint32_t> chosen; ///< [capacity] which of the list a group needs

    void reserve(std::size_t size) {
        if (size + kMaxLanes <= capacity) return;
        capacity = (size + size / 2 + 2 * kMaxLanes) / kMaxLanes * kMaxLanes;
        numbers.assign(kFaceNumbers * capacity, 0);
        distances.assign(capacity, 0);
        chosen.assign(capacity, 0);
    }
};

struct ContactScratch {
    std::vector<std::uint8_t> inside;
    std::vector<Seeker> seekers, sorted;
    std::vector<std::uint32_t> stamps; ///< [face_count] of the last list that took a face
    std::uint32_t stamp = 0;
    FaceList list;
};

} // namespace echinus::rivals
#endif

HWY_BEFORE_NAMESPACE();
namespace echinus::rivals::HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR

void find_contacts(const GridArrays&, ContactScratch&, float, std::span<Contact>) {}

#else

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kLanes = 16; ///< at most

/// In lattice steps: the diameter of the lattice and more.
constexpr double kEverything = 4 * static_cast<double>(kLatticeExtent);

/// An upper bound of the rounding error of float, in lattice steps.
constexpr float kRounding = 2;

class ContactKernel {
  public:
    ContactKernel(const GridArrays& grid, ContactScratch& scratch, float margin, std::span<Contact> contacts)
        : grid_(grid), frame_(grid.frame), s_(scratch), list_(scratch.list), contacts_(contacts),
          margin_(margin > 0 ? double{margin} * grid.frame.lattice.inverse_step : 0) {}

    HWY_ATTR void run() {
        const std::size_t n = hn::Lanes(Floats());
        for (std::size_t i = 0; i < s_.sorted.size();) {
            fetch(i + kAhead, n);
            const std::size_t size = load_group(i, std::min(n, s_.sorted.size() - i));
            answer_group(i, size);
            i += size;
        }
    }

  private:
    /// Places of some particles, from the list's middle; lanes beyond repeat the first.
    struct Group {
        alignas(64) double x[kLanes], y[kLanes], z[kLanes]; ///< in lattice steps
        alignas(64) float inside[kLanes];                   ///< 0 or 1
        Vec3<std::int32_t> middle;
        double radius;
        bool any_inside;
    };

    /// Where answers go to is asked for some time before.
    static constexpr std::size_t kAhead = 4 * kLanes;
    HWY_ATTR void fetch(std::size_t first, std::size_t size) const {
        for (std::size_t i = first; i < std::min(first + size, s_.sorted.size()); ++i) {
            const Contact* contact = &contacts_[s_.sorted[i].number >> 1];
            hwy::Prefetch(contact);
            hwy::Prefetch(reinterpret_cast<const char*>(contact) + sizeof(Contact) - 1);
        }
    }

    HWY_ATTR std::size_t load_group(std::size_t first, std::size_t size) {
        Vec3d low, high;
        group_.any_inside = false;
        for (std::size_t i = 0; i < size; ++i) {
            const Seeker& seeker = s_.sorted[first + i];
            const Vec3d p = frame_.lattice.to_lattice(seeker.point);
            const bool inside = seeker.number & 1;
            group_.inside[i] = inside ? 1 : 0;
            group_.any_inside |= inside;
            if (i == 0) low = high = p;
            low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
            group_.x[i] = p.x;
            group_.y[i] = p.y;
            group_.z[i] = p.z;
        }
        for (std::size_t i = size; i < kLanes; ++i) {
            group_.x[i] = group_.x[0];
            group_.y[i] = group_.y[0];
            group_.z[i] = group_.z[0];
            group_.inside[i] = group_.inside[0];
        }
        group_.middle = Vec3<std::int32_t>(rounded((low + high) * 0.5));
        group_.radius = length(high - low) * 0.5 + 1; // the middle is rounded
        return size;
    }

    HWY_ATTR void answer_group(std::size_t first, std::size_t size) {
        if (!make_list_cover()) return; // nothing within the margin
        choose();
        const Floats df;
        const Ints di;
        const FloatVectors p = places();
        auto best_sq = hn::Set(df, std::numeric_limits<float>::max());
        auto best = hn::Zero(di);
        for (std::size_t c = 0; c < chosen_count_; ++c) {
            const std::uint32_t face = list_.chosen[c];
            const auto distance_sq = distance_sq_of(p, face);
            const auto nearer = hn::Lt(distance_sq, best_sq);
            best_sq = hn::IfThenElse(nearer, distance_sq, best_sq);
            best = hn::IfThenElse(hn::RebindMask(di, nearer), hn::Set(di, static_cast<std::int32_t>(face)),
                                  best);
        }
        write(first, size, p, best);
    }

    /// Of the group, from the list's middle.
    HWY_ATTR HWY_INLINE FloatVectors places() const {
        return {from_middle(group_.x, list_.middle.x), from_middle(group_.y, list_.middle.y),
                from_middle(group_.z, list_.middle.z)};
    }

    HWY_ATTR HWY_INLINE hn::VFromD<Floats> from_middle(const double* places, std::int32_t middle) const {
        const Floats df;
        const hn::Half<Floats> df_half;
        const hn::Rebind<double, hn::Half<Floats>> dd;
        const auto m = hn::Set(dd, middle);
        const auto low = hn::DemoteTo(df_half, hn::Sub(hn::Load(dd, places), m));
        const auto high = hn::DemoteTo(df_half, hn::Sub(hn::Load(dd, places + hn::Lanes(dd)), m));
        return hn::Combine(df, high, low);
    }

    struct ToEdge {
        hn::VFromD<Floats> inwards, beyond; ///< m . q and w
        hn::VFromD<Floats> along, length;   ///< t . q
    };
    template <class Number>
    HWY_ATTR HWY_INLINE static ToEdge to_edge(const FloatVectors& p, const Number& number, std::size_t edge) {
        const std::size_t k = kEdges + kNumbersPerEdge * edge;
        const auto along = plane(p, number, k + 4);
        const auto length = number(k + 8);
        const auto clamped = hn::Min(hn::Max(along, hn::Zero(Floats())), length);
        return {plane(p, number, k), hn::Sub(along, clamped), along, length};
    }
    template <class Number>
    HWY_ATTR HWY_INLINE static hn::VFromD<Floats> plane(const FloatVectors& p, const Number& number,
                                                        std::size_t k) {
        return hn::MulAdd(number(k), p.x,
                          hn::MulAdd(number(k + 1), p.y, hn::MulAdd(number(k + 2), p.z, number(k + 3))));
    }
    HWY_ATTR HWY_INLINE static hn::VFromD<Floats> in_plane_sq(const ToEdge& edge) {
        return hn::MulAdd(edge.inwards, edge.inwards, hn::Mul(edge.beyond, edge.beyond));
    }
    HWY_ATTR HWY_INLINE static hn::Mask<Floats> is_above(const ToEdge& a, const ToEdge& b, const ToEdge& c) {
        return hn::Gt(hn::Min(hn::Min(a.inwards, b.inwards), c.inwards), hn::Zero(Floats()));
    }

    /// Squared distance of places from faces; number(k) is a FaceNumber of each lane's face.
    template <class Number>
    HWY_ATTR HWY_INLINE static hn::VFromD<Floats> distance_sq_of(const FloatVectors& p,
                                                                 const Number& number) {
        const auto height = plane(p, number, kNormal);
        const ToEdge a = to_edge(p, number, 0), b = to_edge(p, number, 1), c = to_edge(p, number, 2);
        const auto to_edges = hn::Min(hn::Min(in_plane_sq(a), in_plane_sq(b)), in_plane_sq(c));
        return hn::MulAdd(height, height, hn::IfThenZeroElse(is_above(a, b, c), to_edges));
    }

    HWY_ATTR HWY_INLINE hn::VFromD<Floats> distance_sq_of(const FloatVectors& p, std::uint32_t face) const {
        const float* numbers = &list_.numbers[face];
        return distance_sq_of(p, [&](std::size_t k)
                                     HWY_ATTR { return hn::Set(Floats(), numbers[k * list_.capacity]); });
    }

    // ---- The list

    /// Sees to it that the list holds every face that can be nearest to a particle of the group, and finds
    /// how far from the group's middle these may be. False when no face is within the margin of any particle.
    HWY_ATTR bool make_list_cover() {
        measure_from_group();
        needed_ = needed();
        const Vec3d offset = Vec3d(group_.middle) - Vec3d(list_.middle);
        if (length(offset) + needed_ > list_.reach || is_excessive()) {
            renew_list();
            measure_from_group();
            needed_ = needed();
        }
        return list_.count != 0 && nearest_ <= needed_;
    }

    /// A particle's nearest face is no farther from the middle than the particle itself and as far again as
    /// it is from any one face, or from the margin if it is outside: here from the face that is nearest to
    /// the middle.
    HWY_ATTR double needed() const {
        const Floats df;
        const auto margin = hn::Set(df, static_cast<float>(std::min(margin_, kEverything)));
        auto reach = hn::Set(df, static_cast<float>(kEverything));
        const FloatVectors p = places();
        if (list_.count != 0) reach = hn::Sqrt(distance_sq_of(p, nearest_face_));
        const auto inside = hn::Ne(hn::Load(df, group_.inside), hn::Zero(df));
        reach = hn::IfThenElse(inside, reach, hn::Min(reach, margin));
        const Vec3f offset(Vec3d(group_.middle) - Vec3d(list_.middle));
        const FloatVectors middle{hn::Set(df, offset.x), hn::Set(df, offset.y), hn::Set(df, offset.z)};
        const FloatVectors from = sub(p, middle);
        reach = hn::Add(reach, hn::Sqrt(dot(from, from)));
        return double{hn::GetLane(hn::MaxOfLanes(df, reach))} + 2 * double{kRounding};
    }

    /// Would a new list be much shorter?
    HWY_ATTR bool is_excessive() const {
        constexpr std::size_t kShort = 128;
        return list_.count > kShort && list_.reach > 4 * (needed_ + frame_.cell_steps);
    }

    /// Distances of the list's faces from the group's middle.
    HWY_ATTR void measure_from_group() {
        const Floats df;
        const Ints di;
        const std::size_t n = hn::Lanes(df);
        nearest_ = std::numeric_limits<double>::infinity();
        if (list_.count == 0) return;
        const Vec3f offset(Vec3d(group_.middle) - Vec3d(list_.middle));
        const FloatVectors p{hn::Set(df, offset.x), hn::Set(df, offset.y), hn::Set(df, offset.z)};
        auto least = hn::Set(df, std::numeric_limits<float>::infinity());
        auto nearest = hn::Zero(di);
        for (std::size_t i = 0; i < list_.count; i += n) { // lanes beyond the end repeat the last face
            const float* numbers = &list_.numbers[i];
            const auto distance = hn::Sqrt(distance_sq_of(
                p, [&](std::size_t k) HWY_ATTR { return hn::LoadU(df, &numbers[k * list_.capacity]); }));
            hn::StoreU(distance, df, &list_.distances[i]);
            const auto nearer = hn::Lt(distance, least);
            least = hn::Min(least, distance);
            nearest = hn::IfThenElse(hn::RebindMask(di, nearer), hn::Iota(di, static_cast<std::int32_t>(i)),
                                     nearest);
        }
        alignas(64) float distances[kLanes];
        alignas(64) std::int32_t faces[kLanes];
        hn::Store(least, df, distances);
        hn::Store(nearest, di, faces);
        const auto lane = static_cast<std::size_t>(std::min_element(distances, distances + n) - distances);
        nearest_ = double{distances[lane]};
        nearest_face_ = static_cast<std::uint32_t>(faces[lane]);
    }

    HWY_ATTR void choose() {
        const Floats df;
        const hn::Rebind<std::uint32_t, Floats> du;
        const std::size_t n = hn::Lanes(df);
        const auto limit = hn::Set(df, static_cast<float>(needed_));
        chosen_count_ = 0;
        for (std::size_t i = 0; i < list_.count; i += n) {
            auto near = hn::Le(hn::LoadU(df, &list_.distances[i]), limit);
            near = hn::And(near, hn::FirstN(df, list_.count - i));
            chosen_count_ += hn::CompressStore(hn::Iota(du, static_cast<std::uint32_t>(i)),
                                               hn::RebindMask(du, near), du, &list_.chosen[chosen_count_]);
        }
    }

    /// All faces within reach of the group, and some more for the groups to come.
    HWY_ATTR void renew_list() {
        const double cell = frame_.cell_steps;
        const Vec3d middle(group_.middle);
        // From where the last list was made the nearest face may be far off.
        constexpr double kFarCells = 2;
        double reach = needed_;
        if (!(nearest_ < kFarCells * cell)) {
            const double limit =
                group_.any_inside ? kEverything : margin_ + group_.radius + double{kRounding};
            const auto found = nearest_place(grid_, middle, std::min(limit, nearest_ + double{kRounding}));
            const double farthest =
                (found ? found->distance : limit) + 2 * group_.radius + 2 * double{kRounding};
            reach = std::min(reach, farthest);
        }
        constexpr double kSpareCells = 0.75;
        list_.middle = group_.middle;
        list_.reach = reach + kSpareCells * cell;
        collect_faces(middle, list_.reach + double{kRounding});
        prepare_faces();
    }

    HWY_ATTR void collect_faces(const Vec3d& place, double reach) {
        ++s_.stamp;
        list_.count = 0;
        const double size = frame_.cell_steps;
        const Vec3d from_origin = (place - Vec3d(frame_.origin)) * (1 / size); // in cells
        const double cells = reach / size + 0.001;
        const auto range = [&](double at, std::int32_t count) HWY_ATTR {
            const double low = std::floor((at - cells) / Brick::kEdge),
                         high = std::floor((at + cells) / Brick::kEdge);
            return std::array{static_cast<std::int32_t>(std::clamp(low, 0.0, double(count))),
                              static_cast<std::int32_t>(std::clamp(high, -1.0, count - 1.0))};
        };
        const auto xs = range(from_origin.x, frame_.brick_counts[0]);
        const auto ys = range(from_origin.y, frame_.brick_counts[1]);
        const auto zs = range(from_origin.z, frame_.brick_counts[2]);
        const auto limit_sq = static_cast<float>(cells * cells);
        const Vec3f at(from_origin);
        for (std::int32_t z = zs[0]; z <= zs[1]; ++z)
            for (std::int32_t y = ys[0]; y <= ys[1]; ++y) {
                const std::size_t row = frame_.brick_at({0, y, z});
                const float from_row = square(outside(at.y, 4 * y, 4)) + square(outside(at.z, 4 * z, 4));
                if (from_row > limit_sq) continue;
                for (std::int32_t x = xs[0]; x <= xs[1]; ++x) {
                    const std::uint32_t number = grid_.brick_numbers[row + static_cast<std::size_t>(x)];
                    if (number <= GridArrays::kInside) continue;
                    if (from_row + square(outside(at.x, 4 * x, 4)) > limit_sq) continue;
                    collect_from(grid_.bricks[number], {4 * x, 4 * y, 4 * z}, at, limit_sq);
                }
            }
    }

    static float square(float v) { return v * v; }
    /// How far a place is outside of [low, low + size].
    static float outside(float place, std::int32_t low, std::int32_t size) {
        const auto l = static_cast<float>(low), h = static_cast<float>(low + size);
        return std::max(std::max(l - place, place - h), 0.0F);
    }

    HWY_ATTR void collect_from(const Brick& brick, const CellPlace& first, const Vec3f& at, float limit_sq) {
        std::array<float, 4> x_sq, y_sq, z_sq;
        for (std::int32_t i = 0; i < Brick::kEdge; ++i) {
            x_sq[i] = square(outside(at.x, first.x + i, 1));
            y_sq[i] = square(outside(at.y, first.y + i, 1));
            z_sq[i] = square(outside(at.z, first.z + i, 1));
        }
        std::uint32_t list = brick.first_list;
        for (std::size_t z = 0; z < 4; ++z) {
            std::uint32_t bits = brick.states[z] & 0xAAAA'AAAA;
            if (z_sq[z] > limit_sq) {
                list += static_cast<std::uint32_t>(std::popcount(bits));
                continue;
            }
            for (; bits != 0; bits &= bits - 1, ++list) {
                const auto cell = static_cast<std::uint32_t>(std::countr_zero(bits)) >> 1;
                if (x_sq[cell & 3] + y_sq[cell >> 2] + z_sq[z] > limit_sq) continue;
                const std::uint32_t begin = brick.first_reference + grid_.list_begins[list];
                const std::uint32_t end = brick.first_reference + grid_.list_begins[list + 1];
                for (std::uint32_t r = begin; r < end; ++r) take(grid_.references[r]);
            }
        }
    }

    /// Once each; without a branch, which would be mispredicted.
    HWY_ATTR HWY_INLINE void take(std::uint32_t face) {
        list_.faces[list_.count] = face;
        list_.count += s_.stamps[face] != s_.stamp ? 1 : 0;
        s_.stamps[face] = s_.stamp;
    }

    HWY_ATTR void prepare_faces() {
        const Ints di;
        const hn::Half<Floats> df_half;
        const std::size_t n = hn::Lanes(di);
        if (list_.count == 0) return;
        list_.reserve(list_.count);
        std::fill_n(&list_.faces[list_.count], n, list_.faces[list_.count - 1]);
        const FaceGather gather(grid_);
        const IntVectors middle{hn::Set(di, list_.middle.x), hn::Set(di, list_.middle.y),
                                hn::Set(di, list_.middle.z)};
        for (std::size_t i = 0; i < list_.count; i += n) {
            const FaceVectors corners =
                gather([&](std::size_t lane) { return list_.faces[i + lane]; }, middle);
            prepare_half(
                i, [&](hn::VFromD<Floats> v) HWY_ATTR { return hn::LowerHalf(df_half, v); }, corners);
            prepare_half(
                i + n / 2, [&](hn::VFromD<Floats> v) HWY_ATTR { return hn::UpperHalf(df_half, v); }, corners);
        }
    }

    /// The FaceNumbers of half of the lanes, in double: slivers have normals too.
    template <class HalfOf>
    HWY_ATTR void prepare_half(std::size_t first, const HalfOf& half_of, const FaceVectors& corners) {
        const hn::Rebind<double, hn::Half<Floats>> dd;
        using V = Vectors<hn::VFromD<decltype(dd)>>;
        const auto widened = [&](const FloatVectors& v) HWY_ATTR {
            return V{hn::PromoteTo(dd, half_of(v.x)), hn::PromoteTo(dd, half_of(v.y)),
                     hn::PromoteTo(dd, half_of(v.z))};
        };
        const V a = widened(corners.a), b = widened(corners.b), c = widened(corners.c);
        const V edges[3] = {sub(b, a), sub(c, b), sub(a, c)};
        const V starts[3] = {a, b, c};
        const auto one = hn::Set(dd, 1.0);
        const auto zero = hn::Zero(dd);
        // A face without area gets any normal across its longest edge.
        V longest_edge = edges[0];
        auto longest_sq = dot(edges[0], edges[0]);
        for (int k = 1; k < 3; ++k) {
            const auto sq = dot(edges[k], edges[k]);
            const auto longer = hn::Gt(sq, longest_sq);
            longest_edge = chosen(longer, edges[k], longest_edge);
            longest_sq = hn::Max(sq, longest_sq);
        }
        longest_edge.x = hn::IfThenElse(hn::Eq(longest_sq, zero), one, longest_edge.x);
        const auto flat = hn::Lt(hn::Abs(longest_edge.x), hn::Mul(hn::Set(dd, 0.5), longest(longest_edge)));
        const V axis{hn::IfThenElseZero(flat, one), hn::IfThenZeroElse(flat, one), zero};
        const V across = cross(longest_edge, axis);
        V normal = cross(edges[0], edges[1]);
        normal = chosen(hn::Eq(dot(normal, normal), zero), across, normal);
        normal = scaled(normal, hn::Div(one, hn::Sqrt(dot(normal, normal))));
        store_plane(first, kNormal, normal, a);
        for (std::size_t k = 0; k < 3; ++k) {
            const auto length = hn::Sqrt(dot(edges[k], edges[k]));
            const auto is_point = hn::Eq(length, zero);
            // Edges of both directions, so that no place is above a face that is a point.
            V t = chosen(is_point, scaled(longest_edge, hn::Set(dd, k == 2 ? -1.0 : 1.0)), edges[k]);
            t = scaled(t, hn::Div(one, hn::Sqrt(dot(t, t))));
            const std::size_t number = kEdges + kNumbersPerEdge * k;
            store_plane(first, number, cross(normal, t), starts[k]);
            store_plane(first, number + 4, t, starts[k]);
            store(first, number + 8, length);
        }
    }
    template <class M, class V>
    HWY_ATTR HWY_INLINE static V chosen(M mask, const V& a, const V& b) {
        return {hn::IfThenElse(mask, a.x, b.x), hn::IfThenElse(mask, a.y, b.y),
                hn::IfThenElse(mask, a.z, b.z)};
    }
    template <class V>
    HWY_ATTR HWY_INLINE void store_plane(std::size_t first, std::size_t number, const V& n,
                                         const V& through) {
        store(first, number, n.x);
        store(first, number + 1, n.y);
        store(first, number + 2, n.z);
        store(first, number + 3, hn::Neg(dot(n, through)));
    }
    template <class V>
    HWY_ATTR HWY_INLINE void store(std::size_t first, std::size_t number, V v) {
        const hn::Half<Floats> df_half;
        hn::StoreU(hn::DemoteTo(df_half, v), df_half, &list_.numbers[number * list_.capacity + first]);
    }

    // ---- Answers

    HWY_ATTR void write(std::size_t first, std::size_t size, const FloatVectors& p, hn::VFromD<Ints> best) {
        const Floats df;
        const Ints di;
        const auto number = [&](std::size_t k) HWY_ATTR {
            return hn::GatherIndex(df, &list_.numbers[k * list_.capacity], best);
        };
        const auto height = plane(p, number, kNormal);
        const ToEdge edges[3] = {to_edge(p, number, 0), to_edge(p, number, 1), to_edge(p, number, 2)};
        const auto above = is_above(edges[0], edges[1], edges[2]);
        // Back to the plane, and from there to the nearest edge.
        FloatVectors offset =
            scaled({number(kNormal), number(kNormal + 1), number(kNormal + 2)}, hn::Neg(height));
        auto nearest_sq = hn::Set(df, std::numeric_limits<float>::max());
        FloatVectors to_nearest{hn::Zero(df), hn::Zero(df), hn::Zero(df)};
        auto feature = hn::Set(di, static_cast<std::int32_t>(Feature::Edge));
        for (std::size_t k = 0; k < 3; ++k) {
            const auto sq = in_plane_sq(edges[k]);
            const auto nearer = hn::Lt(sq, nearest_sq);
            nearest_sq = hn::Min(sq, nearest_sq);
            const std::size_t m = kEdges + kNumbersPerEdge * k, t = m + 4;
            const auto back = [&](std::size_t axis) HWY_ATTR {
                return hn::Neg(hn::MulAdd(number(m + axis), edges[k].inwards,
                                          hn::Mul(number(t + axis), edges[k].beyond)));
            };
            to_nearest = chosen(nearer, FloatVectors{back(0), back(1), back(2)}, to_nearest);
            const auto between =
                hn::And(hn::Gt(edges[k].along, hn::Zero(df)), hn::Lt(edges[k].along, edges[k].length));
            const auto kind = hn::IfThenElse(hn::RebindMask(di, between),
                                             hn::Set(di, static_cast<std::int32_t>(Feature::Edge)),
                                             hn::Set(di, static_cast<std::int32_t>(Feature::Vertex)));
            feature = hn::IfThenElse(hn::RebindMask(di, nearer), kind, feature);
        }
        const auto add = [&](hn::VFromD<Floats> a, hn::VFromD<Floats> b)
                             HWY_ATTR { return hn::Add(a, hn::IfThenZeroElse(above, b)); };
        offset = {add(offset.x, to_nearest.x), add(offset.y, to_nearest.y), add(offset.z, to_nearest.z)};
        feature = hn::IfThenElse(hn::RebindMask(di, above),
                                 hn::Set(di, static_cast<std::int32_t>(Feature::Face)), feature);
        const auto distance = hn::Sqrt(dot(offset, offset));
        hn::Store(offset.x, df, offset_x_);
        hn::Store(offset.y, df, offset_y_);
        hn::Store(offset.z, df, offset_z_);
        hn::Store(distance, df, distances_);
        hn::Store(best, di, best_);
        hn::Store(feature, di, features_);
        for (std::size_t lane = 0; lane < size; ++lane) write_one(s_.sorted[first + lane], lane);
    }

    HWY_ATTR void write_one(const Seeker& seeker, std::size_t lane) {
        const bool inside = seeker.number & 1;
        if (!inside && double{distances_[lane]} > margin_) return;
        const std::uint32_t face = list_.faces[static_cast<std::size_t>(best_[lane])];
        Contact& contact = contacts_[seeker.number >> 1];
        if (HWY_UNLIKELY(distances_[lane] <= 2 * kRounding)) {
            contact = contact_at(grid_, seeker.point, inside,
                                 nearest_on_face(grid_, face, frame_.lattice.to_lattice(seeker.point)));
            return;
        }
        const Vec3f offset{offset_x_[lane], offset_y_[lane], offset_z_[lane]};
        const auto step = static_cast<float>(frame_.lattice.step);
        const float sign = inside ? 1.0F : -1.0F;
        contact.point = seeker.point + offset * step;
        contact.normal = offset * (sign / distances_[lane]);
        contact.depth = sign * distances_[lane] * step;
        contact.face = face;
        contact.inside = inside;
        contact.feature = static_cast<Feature>(features_[lane]);
    }

    const GridArrays& grid_;
    const GridFrame& frame_;
    ContactScratch& s_;
    FaceList& list_;
    std::span<Contact> contacts_;
    double margin_;      ///< in lattice steps
    double nearest_ = 0; ///< distance of the list's nearest face from the group's middle
    std::uint32_t nearest_face_ = 0;
    double needed_ = 0; ///< see needed()
    std::size_t chosen_count_ = 0;
    Group group_;
    alignas(64) float offset_x_[kLanes], offset_y_[kLanes], offset_z_[kLanes], distances_[kLanes];
    alignas(64) std::int32_t best_[kLanes], features_[kLanes];
};

HWY_ATTR void find_contacts(const GridArrays& grid, ContactScratch& scratch, float margin,
                            std::span<Contact> contacts) {
    ContactKernel(grid, scratch, margin, contacts).run();
}

#endif

} // namespace echinus::rivals::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace echinus::rivals {

HWY_EXPORT(find_contacts);

namespace {

constexpr std::size_t kChunk = std::size_t{1} << 20; // particles that are sorted together

/// Every third bit, from the lowest on.
std::uint32_t spread(std::uint32_t v) {
    v = (v | v << 16) & 0x0300'00FF;
    v = (v | v << 8) & 0x0300'F00F;
    v = (v | v << 4) & 0x030C'30C3;
    return (v | v << 2) & 0x0924'9249;
}

constexpr int kBitsPerAxis = 8;

/// Where along Morton's curve a particle lies, beyond the grid at its border.
class CurveKey {
  public:
    explicit CurveKey(const GridFrame& frame)
        : frame_(frame), scale_((1 << kBitsPerAxis) /
                                std::max({frame.cell_limits.x, frame.cell_limits.y, frame.cell_limits.z})) {}

    std::uint32_t operator()(const Vec3f& point_local) const {
        const Vec3f g = frame_.in_cells(point_local);
        return spread(place(g.x)) | spread(place(g.y)) << 1 | spread(place(g.z)) << 2;
    }

  private:
    std::uint32_t place(float g) const {
        const float v = g * scale_;
        constexpr float kMax = (1 << kBitsPerAxis) - 1;
        return v > 0 ? static_cast<std::uint32_t>(std::min(v, kMax)) : 0;
    }
    const GridFrame& frame_;
    float scale_;
};

/// By key, in two passes that keep the order of equals.
void sort_by_key(std::vector<Seeker>& seekers, std::vector<Seeker>& sorted) {
    constexpr int kBits = 3 * kBitsPerAxis / 2;
    constexpr std::uint32_t kMask = (1U << kBits) - 1;
    sorted.resize(seekers.size());
    std::array<std::array<std::uint32_t, kMask + 2>, 2> begins{};
    for (const Seeker& s : seekers) {
        ++begins[0][(s.key & kMask) + 1];
        ++begins[1][(s.key >> kBits) + 1];
    }
    for (auto& pass : begins)
        for (std::size_t i = 0; i < kMask; ++i) pass[i + 1] += pass[i];
    for (const Seeker& s : seekers) sorted[begins[0][s.key & kMask]++] = s;
    std::swap(seekers, sorted);
    for (const Seeker& s : seekers) sorted[begins[1][s.key >> kBits]++] = s;
}

/// Is a particle at most so many cells beyond the grid? False for NaN.
bool is_near_grid(const GridFrame& frame, const Vec3f& point_local, float cells) {
    const Vec3f g = frame.in_cells(point_local);
    const auto near = [&](float v, float limit) { return v >= -cells && v <= limit + cells; };
    return near(g.x, frame.cell_limits.x) && near(g.y, frame.cell_limits.y) && near(g.z, frame.cell_limits.z);
}

} // namespace

void contacts_kernel(const GridArrays& grid, std::span<const Vec3f> points_local, float margin,
                     std::span<Contact> contacts) {
    ContactScratch scratch;
    scratch.stamps.resize(grid.face_count());
    scratch.list.faces.resize(grid.face_count() + FaceList::kMaxLanes);
    scratch.inside.resize(std::min(kChunk, points_local.size()));
    const float margin_cells = margin > 0 ? margin * grid.frame.cells_per_unit * 1.001F + 1 : 0;
    // Farther away float would round too much.
    const float most_cells =
        4 * static_cast<float>(kLatticeExtent) / static_cast<float>(grid.frame.cell_steps);
    const CurveKey key(grid.frame);
    for (std::size_t first = 0; first < points_local.size(); first += kChunk) {
        const std::size_t count = std::min(kChunk, points_local.size() - first);
        const auto points = points_local.subspan(first, count);
        contains_kernel(grid, points, std::span(scratch.inside).first(count));
        scratch.seekers.clear();
        for (std::size_t i = 0; i < count; ++i) {
            Contact& none = contacts[first + i] = {};
            none.point = points[i];
            if (scratch.inside[i] == 0) {
                if (margin_cells == 0 || !is_near_grid(grid.frame, points[i], margin_cells)) continue;
                if (!is_near_grid(grid.frame, points[i], most_cells)) {
                    none = contact(grid, points[i], false, margin);
                    continue;
                }
            }
            const auto number = static_cast<std::uint32_t>(i << 1);
            scratch.seekers.push_back({key(points[i]), number | scratch.inside[i], points[i]});
        }
        sort_by_key(scratch.seekers, scratch.sorted);
        ECHINUS_DISPATCH(find_contacts)(grid, scratch, margin, contacts.subspan(first, count));
    }
}

} // namespace echinus::rivals
#endif
