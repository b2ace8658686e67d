#pragma once

#include <echinus_render/render.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace echinus::render {

/// Points of the unit square, in [0, 1)^2.
using Sample2 = std::array<float, 2>;

/// The purpose of a pair of random numbers; each has its own sequence.
enum class SampleUse : std::uint32_t { Pixel, Lamp, Sky };

/// Evenly spread points of the unit square for the samples of every pixel: Owen-scrambled Sobol sequences
/// (Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020), in which any aligned run of 2^k points
/// is as evenly distributed as possible. A few sequences are tabulated; each pixel takes one of them and
/// flips its digits by a pattern of its own, which preserves the even distribution at almost no cost.
class SampleTables {
  public:
    explicit SampleTables(std::uint32_t sample_count);

    /// The scrambling of a pixel's samples.
    static std::uint32_t pixel_seed(std::uint32_t x, std::uint32_t y);

    /// @pre sample < sample_count
    Sample2 sample(std::uint32_t sample, SampleUse use, std::uint32_t pixel_seed) const;

  private:
    using Bits2 = std::array<std::uint32_t, 2>;

    std::uint32_t sample_count_;
    std::vector<Bits2> points_; ///< [kTableCount][sample_count]
};

/// A nonzero vector, scaled to unit length.
inline Vec3f unit_of(const Vec3f& v) {
    return v * (1 / length(v));
}

/// The fixed light of all pictures: a large soft lamp above the camera's left shoulder, a pale sky, and the
/// light reflected by the floor. Radiances are linear, in units of a white surface that faces the sky.
class StudioLight {
  public:
    explicit StudioLight(const Camera& camera);

    /// The direction towards a point of the lamp.
    Vec3f lamp_direction(const Sample2& sample) const;
    /// Light from the unshaded lamp on a surface, per albedo.
    Vec3f lamp_irradiance(const Vec3f& normal) const;
    /// The light that arrives from a direction, from the sky or from the floor.
    Vec3f ambient_radiance(const Vec3f& direction) const;

    const Vec3f& up() const { return up_; }

  private:
    Vec3f up_;
    Vec3f lamp_, lamp_x_, lamp_y_; ///< orthonormal, lamp_ towards the lamp's middle
};

/// A direction about the normal, with a density proportional to the cosine: the mean of the incoming
/// radiances along such directions is the light on the surface.
Vec3f cosine_direction(const Vec3f& normal, const Sample2& sample);

} // namespace echinus::render
