#include "files/atomic_file.hpp"
#include "render/image.hpp"

#include <echinus/error.hpp>
#include <echinus/render.hpp>

#include <png.h>

namespace echinus {

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

} // namespace echinus
