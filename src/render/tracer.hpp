#pragma once

#include "render/intersector.hpp"
#include "render/light.hpp"
#include "render/painted_surface.hpp"

#include <cstdint>

namespace echinus {

/// A camera's rays in the unit frame.
class Lens {
  public:
    Lens(const Camera& camera, const UnitFrame& frame, std::uint32_t width, std::uint32_t height);

    /// Through a point of the picture, in pixels from its upper left corner.
    Ray ray_through(float x, float y) const;
    /// Width of a pixel at distance 1 along the direction of view.
    float pixel_size() const { return pixel_size_; }

  private:
    Vec3f position_, corner_, step_x_, step_y_;
    float pixel_size_;
};

/// Computes the light that reaches the camera through a pixel. Immutable and thread-safe.
class Tracer {
  public:
    Tracer(const PaintedSurface& surface, const Intersector& intersector, const Camera& camera,
           const RenderOptions& options);

    /// Mean over all samples; a pure function of the pixel.
    Vec3f pixel(std::uint32_t x, std::uint32_t y) const;

  private:
    /// A place seen through a pixel: the light that it sends regardless of its surroundings, and the light
    /// that the lamp and one direction of the surroundings add if nothing blocks them.
    struct Place {
        Vec3f base, lamp_gain, sky_gain;
        Ray to_lamp, to_sky; ///< unused where the gain is zero
    };
    /// The random numbers of one sample in one pixel.
    struct Draw {
        std::uint32_t sample, seed;
    };

    /// The results of one packet's samples.
    struct Seen {
        Vec3f light; ///< summed
        bool only_open_floor = true;
    };

    Seen packet(std::uint32_t x, std::uint32_t y, std::uint32_t first_sample, std::size_t count) const;
    Place object_place(const Ray& ray, const RayHit& hit, const Draw& draw) const;
    Place floor_place(const Ray& ray, const Draw& draw, float border_fade) const;
    /// 1 inside the picture, 0 at its border.
    float border_fade(std::uint32_t x, std::uint32_t y) const;
    Vec3f albedo(const RayHit& hit, const Vec3f& position, bool from_behind) const;
    bool on_wire(const RayHit& hit, const Vec3f& position) const;

    const PaintedSurface& surface_;
    const Intersector& intersector_;
    SampleTables samples_;
    Lens lens_;
    StudioLight light_;
    float floor_height_; ///< along light_.up(), in the unit frame
    Vec3f wire_colour_;
    Vec3f backdrop_;
    std::uint32_t sample_count_;
    std::uint32_t width_, height_;
};

} // namespace echinus
