#include "point_cache.hpp"

#include <bit>
#include <cstddef>

namespace {

struct Header {
    char signature[12] = {'P', 'O', 'I', 'N', 'T', 'C', 'A', 'C', 'H', 'E', '2', '\0'};
    std::int32_t version = 1;
    std::int32_t point_count = 0;
    float start_frame = 0;
    float frames_per_sample = 1;
    std::int32_t sample_count = 0; // known at the end
};
static_assert(sizeof(Header) == 32);
static_assert(sizeof(echinus::Vec3f) == 3 * sizeof(float), "positions are written as they lie in memory");
static_assert(std::endian::native == std::endian::little, "and so are numbers");

} // namespace

PointCacheWriter::PointCacheWriter(const std::filesystem::path& path, std::size_t point_count,
                                   std::uint32_t frames_per_sample)
    : file_(path) {
    Header header;
    header.point_count = static_cast<std::int32_t>(point_count);
    header.frames_per_sample = static_cast<float>(frames_per_sample);
    file_.write(&header, sizeof(header));
}

void PointCacheWriter::add(std::span<const echinus::Vec3f> positions) {
    file_.write(positions.data(), positions.size_bytes());
    ++sample_count_;
}

void PointCacheWriter::commit() {
    file_.overwrite(offsetof(Header, sample_count), &sample_count_, sizeof(sample_count_));
    file_.commit();
}
