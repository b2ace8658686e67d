#pragma once

#include "recording/point_cache.hpp"

#include <echinus/mesh_io.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// The output folder of `echinus simulate SCENE -o DIR`: cloth.obj, cloth.pc2, report.json and the collider's
/// mesh. A *sample* is a moment whose positions were saved.
class SimulationFolder {
  public:
    /// @throws echinus::Error Unreadable, WrongFormat, Damaged ...; the sentence begins with the path of the
    /// file at fault
    explicit SimulationFolder(const std::filesystem::path& folder);

    std::size_t sample_count() const { return cache_.sample_count(); }
    double frame_of(std::size_t sample) const { return cache_.frame_of(sample); }
    /// The sample taken at a frame, or else nearest to it.
    /// @throws echinus::Error InvalidOptions when no sample lies within half the distance of two samples
    std::size_t sample_at(std::int64_t frame) const;

    std::vector<echinus::Vec3f> cloth_positions(std::size_t sample) const { return cache_.positions(sample); }
    echinus::MeshAndEdges cloth(std::size_t sample) const;
    /// In the world, at its pose in that sample.
    echinus::TriangleMesh collider(std::size_t sample) const;

    /// Against gravity; +z where there is none.
    const echinus::Vec3d& up() const { return up_; }
    /// The frame at which the cloth came to rest, if it did.
    const std::optional<double>& rest_frame() const { return rest_frame_; }

  private:
    struct Pose {
        double frame = 0;
        echinus::RigidTransform transform;
    };

    void read_report(const std::filesystem::path& path);

    PointCacheReader cache_;
    echinus::MeshAndEdges cloth_;
    echinus::TriangleMesh collider_;
    std::vector<Pose> poses_; ///< ascending frames, at least one
    echinus::Vec3d up_;
    std::optional<double> rest_frame_;
};

/// Up to `count` samples, ascending: the last, the first, and then one by one that in which the cloth differs
/// most from all those chosen before.
std::vector<std::size_t> choose_moments(const SimulationFolder& folder, std::size_t count);
