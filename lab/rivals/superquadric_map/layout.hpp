#pragma once

#include "directions/spherical_grid.hpp"
#include "rivals/superquadric_map/superquadric_map.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace echinus::rivals {

/// What a query needs of a segment besides its grid.
struct SegmentFrame {
    Vec3f axes[3];                              ///< of the superquadric, in the mesh's frame
    Vec3f centre;                               ///< local
    Vec3f sizes;                                ///< a1, a2, a3 of the enlarged superquadric
    float eta_exponent = 1, omega_exponent = 1; ///< e1, e2
    float radius = 0;                           ///< of a sphere around the centre that holds the superquadric
    float largest_distance = 0;                 ///< what 1 stands for in a 16-bit sample

    Vec3f to_frame(const Vec3f& point_local) const {
        const Vec3f d = point_local - centre;
        return {dot(axes[0], d), dot(axes[1], d), dot(axes[2], d)};
    }
    Vec3f turned_from_frame(const Vec3f& v) const { return axes[0] * v.x + axes[1] * v.y + axes[2] * v.z; }
};
static_assert(sizeof(SegmentFrame) == 76);

/// The powers of cosine and sine of which the superquadric's points are made, at a row or column of samples.
struct PowerPair {
    float cosine, sine;
};

/// A map as arrays; segment after segment in each.
struct SegmentArrays {
    /// In samples: no crossing here.
    static constexpr float kEmpty = -1;
    static constexpr std::uint16_t kEmpty16 = std::numeric_limits<std::uint16_t>::max();
    static constexpr float kSteps16 = 65534;

    SphericalGrid grid{0, 0, PoleAxis::Z}; ///< longitude is omega, colatitude is pi/2 - eta
    SuperquadricSampling sampling = SuperquadricSampling::Formula;
    std::vector<SegmentFrame> frames;    ///< [segment_count]
    std::vector<PowerPair> eta_powers;   ///< [segment_count][eta_count] to the power e1
    std::vector<PowerPair> omega_powers; ///< [segment_count][omega_count] to the power e2
    /// [segment_count][eta_count][omega_count] from the superquadric down to the surface, along the ray; or
    /// empty
    std::vector<float> samples;
    std::vector<std::uint16_t> samples16; ///< the same * kSteps16 / largest_distance, or empty

    std::size_t byte_count() const {
        return frames.size() * sizeof(SegmentFrame) +
               (eta_powers.size() + omega_powers.size()) * sizeof(PowerPair) +
               samples.size() * sizeof(float) + samples16.size() * sizeof(std::uint16_t);
    }
    float sample(std::size_t segment, std::uint32_t index) const {
        const std::size_t position = segment * grid.direction_count() + index;
        if (!samples.empty()) return samples[position];
        const std::uint16_t stored = samples16[position];
        return stored == kEmpty16
                   ? kEmpty
                   : static_cast<float>(stored) * (frames[segment].largest_distance / kSteps16);
    }
    /// The point of the superquadric at a sample, in its frame.
    Vec3f surface_point(std::size_t segment, std::uint32_t index) const {
        const Vec3f& a = frames[segment].sizes;
        const PowerPair& eta = eta_powers[segment * grid.colatitude_count() + index / grid.longitude_count()];
        const PowerPair& omega =
            omega_powers[segment * grid.longitude_count() + index % grid.longitude_count()];
        return {a.x * eta.cosine * omega.cosine, a.y * eta.cosine * omega.sine, a.z * eta.sine};
    }
};

} // namespace echinus::rivals
