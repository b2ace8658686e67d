// Included once for each instruction set, as Highway wants it: no guard against a second time.
#if defined(ECHINUS_FACE_CANDIDATES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ECHINUS_FACE_CANDIDATES_INL
#undef ECHINUS_FACE_CANDIDATES_INL
#else
#define ECHINUS_FACE_CANDIDATES_INL
#endif

#include "exact_map/query/nearest.hpp"
#include "exact_map/query/nearest_faces.hpp"
#include "simd/lanes-inl.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#if HWY_TARGET != HWY_SCALAR // where the reference is used instead
HWY_BEFORE_NAMESPACE();
namespace echinus::HWY_NAMESPACE {

/// The faces that may be the nearest to some of the current places.
class FaceCandidates {
  public:
    void clear() { size_ = 0; }
    std::size_t size() const { return size_; }
    bool full() const { return size_ == kCapacity; }

    void add(std::uint32_t face, FloatLanes lower) {
        faces_[size_] = face;
        hn::Store(lower, Floats(), lowers_[size_].data());
        ++size_;
    }

    /// Drops those that are too far for every place.
    void keep_within(FloatLanes upper) {
        constexpr Floats f;
        std::size_t kept = 0;
        for (std::size_t i = 0; i < size_; ++i) {
            const FloatLanes lower = hn::Load(f, lowers_[i].data());
            if (hn::AllFalse(f, hn::Le(lower, upper))) continue;
            faces_[kept] = faces_[i];
            hn::Store(lower, f, lowers_[kept].data());
            ++kept;
        }
        size_ = kept;
    }

    /// For each place, the candidate that the scalar query takes.
    /// @param upper  no place is farther from its nearest face, in the unit of the lower bounds
    void choose(const ExactMapView& map, const Vec3d& stretch, std::span<const NearestSearch> searches,
                FloatLanes upper, std::span<std::uint32_t> faces) const {
        std::array<double, kMaxLanes> distances_sq;
        std::uint32_t measured = 0; // places whose face's distance is known
        std::fill(faces.begin(), faces.end(), kNoFace);
        const std::uint32_t asked = (1U << searches.size()) - 1;
        for (std::size_t i = 0; i < size_; ++i) {
            const std::uint32_t face = faces_[i];
            for (std::uint32_t rest = places_within(i, upper) & asked; rest != 0; rest &= rest - 1) {
                const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
                const NearestSearch& search = searches[lane];
                const bool bounded = std::isfinite(search.farthest);
                if (faces[lane] == kNoFace && !bounded) { // there must be one, and this may be it
                    faces[lane] = face;
                    continue;
                }
                const auto distance_to = [&](std::uint32_t other) {
                    return distance_sq_to_face(map, other, search.place, stretch);
                };
                if (faces[lane] != kNoFace && (measured >> lane & 1) == 0)
                    distances_sq[lane] = distance_to(faces[lane]);
                measured |= 1U << lane;
                const double distance_sq = distance_to(face);
                const bool nearer = faces[lane] == kNoFace
                                        ? distance_sq <= search.farthest * search.farthest
                                        : distance_sq < distances_sq[lane] ||
                                              (distance_sq == distances_sq[lane] && face < faces[lane]);
                if (!nearer) continue;
                faces[lane] = face;
                distances_sq[lane] = distance_sq;
            }
        }
    }

  private:
    /// A bit for each place that the face may be the nearest to.
    std::uint32_t places_within(std::size_t i, FloatLanes upper) const {
        constexpr Floats f;
        std::array<std::uint8_t, 8> bits{};
        hn::StoreMaskBits(f, hn::Le(hn::Load(f, lowers_[i].data()), upper), bits.data());
        return bits[0] | std::uint32_t{bits[1]} << 8;
    }

    static constexpr std::size_t kCapacity = 64;
    static constexpr std::size_t kMaxLanes = 16;

    std::size_t size_ = 0;
    std::array<std::uint32_t, kCapacity> faces_;
    alignas(64) std::array<std::array<float, kMaxLanes>, kCapacity> lowers_;
};

} // namespace echinus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

#endif
