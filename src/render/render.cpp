#include "geometry/parallel.hpp"
#include "render/image.hpp"
#include "render/intersector.hpp"
#include "render/light.hpp"
#include "render/painted_surface.hpp"

#include <echinus/error.hpp>
#include <echinus_render/render.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <mutex>

namespace echinus::render {

namespace {

/// A camera's rays in the unit frame.
class Lens {
  public:
    Lens(const Camera& camera, const UnitFrame& frame, std::uint32_t width, std::uint32_t height);

    /// The ray through a point of the picture, in pixels from its upper left corner.
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
    /// A point seen through a pixel: the light that it sends regardless of its surroundings, and the light
    /// that the lamp and one direction of the surroundings add if nothing blocks them.
    struct Place {
        Vec3f base, lamp_gain, sky_gain;
        Ray to_lamp, to_sky; ///< unused if the gain is zero
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

/// This colour becomes palette::kPage when highlights are compressed.
constexpr Colour kBackdrop = Colour::from_hex(0xFEFDFB);
/// The darkness of a point on the floor that no light reaches; 1 would be black.
constexpr float kShadowStrength = 0.66F;
/// Light from a direction blocked by another part of the drawing, as a share of the light that the open
/// direction would send, times that part's albedo, which is assumed to be the point's own.
constexpr float kInterreflection = 0.85F;
/// Clearance of rays that start on the surface, in the unit frame.
constexpr float kClearance = 1e-4F;
/// The drawing's shadow fades out between these distances from its middle, in the unit frame.
constexpr float kFloorFadeStart = 4, kFloorFadeEnd = 7;
/// Shadows also fade out towards the picture's border, over this share of its smaller side, so that pictures
/// join the page and each other without a seam.
constexpr float kBorderFade = 0.12F;

Vec3f multiply(const Vec3f& a, const Vec3f& b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}
float grey(const Vec3f& light) {
    return (light.x + light.y + light.z) / 3;
}

/// Everything drawn is within the unit sphere; most rays from the floor miss it and need no query of Embree.
/// The sphere tested is slightly larger, to allow for rounding.
bool meets_unit_sphere(const Ray& ray) {
    constexpr float kRadiusSq = 1.0001F;
    const float distance_sq = dot(ray.origin, ray.origin);
    if (distance_sq <= kRadiusSq) return true;
    const float approach = -dot(ray.origin, ray.direction);
    const float direction_sq = dot(ray.direction, ray.direction);
    return approach > 0 && (distance_sq - kRadiusSq) * direction_sq <= approach * approach;
}

template <typename T>
T blend(const std::array<T, 3>& corners, const RayHit& hit) {
    return corners[0] * (1 - hit.u - hit.v) + corners[1] * hit.u + corners[2] * hit.v;
}

/// Moves a point of a flat face out to the curved surface that its normals imply; otherwise the face itself
/// would cut off the light in the middle of a smooth gradient. Hanika, "Hacking the Shadow Terminator", Ray
/// Tracing Gems II, 2021.
Vec3f lift_to_smooth_surface(const Vec3f& point, const std::array<Vec3f, 3>& corners,
                             const CornerNormals& normals, const RayHit& hit) {
    std::array<Vec3f, 3> lifts;
    for (std::size_t k = 0; k < 3; ++k) {
        lifts[k] = normals[k] * -std::min(dot(point - corners[k], normals[k]), 0.0F);
    }
    return point + blend(lifts, hit);
}

/// The rays to one light from the points seen through one pixel, and the light that each unblocked ray adds.
class LightRays {
  public:
    void add(const Ray& ray, const Vec3f& gain) {
        if (gain == Vec3f{}) return;
        rays_[count_] = ray;
        gains_[count_++] = gain;
    }
    struct Sum {
        Vec3f light;
        bool any_blocked = false;
    };
    Sum trace(const Intersector& intersector) const {
        if (count_ == 0) return {};
        const std::uint32_t blocked = intersector.blocked({rays_.data(), count_});
        Sum sum;
        sum.any_blocked = blocked != 0;
        for (std::size_t i = 0; i < count_; ++i) {
            if ((blocked >> i & 1U) == 0) sum.light += gains_[i];
        }
        return sum;
    }

  private:
    std::array<Ray, Intersector::kPacketSize> rays_;
    std::array<Vec3f, Intersector::kPacketSize> gains_;
    std::size_t count_ = 0;
};

Lens::Lens(const Camera& camera, const UnitFrame& frame, std::uint32_t width, std::uint32_t height)
    : position_(frame.to_unit(camera.position)),
      pixel_size_(static_cast<float>(2 * camera.tan_half_height / height)) {
    step_x_ = Vec3f(camera.right) * pixel_size_;
    step_y_ = Vec3f(camera.up) * -pixel_size_;
    corner_ = Vec3f(camera.forward) - step_x_ * (static_cast<float>(width) / 2) -
              step_y_ * (static_cast<float>(height) / 2);
}

Ray Lens::ray_through(float x, float y) const {
    return {position_, unit_of(corner_ + step_x_ * x + step_y_ * y)};
}

Tracer::Tracer(const PaintedSurface& surface, const Intersector& intersector, const Camera& camera,
               const RenderOptions& options)
    : surface_(surface), intersector_(intersector), samples_(options.samples),
      lens_(camera, surface.frame, options.width, options.height), light_(camera),
      floor_height_(static_cast<float>((camera.floor_height - dot(camera.world_up, surface.frame.centre)) *
                                       surface.frame.scale)),
      wire_colour_(to_linear(palette::kInk)), backdrop_(to_linear(kBackdrop)), sample_count_(options.samples),
      width_(options.width), height_(options.height) {}

Vec3f Tracer::pixel(std::uint32_t x, std::uint32_t y) const {
    Vec3f sum;
    for (std::uint32_t first = 0; first < sample_count_; first += Intersector::kPacketSize) {
        const std::size_t count = std::min<std::size_t>(Intersector::kPacketSize, sample_count_ - first);
        const Seen seen = packet(x, y, first, count);
        // This is the case for most pixels of most pictures, and nothing more has to be computed.
        if (first == 0 && count == Intersector::kPacketSize && seen.only_open_floor) return backdrop_;
        sum += seen.light;
    }
    return sum * (1 / static_cast<float>(sample_count_));
}

Tracer::Seen Tracer::packet(std::uint32_t x, std::uint32_t y, std::uint32_t first_sample,
                            std::size_t count) const {
    std::array<Ray, Intersector::kPacketSize> rays;
    std::array<RayHit, Intersector::kPacketSize> hits;
    const std::uint32_t seed = SampleTables::pixel_seed(x, y);
    bool any_meets = false;
    for (std::uint32_t i = 0; i < count; ++i) {
        const Sample2 offset = samples_.sample(first_sample + i, SampleUse::Pixel, seed);
        rays[i] = lens_.ray_through(static_cast<float>(x) + offset[0], static_cast<float>(y) + offset[1]);
        any_meets = any_meets || meets_unit_sphere(rays[i]);
    }
    if (any_meets) intersector_.first_hits({rays.data(), count}, hits);

    Seen seen;
    LightRays lamp, sky;
    const float fade = border_fade(x, y);
    for (std::uint32_t i = 0; i < count; ++i) {
        const Draw draw{first_sample + i, seed};
        const Place place =
            hits[i].found() ? object_place(rays[i], hits[i], draw) : floor_place(rays[i], draw, fade);
        seen.only_open_floor = seen.only_open_floor && !hits[i].found();
        seen.light += place.base;
        lamp.add(place.to_lamp, place.lamp_gain);
        sky.add(place.to_sky, place.sky_gain);
    }
    const LightRays::Sum from_lamp = lamp.trace(intersector_);
    const LightRays::Sum from_sky = sky.trace(intersector_);
    seen.light += from_lamp.light + from_sky.light;
    seen.only_open_floor = seen.only_open_floor && !from_lamp.any_blocked && !from_sky.any_blocked;
    return seen;
}

Tracer::Place Tracer::object_place(const Ray& ray, const RayHit& hit, const Draw& draw) const {
    const Triangle& face = surface_.mesh.faces[hit.face];
    const std::array<Vec3f, 3> corners{surface_.mesh.vertices[face[0]], surface_.mesh.vertices[face[1]],
                                       surface_.mesh.vertices[face[2]]};
    const Vec3f outward(face_normal(surface_.mesh, face));
    const bool from_behind = dot(outward, ray.direction) > 0;
    const float side = from_behind ? -1.0F : 1.0F; // of the viewer
    CornerNormals normals = surface_.normals[hit.face];
    for (Vec3f& normal : normals) normal *= side;

    const Vec3f position = blend(corners, hit);
    const Vec3f smooth = blend(normals, hit);
    // Opposite normals may cancel out.
    const Vec3f normal = dot(smooth, smooth) > 1e-6F ? unit_of(smooth) : outward * side;
    const Vec3f start =
        lift_to_smooth_surface(position, corners, normals, hit) + outward * (side * kClearance);
    const Vec3f paint = albedo(hit, position, from_behind);
    const Vec3f sky_direction =
        cosine_direction(normal, samples_.sample(draw.sample, SampleUse::Sky, draw.seed));
    const Vec3f sky = multiply(light_.ambient_radiance(sky_direction), paint);

    Place place;
    place.base = multiply(sky, paint) * kInterreflection;
    place.sky_gain = sky - place.base;
    place.lamp_gain = multiply(light_.lamp_irradiance(normal), paint);
    place.to_sky = {start, sky_direction};
    place.to_lamp = {start, light_.lamp_direction(samples_.sample(draw.sample, SampleUse::Lamp, draw.seed))};
    return place;
}

Vec3f Tracer::albedo(const RayHit& hit, const Vec3f& position, bool from_behind) const {
    if (on_wire(hit, position)) return wire_colour_;
    return from_behind ? surface_.backs[hit.face] : surface_.fronts[hit.face];
}

bool Tracer::on_wire(const RayHit& hit, const Vec3f& position) const {
    const float half_width_px = surface_.wire_half_widths_px[hit.face];
    if (half_width_px == 0) return false;
    const float half_width = half_width_px * lens_.pixel_size() * hit.distance;
    const Triangle& face = surface_.mesh.faces[hit.face];
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3f& start = surface_.mesh.vertices[face[k]];
        const Vec3f edge = surface_.mesh.vertices[face[(k + 1) % 3]] - start;
        if (length(cross(position - start, edge)) < half_width * length(edge)) return true;
    }
    return false;
}

float Tracer::border_fade(std::uint32_t x, std::uint32_t y) const {
    const std::uint32_t distance = std::min({x, width_ - 1 - x, y, height_ - 1 - y});
    const float width = kBorderFade * static_cast<float>(std::min(width_, height_));
    const float share = std::min(static_cast<float>(distance) / width, 1.0F);
    return share * share * (3 - 2 * share);
}

/// The floor has the colour of the backdrop, so that there is no horizon, and is darkened only by the share
/// of light that the drawing blocks.
Tracer::Place Tracer::floor_place(const Ray& ray, const Draw& draw, float border_fade) const {
    Place place;
    place.base = backdrop_;
    const float fall = dot(ray.direction, light_.up());
    const float distance = (floor_height_ - dot(ray.origin, light_.up())) / fall;
    if (!(distance > 0)) return place;
    const Vec3f point = ray.origin + ray.direction * distance;
    const float fade =
        border_fade *
        std::clamp((kFloorFadeEnd - length(point)) / (kFloorFadeEnd - kFloorFadeStart), 0.0F, 1.0F);
    if (fade == 0) return place;

    const Vec3f start = point + light_.up() * kClearance;
    place.to_sky = {start,
                    cosine_direction(light_.up(), samples_.sample(draw.sample, SampleUse::Sky, draw.seed))};
    place.to_lamp = {start, light_.lamp_direction(samples_.sample(draw.sample, SampleUse::Lamp, draw.seed))};
    // Grey, though the lamp is warmer than the sky: a tinted shadow looks like a stain on a white page.
    const float lamp = grey(light_.lamp_irradiance(light_.up()));
    const float sky = grey(light_.ambient_radiance(place.to_sky.direction));
    const Vec3f full = backdrop_ * (kShadowStrength * fade / (lamp + sky));
    if (meets_unit_sphere(place.to_lamp)) place.lamp_gain = full * lamp;
    if (meets_unit_sphere(place.to_sky)) place.sky_gain = full * sky;
    place.base -= place.lamp_gain + place.sky_gain;
    return place;
}

} // namespace

namespace {

void require_valid_options(const RenderOptions& options) {
    require_drawable(options.width, options.height);
    if (options.samples < 1 || options.samples > RenderOptions::kMaxSampleCount) {
        throw Error(ErrorCode::InvalidOptions, std::to_string(options.samples) +
                                                   " samples per pixel: give 1 to " +
                                                   std::to_string(RenderOptions::kMaxSampleCount));
    }
}

/// Counts finished rows and reports them to the caller's callback, one thread at a time.
class RowProgress {
  public:
    explicit RowProgress(const RenderOptions& options)
        : callback_(options.progress), row_count_(options.height) {}

    void finish_row() {
        if (!callback_) return;
        const std::lock_guard lock(mutex_);
        ++finished_;
        callback_(static_cast<double>(finished_) / row_count_);
    }

  private:
    const std::function<void(double)>& callback_;
    std::mutex mutex_;
    std::uint32_t row_count_, finished_ = 0;
};

void draw_row(const Tracer& tracer, std::uint32_t y, Image& image) {
    for (std::uint32_t x = 0; x < image.width; ++x) {
        const auto pixel = to_srgb8(compress_highlights(tracer.pixel(x, y)));
        std::copy(pixel.begin(), pixel.end(), &image.rgb[3 * (std::size_t{y} * image.width + x)]);
    }
}

} // namespace

Image render(std::span<const RenderedObject> objects, const Camera& camera, const RenderOptions& options) {
    require_valid_options(options);
    const PaintedSurface surface = paint(objects);
    const Intersector intersector(surface.mesh);
    const Tracer tracer(surface, intersector, camera, options);

    Image image{options.width, options.height, {}};
    image.rgb.resize(std::size_t{3} * options.width * options.height);
    RowProgress progress(options);
    parallel_for(options.height, options.thread_count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t y = begin; y < end; ++y) {
            draw_row(tracer, static_cast<std::uint32_t>(y), image);
            progress.finish_row();
        }
    });
    return image;
}

} // namespace echinus::render
