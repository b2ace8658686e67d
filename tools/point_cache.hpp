#pragma once

#include "files/atomic_file.hpp"

#include <echinus/geometry.hpp>

#include <cstdint>
#include <filesystem>
#include <span>

/// Writes a PC2 point cache, which Blender, Houdini and Maya read: a header of 32 bytes ("POINTCACHE2\0",
/// int32 version 1, int32 point count, float32 start frame, float32 frames per sample, int32 sample count),
/// then for every sample the positions of all points as float32 x y z, all little-endian.
class PointCacheWriter {
  public:
    /// @param frames_per_sample  how many frames lie between two samples; the first is frame 0
    /// @throws echinus::Error Unwritable, as all members
    PointCacheWriter(const std::filesystem::path& path, std::size_t point_count,
                     std::uint32_t frames_per_sample);

    void add(std::span<const echinus::Vec3f> positions);
    void commit();

  private:
    echinus::AtomicFile file_;
    std::int32_t sample_count_ = 0;
};
