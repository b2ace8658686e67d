// The queries of query.cpp on vectors of particles. All eight samples of every particle are gathered, without
// a branch. Gathers of two neighbouring floats at once were tried, and loads one by one; both took longer.
// Two neighbours of 16 bits are one word and one gather.

#include "rivals/dense_grid/field.hpp"

#include <algorithm>
#include <array>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rivals/dense_grid/query_kernels.cpp"
#include <hwy/foreach_target.h>

// After foreach_target.h, which includes this file once for each instruction set.
#include "simd/dispatch.hpp"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace echinus::rivals {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr hn::ScalableTag<float> kFloat;
constexpr hn::RebindToSigned<decltype(kFloat)> kInt;
using Floats = hn::Vec<decltype(kFloat)>;
using Ints = hn::Vec<decltype(kInt)>;
using Mask = hn::Mask<decltype(kFloat)>;

constexpr std::size_t kLanes = hn::MaxLanes(kFloat);

struct Vectors {
    Floats x, y, z;
};

HWY_INLINE Floats splat(float value) {
    return hn::Set(kFloat, value);
}

HWY_INLINE Floats mix(Floats a, Floats b, Floats t) {
    return hn::Add(a, hn::Mul(hn::Sub(b, a), t));
}

HWY_INLINE Vectors load(const Vec3f* points) {
#if HWY_TARGET == HWY_SCALAR
    return {splat(points->x), splat(points->y), splat(points->z)};
#else
    Floats x, y, z;
    hn::LoadInterleaved3(kFloat, &points->x, x, y, z);
    return {x, y, z};
#endif
}

/// Two neighbouring samples along x.
struct Pair {
    Floats low, high;
};

class FloatSamples {
  public:
    explicit FloatSamples(const SampledField& field) : samples_(field.float32.data()) {}
    HWY_INLINE Pair operator()(Ints first, std::int32_t offset) const {
        return {hn::GatherIndex(kFloat, samples_ + offset, first),
                hn::GatherIndex(kFloat, samples_ + offset + 1, first)};
    }

  private:
    const float* samples_;
};

class Snorm16Samples {
  public:
    explicit Snorm16Samples(const SampledField& field) : samples_(field.snorm16.data()) {}
    HWY_INLINE Pair operator()(Ints first, std::int32_t offset) const {
        const auto* words = reinterpret_cast<const std::int32_t*>(samples_ + offset);
        const Ints both = hn::GatherOffset(kInt, words, hn::Add(first, first));
        return {hn::ConvertTo(kFloat, hn::ShiftRight<16>(hn::ShiftLeft<16>(both))),
                hn::ConvertTo(kFloat, hn::ShiftRight<16>(both))};
    }

  private:
    const std::int16_t* samples_;
};

/// The samples around a vector of particles, and where between them these are.
struct Corners {
    Pair at00, at10, at01, at11; ///< by y and z
    Floats x, y, z;              ///< in the cell, 0 to 1
    Mask in_box;
};

template <typename Samples>
class Kernel {
  public:
    explicit Kernel(const SampledField& field)
        : low_(field.low), high_(field.high), last_(field.last(0), field.last(1), field.last(2)),
          nodes_per_unit_(field.nodes_per_unit), step_(field.step), slope_scale_(field.slope_scale()),
          row_(field.row()), slice_(field.slice()), samples_(field) {}

    HWY_INLINE void contains(const Vec3f* points, float* distances) const {
        const Corners c = corners_of(load(points));
        const Floats s00 = mix(c.at00.low, c.at00.high, c.x), s10 = mix(c.at10.low, c.at10.high, c.x);
        const Floats s01 = mix(c.at01.low, c.at01.high, c.x), s11 = mix(c.at11.low, c.at11.high, c.x);
        store(distance(c, mix(s00, s10, c.y), mix(s01, s11, c.y)), distances);
    }

    HWY_INLINE void contacts(const Vec3f* points, float* depth, float* normal_x, float* normal_y,
                             float* normal_z) const {
        const Corners c = corners_of(load(points));
        const Floats s00 = mix(c.at00.low, c.at00.high, c.x), s10 = mix(c.at10.low, c.at10.high, c.x);
        const Floats s01 = mix(c.at01.low, c.at01.high, c.x), s11 = mix(c.at11.low, c.at11.high, c.x);
        const Floats low_z = mix(s00, s10, c.y), high_z = mix(s01, s11, c.y);
        const Floats scale = hn::IfThenElseZero(c.in_box, splat(slope_scale_));
        const Floats x = hn::Mul(
            mix(mix(rise(c.at00), rise(c.at10), c.y), mix(rise(c.at01), rise(c.at11), c.y), c.z), scale);
        const Floats y = hn::Mul(mix(hn::Sub(s10, s00), hn::Sub(s11, s01), c.z), scale);
        const Floats z = hn::Mul(hn::Sub(high_z, low_z), scale);
        const Floats length_sq = hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z));
        const Floats to_unit = hn::Div(splat(1), hn::Sqrt(hn::Max(length_sq, splat(kMinGradientSq))));
        store(hn::Neg(distance(c, low_z, high_z)), depth);
        store(hn::Mul(x, to_unit), normal_x);
        store(hn::Mul(y, to_unit), normal_y);
        store(hn::Mul(z, to_unit), normal_z);
    }

  private:
    static HWY_INLINE void store(Floats values, float* to) { hn::StoreU(values, kFloat, to); }
    static HWY_INLINE Floats rise(const Pair& pair) { return hn::Sub(pair.high, pair.low); }

    HWY_INLINE Floats distance(const Corners& c, Floats low_z, Floats high_z) const {
        return hn::IfThenElseZero(c.in_box, hn::Mul(mix(low_z, high_z, c.z), splat(step_)));
    }

    static HWY_INLINE Mask is_between(Floats v, float low, float high) {
        return hn::And(hn::Ge(v, splat(low)), hn::Le(v, splat(high)));
    }

    HWY_INLINE Corners corners_of(const Vectors& p) const {
        const Mask in_box =
            hn::And(hn::And(is_between(p.x, low_.x, high_.x), is_between(p.y, low_.y, high_.y)),
                    is_between(p.z, low_.z, high_.z));
        const NodeBelow i = node_below(in_box, p.x, low_.x, last_.x);
        const NodeBelow j = node_below(in_box, p.y, low_.y, last_.y);
        const NodeBelow k = node_below(in_box, p.z, low_.z, last_.z);
        const Ints row = hn::Mul(j.number, hn::Set(kInt, row_)),
                   slice = hn::Mul(k.number, hn::Set(kInt, slice_));
        const Ints first = hn::Add(hn::Add(slice, row), i.number);
        return {samples_(first, 0),
                samples_(first, row_),
                samples_(first, slice_),
                samples_(first, slice_ + row_),
                i.in_cell,
                j.in_cell,
                k.in_cell,
                in_box};
    }

    /// Along one axis.
    struct NodeBelow {
        Ints number;
        Floats in_cell; ///< from it on, 0 to 1
    };

    /// Beyond the box: the first node, whose samples exist.
    HWY_INLINE NodeBelow node_below(Mask in_box, Floats p, float low, float last) const {
        const Floats from_low = hn::Mul(hn::Sub(p, splat(low)), splat(nodes_per_unit_));
        const Floats coordinate = hn::IfThenElseZero(in_box, hn::Min(from_low, splat(last)));
        const Ints number = hn::ConvertTo(kInt, hn::Min(coordinate, splat(last - 1)));
        return {number, hn::Sub(coordinate, hn::ConvertTo(kFloat, number))};
    }

    // Copies, since for all the compiler knows an answer may be written where the field lies.
    Vec3f low_, high_, last_;
    float nodes_per_unit_, step_, slope_scale_;
    std::int32_t row_, slice_;
    Samples samples_;
};

/// Calls answer(points, first, count) for vectors of particles; the last is filled up with its own last.
template <typename Answer>
HWY_INLINE void for_each_vector(std::span<const Vec3f> points, const Answer& answer) {
    std::size_t i = 0;
    for (; i + kLanes <= points.size(); i += kLanes) answer(points.data() + i, i, kLanes);
    if (i == points.size()) return;
    Vec3f some[kLanes];
    for (std::size_t lane = 0; lane < kLanes; ++lane)
        some[lane] = points[std::min(i + lane, points.size() - 1)];
    answer(some, i, points.size() - i);
}

template <typename Samples>
void contains_with(const SampledField& field, std::span<const Vec3f> points, std::uint8_t* inside) {
    const Kernel<Samples> kernel(field);
    for_each_vector(points, [&](const Vec3f* some, std::size_t first, std::size_t count) HWY_ATTR {
        HWY_ALIGN float distances[kLanes];
        kernel.contains(some, distances);
        for (std::size_t lane = 0; lane < count; ++lane) inside[first + lane] = distances[lane] < 0;
    });
}

template <typename Samples>
void contacts_with(const SampledField& field, std::span<const Vec3f> points, const DenseGrid::Contacts& to) {
    const Kernel<Samples> kernel(field);
    for_each_vector(points, [&](const Vec3f* some, std::size_t first, std::size_t count) HWY_ATTR {
        if (count == kLanes)
            return kernel.contacts(some, &to.depths[first], &to.normals_x[first], &to.normals_y[first],
                                   &to.normals_z[first]);
        HWY_ALIGN float answers[4][kLanes];
        kernel.contacts(some, answers[0], answers[1], answers[2], answers[3]);
        for (std::size_t lane = 0; lane < count; ++lane) {
            to.depths[first + lane] = answers[0][lane];
            to.normals_x[first + lane] = answers[1][lane];
            to.normals_y[first + lane] = answers[2][lane];
            to.normals_z[first + lane] = answers[3][lane];
        }
    });
}

} // namespace

void contains_lanes(const SampledField& field, std::span<const Vec3f> points, std::uint8_t* inside) {
    if (field.format == SampleFormat::Float32)
        contains_with<FloatSamples>(field, points, inside);
    else
        contains_with<Snorm16Samples>(field, points, inside);
}

void contacts_lanes(const SampledField& field, std::span<const Vec3f> points,
                    const DenseGrid::Contacts& contacts) {
    if (field.format == SampleFormat::Float32)
        contacts_with<FloatSamples>(field, points, contacts);
    else
        contacts_with<Snorm16Samples>(field, points, contacts);
}

} // namespace HWY_NAMESPACE
} // namespace echinus::rivals
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace echinus::rivals {

namespace {

HWY_EXPORT(contains_lanes);
HWY_EXPORT(contacts_lanes);

} // namespace

void contains_kernel(const SampledField& field, std::span<const Vec3f> points,
                     std::span<std::uint8_t> inside) {
    ECHINUS_DISPATCH(contains_lanes)(field, points, inside.data());
}

void contacts_kernel(const SampledField& field, std::span<const Vec3f> points,
                     const DenseGrid::Contacts& contacts) {
    ECHINUS_DISPATCH(contacts_lanes)(field, points, contacts);
}

} // namespace echinus::rivals
#endif
