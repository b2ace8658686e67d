#include "mesh_io/point_cache.hpp"

#include <echinus/error.hpp>

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <string_view>

namespace echinus {

namespace {

struct Header {
    char signature[12] = {'P', 'O', 'I', 'N', 'T', 'C', 'A', 'C', 'H', 'E', '2', '\0'};
    std::int32_t version = 1;
    std::int32_t point_count = 0;
    float start_frame = 0;
    float frames_per_sample = 1;
    std::int32_t sample_count = 0; // known at the end
};
static_assert(sizeof(Vec3f) == 3 * sizeof(float), "positions are in memory as they are in the file");
static_assert(std::endian::native == std::endian::little, "and so are numbers");

constexpr std::string_view kSignature{"POINTCACHE2\0", 12};
constexpr std::size_t kHeaderSize = sizeof(Header);
static_assert(kHeaderSize == 32);

template <typename T>
T number_at(std::span<const std::byte> bytes, std::size_t offset) {
    T value;
    std::memcpy(&value, bytes.data() + offset, sizeof(T));
    return value;
}

[[noreturn]] void fail(ErrorCode code, const std::string& name, const std::string& finding) {
    throw Error(code, name + ": " + finding);
}

void require_header(std::span<const std::byte> bytes, const std::string& name) {
    if (bytes.size() < kSignature.size() ||
        std::memcmp(bytes.data(), kSignature.data(), kSignature.size()) != 0)
        fail(ErrorCode::WrongFormat, name, "not a PC2 point cache: it does not begin with POINTCACHE2");
    if (bytes.size() < kHeaderSize)
        fail(ErrorCode::Damaged, name,
             "the file ends at byte " + std::to_string(bytes.size()) +
                 ", within the header of 32 bytes; write it again");
    if (const auto version = number_at<std::int32_t>(bytes, 12); version != 1)
        fail(ErrorCode::UnsupportedVersion, name,
             "version " + std::to_string(version) + " of the format; version 1 is the one that is read");
}

/// A count of the header, which must be positive.
std::size_t count_at(std::span<const std::byte> bytes, std::size_t offset, const std::string& name,
                     const char* what) {
    const auto count = number_at<std::int32_t>(bytes, offset);
    if (count < 1) fail(ErrorCode::Damaged, name, "the header says " + std::to_string(count) + " " + what);
    return static_cast<std::size_t>(count);
}

} // namespace

PointCacheWriter::PointCacheWriter(const std::filesystem::path& path, std::size_t point_count,
                                   std::uint32_t frames_per_sample)
    : file_(path) {
    Header header;
    header.point_count = static_cast<std::int32_t>(point_count);
    header.frames_per_sample = static_cast<float>(frames_per_sample);
    file_.write(&header, sizeof(header));
}

void PointCacheWriter::add(std::span<const Vec3f> positions) {
    file_.write(positions.data(), positions.size_bytes());
    ++sample_count_;
}

void PointCacheWriter::commit() {
    file_.overwrite(offsetof(Header, sample_count), &sample_count_, sizeof(sample_count_));
    file_.commit();
}

PointCacheReader::PointCacheReader(const std::filesystem::path& path) : name_(path.string()), file_(path) {
    std::array<std::byte, kHeaderSize> header{};
    const std::span<const std::byte> bytes(header.data(), file_.read(0, header));
    require_header(bytes, name_);
    point_count_ = count_at(bytes, 16, name_, "points");
    start_frame_ = number_at<float>(bytes, 20);
    frames_per_sample_ = number_at<float>(bytes, 24);
    sample_count_ = count_at(bytes, 28, name_, "samples");
    if (!std::isfinite(start_frame_) || !std::isfinite(frames_per_sample_) || frames_per_sample_ <= 0)
        fail(ErrorCode::Damaged, name_, "the header's start frame and frames per sample are not valid");
    // At most 32 + 12 * 2^31 * 2^31, which a 64-bit size holds.
    const std::uint64_t expected = kHeaderSize + std::uint64_t{12} * point_count_ * sample_count_;
    if (file_.size() != expected)
        fail(ErrorCode::Damaged, name_,
             "has " + std::to_string(file_.size()) + " bytes, but " + std::to_string(sample_count_) +
                 " samples of " + std::to_string(point_count_) + " points take " + std::to_string(expected) +
                 "; write it again");
}

std::vector<Vec3f> PointCacheReader::positions(std::size_t sample) const {
    std::vector<Vec3f> points(point_count_);
    const std::size_t byte_count = sizeof(Vec3f) * point_count_;
    if (file_.read(kHeaderSize + byte_count * sample, std::as_writable_bytes(std::span(points))) !=
        byte_count)
        fail(ErrorCode::Damaged, name_,
             "was shortened while it was read: sample " + std::to_string(sample) + " is missing");
    for (std::size_t i = 0; i < points.size(); ++i)
        if (!is_finite(points[i]))
            fail(ErrorCode::Damaged, name_,
                 "point " + std::to_string(i) + " of sample " + std::to_string(sample) + " is not finite");
    return points;
}

} // namespace echinus
