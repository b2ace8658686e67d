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
    /// @param frames_per_sample  how many frames lie between two samples; the first is frame 0
    /// @throws Error Unwritable, as all members
    PointCacheWriter(const std::filesystem::path& path, std::size_t point_count,
                     std::uint32_t frames_per_sample);

    void add(std::span<const Vec3f> positions);
    void commit();

  private:
    AtomicFile file_;
    std::int32_t sample_count_ = 0;
};

/// Reads a PC2 point cache, as PointCacheWriter writes it. Positions are read when they are asked for, since
/// a cache may be larger than memory; from several threads at once, too.
class PointCacheReader {
  public:
    /// @throws Error Unreadable, WrongFormat, UnsupportedVersion or Damaged (also when the file is
    /// longer or shorter than its header says); the sentence begins with the path
    explicit PointCacheReader(const std::filesystem::path& path);

    std::size_t point_count() const { return point_count_; }
    std::size_t sample_count() const { return sample_count_; } ///< at least 1
    /// The frame at which a sample was taken.
    double frame_of(std::size_t sample) const {
        return start_frame_ + frames_per_sample_ * static_cast<double>(sample);
    }
    /// @pre sample < sample_count()
    /// @throws Error Damaged when a position is not finite, or the file was shortened; Unreadable
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
