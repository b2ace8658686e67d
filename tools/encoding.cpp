#include "encoding.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <new>
#include <string_view>
#include <utility>

Deflater::Deflater() {
    constexpr int kWindowBits = 15, kMemoryLevel = 9;
    // The arguments are constants, so only memory can fail.
    if (deflateInit2(&stream_, Z_DEFAULT_COMPRESSION, Z_DEFLATED, kWindowBits, kMemoryLevel, Z_RLE) != Z_OK)
        throw std::bad_alloc();
}

Deflater::~Deflater() {
    deflateEnd(&stream_);
}

void Deflater::add(std::span<const std::uint8_t> bytes) {
    while (!bytes.empty()) {
        const std::size_t count = std::min<std::size_t>(bytes.size(), std::numeric_limits<uInt>::max());
        stream_.next_in = const_cast<std::uint8_t*>(bytes.data()); // zlib only reads
        stream_.avail_in = static_cast<uInt>(count);
        run(Z_NO_FLUSH);
        bytes = bytes.subspan(count);
    }
}

std::vector<std::uint8_t> Deflater::finish() {
    run(Z_FINISH);
    return std::move(compressed_);
}

void Deflater::run(int flush) {
    std::array<std::uint8_t, 1 << 16> buffer;
    do {
        stream_.next_out = buffer.data();
        stream_.avail_out = static_cast<uInt>(buffer.size());
        deflate(&stream_, flush);
        compressed_.insert(compressed_.end(), buffer.data(), stream_.next_out);
    } while (stream_.avail_out == 0);
}

std::string base64(std::span<const std::uint8_t> bytes) {
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k) group = group << 8U | (k < count ? bytes[i + k] : 0U);
        for (std::size_t k = 0; k < 4; ++k) text += k <= count ? kDigits[group >> (18 - 6 * k) & 63U] : '=';
    }
    return text;
}
