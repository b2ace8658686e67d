// Answers batches of particles by the queries of query_lanes-inl.hpp. Particles for which rows do not suffice
// are put on a list, which is then processed with all lanes full.

#include "distance_map/query/grid_kernels.hpp"

#include <algorithm>

#if defined(ECHINUS_DISTANCE_MAP_BATCH_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef ECHINUS_DISTANCE_MAP_BATCH_LANES_INL_HPP
#undef ECHINUS_DISTANCE_MAP_BATCH_LANES_INL_HPP
#else
#define ECHINUS_DISTANCE_MAP_BATCH_LANES_INL_HPP
#endif

#include "distance_map/query/query_lanes-inl.hpp"
#include "simd/compress-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace echinus {
namespace HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR // one lane is the reference, whatever the grid

class SphericalLanes;
class EllipsoidalLanes;
class OctahedralLanes;
class CubeLanes;

template <typename Grid>
GridKernels kernels_of() {
    return {[](const DistanceMapView& map, const StridedSpan<const Vec3f>& points, std::uint8_t* inside) {
                for (std::size_t i = 0; i < points.size(); ++i) inside[i] = contains(map, points[i]) ? 1 : 0;
            },
            [](const DistanceMapView& map, const StridedSpan<const Vec3f>& points, float margin,
               Contact* contacts) {
                for (std::size_t i = 0; i < points.size(); ++i) contacts[i] = contact(map, points[i], margin);
            }};
}

#else

namespace { // private to this folder

/// The two kinds of answers: for each, the kernel's function and the destination.
struct InsideAnswers {
    using Answer = std::uint8_t;
    std::uint8_t* answers;

    template <typename Kernel>
    HWY_INLINE FloatMask most(const Kernel& kernel, const Vec3f* points, std::size_t first) const {
        return kernel.contains_most(points, answers + first);
    }
    template <typename Kernel>
    HWY_INLINE void any(const Kernel& kernel, const Vec3f* points, Answer* result) const {
        kernel.contains_any(points, result);
    }
};

struct ContactAnswers {
    using Answer = Contact;
    Contact* answers;
    float margin;

    template <typename Kernel>
    HWY_INLINE FloatMask most(const Kernel& kernel, const Vec3f* points, std::size_t first) const {
        return kernel.contacts_most(points, margin, answers + first);
    }
    template <typename Kernel>
    HWY_INLINE void any(const Kernel& kernel, const Vec3f* points, Answer* result) const {
        kernel.contacts_any(points, margin, result);
    }
};

/// The particles of a piece of a batch that are deferred, by their index in the piece.
class Leftovers {
  public:
    static constexpr std::size_t kCapacity = 256;

    HWY_INLINE void add(FloatMask mask, std::size_t first) {
        if (hn::AllFalse(kFloat, mask)) return;
        const IntLanes numbers = hn::Iota(kInt, static_cast<std::int32_t>(first));
        const Compressor compress(as_int_mask(mask));
        hn::StoreU(compress(numbers), kInt, numbers_ + count_);
        count_ += compress.count();
    }
    void add_one(std::size_t number) { numbers_[count_++] = static_cast<std::int32_t>(number); }

    template <typename Kernel, typename Answers>
    HWY_INLINE void work_off(const Kernel& kernel, const Vec3f* points, const Answers& answers) {
        Vec3f some[kLanes];
        typename Answers::Answer results[kLanes];
        for (std::size_t begin = 0; begin < count_; begin += kLanes) {
            const std::size_t count = std::min(kLanes, count_ - begin);
            for (std::size_t lane = 0; lane < kLanes; ++lane)
                some[lane] = points[numbers_[begin + std::min(lane, count - 1)]];
            answers.any(kernel, some, results);
            for (std::size_t lane = 0; lane < count; ++lane)
                answers.answers[numbers_[begin + lane]] = results[lane];
        }
        count_ = 0;
    }

  private:
    std::int32_t numbers_[kCapacity + kLanes];
    std::size_t count_ = 0;
};

/// @param points  [count] contiguous
template <typename Kernel, typename Answers>
void answer_piece(const Kernel& kernel, const Vec3f* points, std::size_t count, const Answers& answers) {
    Leftovers leftovers;
    std::size_t i = 0;
    for (; i + kLanes <= count; i += kLanes) leftovers.add(answers.most(kernel, points + i, i), i);
    for (; i < count; ++i) leftovers.add_one(i);
    leftovers.work_off(kernel, points, answers);
}

bool is_contiguous(const StridedSpan<const Vec3f>& points) {
    return points.size() < 2 || &points[1] == &points[0] + 1;
}

template <typename Kernel, typename Answers>
void answer_all(const Kernel& kernel, const StridedSpan<const Vec3f>& points, Answers answers) {
    const bool contiguous = is_contiguous(points);
    Vec3f copies[Leftovers::kCapacity];
    for (std::size_t begin = 0; begin < points.size(); begin += Leftovers::kCapacity) {
        const std::size_t count = std::min(Leftovers::kCapacity, points.size() - begin);
        if (!contiguous)
            for (std::size_t i = 0; i < count; ++i) copies[i] = points[begin + i];
        answer_piece(kernel, contiguous ? &points[begin] : copies, count, answers);
        answers.answers += count;
    }
}

template <typename Grid>
void contains_lanes(const DistanceMapView& map, const StridedSpan<const Vec3f>& points,
                    std::uint8_t* inside) {
    answer_all(Kernel<Grid>(map), points, InsideAnswers{inside});
}

template <typename Grid>
void contacts_lanes(const DistanceMapView& map, const StridedSpan<const Vec3f>& points, float margin,
                    Contact* contacts) {
    answer_all(Kernel<Grid>(map), points, ContactAnswers{contacts, margin});
}

} // namespace

/// @tparam Grid  the lanes class of a grid
template <typename Grid>
GridKernels kernels_of() {
    return {contains_lanes<Grid>, contacts_lanes<Grid>};
}

#endif

} // namespace HWY_NAMESPACE
} // namespace echinus
HWY_AFTER_NAMESPACE();

#endif
