#include "render/light.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace echinus::render {

namespace {

std::uint32_t mix(std::uint32_t x) {
    x ^= x >> 16;
    x *= 0x7feb352dU;
    x ^= x >> 15;
    x *= 0x846ca68bU;
    x ^= x >> 16;
    return x;
}

std::uint32_t combine(std::uint32_t seed, std::uint32_t value) {
    return mix(seed ^ (value + 0x9e3779b9U + (seed << 6) + (seed >> 2)));
}

std::uint32_t reverse_bits(std::uint32_t x) {
    x = ((x >> 1) & 0x55555555U) | ((x & 0x55555555U) << 1);
    x = ((x >> 2) & 0x33333333U) | ((x & 0x33333333U) << 2);
    x = ((x >> 4) & 0x0f0f0f0fU) | ((x & 0x0f0f0f0fU) << 4);
    x = ((x >> 8) & 0x00ff00ffU) | ((x & 0x00ff00ffU) << 8);
    return (x >> 16) | (x << 16);
}

/// Each bit of the result depends only on the bits above it, which preserves the strata (Burley, section 3;
/// constants of Laine and Karras as he gives them).
std::uint32_t owen_scramble(std::uint32_t x, std::uint32_t seed) {
    x = reverse_bits(x);
    x += seed;
    x ^= x * 0x6c50b47cU;
    x ^= x * 0xb82f1e52U;
    x ^= x * 0xc7afe638U;
    x ^= x * 0x8d22f6e6U;
    return reverse_bits(x);
}

/// Second dimension of the Sobol sequence; the first is the reversed index.
std::uint32_t sobol_second(std::uint32_t index) {
    std::uint32_t result = 0;
    for (std::uint32_t direction = 0x80000000U; index != 0; index >>= 1, direction ^= direction >> 1) {
        if ((index & 1U) != 0) result ^= direction;
    }
    return result;
}

/// The upper 24 bits, so that the quotient is exact and below 1.
float to_unit(std::uint32_t bits) {
    return static_cast<float>(bits >> 8) * 0x1p-24F;
}

constexpr std::uint32_t kTableCount = 64;

} // namespace

SampleTables::SampleTables(std::uint32_t sample_count) : sample_count_(sample_count) {
    points_.reserve(std::size_t{kTableCount} * sample_count);
    for (std::uint32_t table = 0; table < kTableCount; ++table) {
        const std::uint32_t seed = mix(table + 1);
        for (std::uint32_t i = 0; i < sample_count; ++i) {
            const std::uint32_t index = owen_scramble(i, seed);
            points_.push_back({owen_scramble(reverse_bits(index), combine(seed, 1)),
                               owen_scramble(sobol_second(index), combine(seed, 2))});
        }
    }
}

std::uint32_t SampleTables::pixel_seed(std::uint32_t x, std::uint32_t y) {
    return combine(mix(x), y);
}

Sample2 SampleTables::sample(std::uint32_t sample, SampleUse use, std::uint32_t pixel_seed) const {
    const std::uint32_t flips_x = combine(pixel_seed, static_cast<std::uint32_t>(use));
    const std::uint32_t flips_y = mix(flips_x);
    const Bits2& point = points_[std::size_t{flips_x % kTableCount} * sample_count_ + sample];
    return {to_unit(point[0] ^ flips_x), to_unit(point[1] ^ flips_y)};
}

namespace {

constexpr double kLampAzimuthDeg = 54;   // to the left of the camera, seen from the objects
constexpr double kLampElevationDeg = 50; // shadows stay short and fall to the right
constexpr float kLampRadius = 0.13F;     // tangent of the half angle: 7.4 degrees
constexpr Vec3f kLampRadiance{0.87F, 0.85F, 0.81F};
constexpr Vec3f kZenith{0.44F, 0.455F, 0.48F};
constexpr Vec3f kHorizon{0.26F, 0.27F, 0.283F};
constexpr Vec3f kFloorBounce{0.20F, 0.194F, 0.185F};

struct Basis {
    Vec3f x, y;
};

/// Two unit vectors that are orthogonal to a unit vector and to each other. Duff et al., "Building an
/// Orthonormal Basis, Revisited", JCGT 6(1), 2017.
Basis orthonormal_basis(const Vec3f& n) {
    const float sign = std::copysign(1.0F, n.z);
    const float a = -1 / (sign + n.z);
    const float b = n.x * n.y * a;
    return {{1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}};
}

/// Maps the unit square onto the unit disc, preserving area and keeping strata together. Shirley and Chiu, "A
/// Low Distortion Map Between Disk and Square", 1997.
Sample2 to_disc(const Sample2& sample) {
    const float a = 2 * sample[0] - 1;
    const float b = 2 * sample[1] - 1;
    if (a == 0 && b == 0) return {0, 0};
    const bool wide = std::abs(a) > std::abs(b);
    const float radius = wide ? a : b;
    const float angle = std::numbers::pi_v<float> / 4 * (wide ? b / a : a / b);
    // Taylor series suffice within an eighth of a turn (error 4e-6), at a fifth of the cost of std::sin and
    // std::cos, which would be called tens of millions of times per picture.
    const float square = angle * angle;
    const float cosine = 1 - square * (1 - square * (1 - square / 30) / 12) / 2;
    const float sine = angle * (1 - square * (1 - square * (1 - square / 42) / 20) / 6);
    return wide ? Sample2{radius * cosine, radius * sine} : Sample2{radius * sine, radius * cosine};
}

/// The direction towards the middle of the lamp, which is fixed relative to the camera's horizontal
/// direction, so that every view is well lit.
Vec3f lamp_middle(const Camera& camera) {
    constexpr double kDegree = std::numbers::pi / 180;
    const Vec3d towards_camera = cross(camera.right, camera.world_up);
    const double azimuth = kLampAzimuthDeg * kDegree;
    const double elevation = kLampElevationDeg * kDegree;
    const Vec3d level = towards_camera * std::cos(azimuth) - camera.right * std::sin(azimuth);
    return unit_of(Vec3f(level * std::cos(elevation) + camera.world_up * std::sin(elevation)));
}

} // namespace

StudioLight::StudioLight(const Camera& camera) : up_(camera.world_up), lamp_(lamp_middle(camera)) {
    const Basis basis = orthonormal_basis(lamp_);
    lamp_x_ = basis.x * kLampRadius;
    lamp_y_ = basis.y * kLampRadius;
}

Vec3f StudioLight::lamp_direction(const Sample2& sample) const {
    const Sample2 disc = to_disc(sample);
    return lamp_ + lamp_x_ * disc[0] + lamp_y_ * disc[1];
}

Vec3f StudioLight::lamp_irradiance(const Vec3f& normal) const {
    return kLampRadiance * std::max(dot(normal, lamp_), 0.0F);
}

Vec3f StudioLight::ambient_radiance(const Vec3f& direction) const {
    const float height = dot(direction, up_);
    // The floor's light comes from below the horizon; a narrow band smooths the transition.
    constexpr float kBand = 0.15F;
    const float sky_share = std::clamp(height / kBand + 0.5F, 0.0F, 1.0F);
    const Vec3f sky = kHorizon + (kZenith - kHorizon) * std::max(height, 0.0F);
    return kFloorBounce + (sky - kFloorBounce) * sky_share;
}

Vec3f cosine_direction(const Vec3f& normal, const Sample2& sample) {
    const Sample2 disc = to_disc(sample);
    const Basis basis = orthonormal_basis(normal);
    const float height = std::sqrt(std::max(0.0F, 1 - disc[0] * disc[0] - disc[1] * disc[1]));
    return basis.x * disc[0] + basis.y * disc[1] + normal * height;
}

} // namespace echinus::render
