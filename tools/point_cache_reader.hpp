#pragma once

#include "files/mapped_file.hpp"

#include <echinus/geometry.hpp>

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

/// Reads a PC2 point cache, as point_cache.hpp describes it. Positions are read when they are asked for.
class PointCacheReader {
  public:
    /// @throws echinus::Error Unreadable, WrongFormat, UnsupportedVersion or Damaged (also when the file is
    /// longer or shorter than its header says); the sentence begins with the path
    explicit PointCacheReader(const std::filesystem::path& path);

    std::size_t point_count() const { return point_count_; }
    std::size_t sample_count() const { return sample_count_; } ///< at least 1
    /// The frame at which a sample was taken.
    double frame_of(std::size_t sample) const {
        return start_frame_ + frames_per_sample_ * static_cast<double>(sample);
    }
    /// @pre sample < sample_count()
    /// @throws echinus::Error Damaged when a position is not finite
    std::vector<echinus::Vec3f> positions(std::size_t sample) const;

  private:
    std::string name_;
    echinus::MappedFile file_;
    std::size_t point_count_ = 0;
    std::size_t sample_count_ = 0;
    double start_frame_ = 0;
    double frames_per_sample_ = 1;
};
