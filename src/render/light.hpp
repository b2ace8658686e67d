#pragma once

#include "render/sample_sequence.hpp"

#include <echinus/render.hpp>

namespace echinus {

/// A vector other than 0, made a unit long.
inline Vec3f unit_of(const Vec3f& v) {
    return v * (1 / length(v));
}

/// The fixed light of all pictures: a large soft lamp above the camera's left shoulder, a pale sky, and the
/// light reflected by the floor. Radiances are linear, in units of a white surface that faces the sky.
class StudioLight {
  public:
    explicit StudioLight(const Camera& camera);

    /// Towards a point of the lamp.
    Vec3f lamp_direction(const Sample2& sample) const;
    /// Light from the unshaded lamp on a surface, per albedo.
    Vec3f lamp_irradiance(const Vec3f& normal) const;
    /// Light that comes in along a direction, from the sky or from the floor.
    Vec3f ambient_radiance(const Vec3f& direction) const;

    const Vec3f& up() const { return up_; }

  private:
    Vec3f up_;
    Vec3f lamp_, lamp_x_, lamp_y_; ///< orthonormal, lamp_ towards the lamp's middle
};

/// A direction about the normal, with a density proportional to the cosine: the mean of the incoming
/// radiances along such directions is the light on the surface.
Vec3f cosine_direction(const Vec3f& normal, const Sample2& sample);

} // namespace echinus
