#include "render/image.hpp"

#include <echinus/error.hpp>

namespace echinus {

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

} // namespace echinus
