#pragma once

#include "directions/spherical_grid.hpp"
#include "geometry/elementary.hpp"
#include "rivals/superquadric_map/superquadric_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace echinus::rivals {

/// The data of a segment that a query needs besides its grid.
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
    std::vector<SegmentFrame> frames;      ///< [segment_count]
    std::vector<PowerPair> eta_powers;     ///< [segment_count][eta_count] to the power e1
    std::vector<PowerPair> omega_powers;   ///< [segment_count][omega_count] to the power e2
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

// One particle and one segment.

/// A place in a segment's frame as its superquadric sees it: on which ray, and how far out the superquadric
/// is there.
struct SuperquadricPlace {
    float distance;        ///< from the centre
    float to_superquadric; ///< from the centre along the ray
    SphericalGrid::Coordinates at;
};

/// log2(2^a + 2^b)
inline float log2_of_sum(float a, float b) {
    return std::max(a, b) + std::log2(1 + std::exp2(-std::fabs(a - b)));
}

/// log2 of a coordinate's ratio to a size, kept finite.
inline float log2_of_ratio(float coordinate, float size) {
    return std::log2(std::clamp(std::fabs(coordinate) / size, 1e-30F, 1e30F));
}

/// The angle whose tangent's square is 2^(log_sine_sq - log_cosine_sq).
inline float angle_of(float log_sine_sq, float sine_sign, float log_cosine_sq, float cosine_sign) {
    const float smaller = std::exp2(-std::fabs(log_sine_sq - log_cosine_sq) / 2);
    const bool steep = log_sine_sq > log_cosine_sq;
    return atan2_polynomial(std::copysign(steep ? 1 : smaller, sine_sign),
                            std::copysign(steep ? smaller : 1, cosine_sign));
}

/// The inside-outside function by logarithms, as in superquadric.hpp, and the angles from its terms.
/// @param place  finite
inline SuperquadricPlace locate(const SegmentArrays& map, const SegmentFrame& frame, const Vec3f& place) {
    const float e1 = frame.eta_exponent, e2 = frame.omega_exponent;
    const float x = 2 / e2 * log2_of_ratio(place.x, frame.sizes.x);
    const float y = 2 / e2 * log2_of_ratio(place.y, frame.sizes.y);
    const float z = 2 / e1 * log2_of_ratio(place.z, frame.sizes.z);
    const float section = log2_of_sum(x, y);
    const float disc = e2 / e1 * section;
    const float whole = log2_of_sum(disc, z);

    const float omega = angle_of(y, place.y, x, place.x), eta = angle_of(z, place.z, disc, 1);
    SuperquadricPlace result;
    result.distance = length(place);
    result.to_superquadric = result.distance * std::exp2(-e1 / 2 * whole);
    result.at.along_phi = omega * (static_cast<float>(map.grid.longitude_count()) / (2 * kPi));
    result.at.along_theta = (kPi / 2 - eta) * (static_cast<float>(map.grid.colatitude_count()) / kPi) - 0.5F;
    return result;
}

/// The samples around a place and how much each counts; empty ones count nothing.
struct SampleCell {
    SphericalGrid::Cell cell;
    std::array<float, 4> samples, weights;
    bool is_empty;    ///< the nearest sample is
    bool is_complete; ///< none of the four is

    SampleCell(const SegmentArrays& map, std::size_t segment, const SphericalGrid::Coordinates& at)
        : cell(map.grid.cell_at(at)), weights(SphericalGrid::weights(cell)) {
        float sum = 0;
        is_complete = true;
        for (std::size_t k = 0; k < 4; ++k) {
            samples[k] = map.sample(segment, cell.corners[k]);
            if (samples[k] < 0) weights[k] = 0, is_complete = false;
            sum += weights[k];
        }
        is_empty = samples[SphericalGrid::reference_corner(cell)] < 0;
        if (!is_complete && sum > 0)
            for (float& weight : weights) weight /= sum;
    }
    /// From the superquadric down to the map's surface. @pre !is_empty
    float distance() const {
        return weights[0] * samples[0] + weights[1] * samples[1] + weights[2] * samples[2] +
               weights[3] * samples[3];
    }
};

/// The answer of a segment for a particle.
struct SegmentAnswer {
    bool is_known = false; ///< false beyond the reach and on rays without a crossing
    float depth = 0;       ///< along the ray, negative outside
    Vec3f place;           ///< of the particle, in the segment's frame
    SuperquadricPlace at;
};

/// @param margin  particles at most so far outside of the segment's surface are certainly answered
inline SegmentAnswer ask(const SegmentArrays& map, std::size_t segment, const Vec3f& point_local,
                         float margin) {
    const SegmentFrame& frame = map.frames[segment];
    SegmentAnswer answer;
    const Vec3f from_centre = point_local - frame.centre;
    const float reach = frame.radius + margin;
    if (!(dot(from_centre, from_centre) <= reach * reach)) return answer;
    const Vec3f p = frame.to_frame(point_local);
    const Vec3f& a = frame.sizes;
    if (!(std::fabs(p.x) <= a.x + margin && std::fabs(p.y) <= a.y + margin && std::fabs(p.z) <= a.z + margin))
        return answer;
    answer.place = p;
    answer.at = locate(map, frame, p);
    if (!(answer.at.distance <= answer.at.to_superquadric + margin))
        return answer;               // far outside: the first layer
    if (!(answer.at.distance > 0)) { // the centre is on every ray: say the one along the first axis
        answer.at.distance = 0;
        answer.at.to_superquadric = a.x;
    }
    const SampleCell cell(map, segment, answer.at.at);
    if (cell.is_empty) return answer;
    answer.is_known = true;
    answer.depth = answer.at.to_superquadric - cell.distance() - answer.at.distance;
    return answer;
}

/// Unit normal of the map's surface on the ray of a place, in the segment's frame: that of the bilinear patch
/// between the four samples' points, or of the superquadric where a sample is empty or the patch has no area.
Vec3f surface_normal(const SegmentArrays& map, std::size_t segment, const Vec3f& place,
                     const SuperquadricPlace& at);

} // namespace echinus::rivals
