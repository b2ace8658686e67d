#include "render/image.hpp"

#include "files/atomic_file.hpp"

#include <echinus/error.hpp>
#include <echinus_render/render.hpp>

#include <png.h>

#include <algorithm>
#include <cmath>

namespace echinus::render {

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

std::string size_text(std::uint64_t width, std::uint64_t height) {
    return std::to_string(width) + " x " + std::to_string(height) + " pixels";
}

void require_drawable(std::uint64_t width, std::uint64_t height) {
    const auto side_ok = [](std::uint64_t side) { return side >= 1 && side <= RenderOptions::kMaxSide; };
    if (side_ok(width) && side_ok(height) && width * height <= RenderOptions::kMaxPixelCount) return;
    throw Error(ErrorCode::InvalidOptions,
                "a picture of " + size_text(width, height) + " cannot be drawn: sides must be 1 to " +
                    std::to_string(RenderOptions::kMaxSide) + " pixels, and " +
                    std::to_string(RenderOptions::kMaxPixelCount) + " pixels at most in all");
}

void require_consistent(const Image& image) {
    const std::size_t expected = std::size_t{3} * image.width * image.height;
    if (expected != 0 && image.rgb.size() == expected) return;
    throw Error(ErrorCode::InvalidOptions,
                "a picture of " + size_text(image.width, image.height) + " has " +
                    std::to_string(image.rgb.size()) +
                    " bytes of colour; it must have 3 for each pixel, and at least one pixel");
}

std::vector<std::uint8_t> encode_png(const Image& image) {
    require_consistent(image);
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    header.width = image.width;
    header.height = image.height;
    header.format = PNG_FORMAT_RGB;
    std::vector<std::uint8_t> bytes(PNG_IMAGE_PNG_SIZE_MAX(header));
    png_alloc_size_t byte_count = bytes.size();
    if (png_image_write_to_memory(&header, bytes.data(), &byte_count, 0, image.rgb.data(), 0, nullptr) == 0) {
        throw Error(ErrorCode::InvalidOptions,
                    std::string("libpng cannot encode the picture: ") + header.message);
    }
    bytes.resize(byte_count);
    return bytes;
}

void write_png(const std::filesystem::path& path, const Image& image) {
    const std::vector<std::uint8_t> bytes = encode_png(image);
    AtomicFile file(path);
    file.write(bytes.data(), bytes.size());
    file.commit();
}

} // namespace echinus::render
