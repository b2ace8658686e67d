#pragma once

#include "files/atomic_file.hpp"
#include "files/read_file.hpp"

#include <echinus/geometry.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace echinus {

/// Writes a PC2 point cache, which Blender, Houdini and Maya read: a header of 32 bytes ("POINTCACHE2\0",
/// int32 version 1, int32 point count, float32 start frame, float32 frames per sample, int32 sample count),
/// then for every sample the positions of all points as float32 x y z, all little-endian.
class PointCacheWriter {
  public:
    /// @param frames_per_sample  the number of frames from one sample to the next; the first sample is frame
    /// 0
    /// @throws Error Unwritable, as all members do
    PointCacheWriter(const std::filesystem::path& path, std::size_t point_count,
                     std::uint32_t frames_per_sample);

    void add(std::span<const Vec3f> positions);
    void commit();

  private:
    AtomicFile file_;
    std::int32_t sample_count_ = 0;
};

/// Reads a PC2 point cache in the form that PointCacheWriter writes. Positions are read on request, since a
/// cache may be larger than memory; several threads may do so at once.
class PointCacheReader {
  public:
    /// @throws Error Unreadable, WrongFormat, UnsupportedVersion or Damaged (also if the size of the file
    /// does not match its header); the sentence begins with the path
    explicit PointCacheReader(const std::filesystem::path& path);

    std::size_t point_count() const { return point_count_; }
    std::size_t sample_count() const { return sample_count_; } ///< at least 1
    /// The frame at which a sample was taken.
    double frame_of(std::size_t sample) const {
        return start_frame_ + frames_per_sample_ * static_cast<double>(sample);
    }
    /// @pre sample < sample_count()
    /// @throws Error Unreadable, or Damaged if a position is not finite or the file was shortened
    std::vector<Vec3f> positions(std::size_t sample) const;

  private:
    std::string name_;
    RandomAccessFile file_;
    std::size_t point_count_ = 0;
    std::size_t sample_count_ = 0;
    double start_frame_ = 0;
    double frames_per_sample_ = 1;
};

} // namespace echinus
