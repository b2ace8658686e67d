#include "render/tone.hpp"

#include <algorithm>
#include <cmath>

namespace echinus {

namespace {

constexpr float kShoulderStart = 0.9F;
constexpr float kDesaturation = 0.15F;

// IEC 61966-2-1.
float decode_srgb(float value) {
    return value <= 0.04045F ? value / 12.92F : std::pow((value + 0.055F) / 1.055F, 2.4F);
}
float encode_srgb(float value) {
    return value <= 0.0031308F ? value * 12.92F : 1.055F * std::pow(value, 1 / 2.4F) - 0.055F;
}

std::uint8_t to_byte(float linear) {
    return static_cast<std::uint8_t>(std::lround(255 * encode_srgb(std::clamp(linear, 0.0F, 1.0F))));
}

} // namespace

Vec3f to_linear(const Colour& colour) {
    return {decode_srgb(colour.red), decode_srgb(colour.green), decode_srgb(colour.blue)};
}

std::array<std::uint8_t, 3> to_srgb8(const Vec3f& linear) {
    return {to_byte(linear.x), to_byte(linear.y), to_byte(linear.z)};
}

Vec3f compress_highlights(const Vec3f& linear) {
    const float peak = std::max({linear.x, linear.y, linear.z});
    if (peak <= kShoulderStart) return linear;
    constexpr float kRoom = 1 - kShoulderStart;
    const float new_peak = 1 - kRoom * kRoom / (peak + kRoom - kShoulderStart);
    const float paleness = 1 - 1 / (kDesaturation * (peak - new_peak) + 1);
    return linear * (new_peak / peak * (1 - paleness)) + Vec3f{1, 1, 1} * (new_peak * paleness);
}

} // namespace echinus
