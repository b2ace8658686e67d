#pragma once

#include "mesh_io/point_cache.hpp"

#include <echinus/intersections.hpp>
#include <echinus/mesh_io.hpp>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// A collider in a folder of results.
struct SavedCollider {
    struct Pose {
        double frame = 0;
        echinus::RigidTransform transform;
    };

    echinus::TriangleMesh mesh;
    std::vector<Pose> poses; ///< ascending frames, at least one
    /// The cache of its vertices, with as many samples as the cloth's; null if it does not deform.
    std::shared_ptr<const echinus::PointCacheReader> cache;
    /// [particle_count of the cloth] 1 for the particles that it lets through, or empty.
    std::vector<std::uint8_t> passes;
};

/// The output folder of `echinus simulate SCENE -o DIR`: cloth.obj, cloth.pc2, report.json and the collider's
/// mesh. A *sample* is a moment whose positions were saved.
class SimulationFolder {
  public:
    /// @throws echinus::Error Unreadable, WrongFormat, Damaged ...; the sentence begins with the path of the
    /// file at fault
    explicit SimulationFolder(const std::filesystem::path& folder);

    std::size_t sample_count() const { return cache_.sample_count(); }
    double frame_of(std::size_t sample) const { return cache_.frame_of(sample); }
    /// The sample taken at a frame, or the nearest one.
    /// @throws echinus::Error InvalidOptions if no sample is within half the distance between two samples
    std::size_t sample_at(std::int64_t frame) const;

    std::vector<echinus::Vec3f> cloth_positions(std::size_t sample) const { return cache_.positions(sample); }
    echinus::MeshAndEdges cloth(std::size_t sample) const;
    /// All colliders as one mesh, in the world, at their poses in that sample.
    echinus::TriangleMesh colliders(std::size_t sample) const;
    /// Drops the pairs of a face of the cloth's surface and one of colliders() that need not be kept apart.
    void drop_let_through(const std::vector<echinus::Triangle>& surface,
                          std::vector<echinus::FacePair>& pairs) const;

    /// The direction against gravity; +z if there is none.
    const echinus::Vec3d& up() const { return up_; }
    /// The frame at which the cloth came to rest, if it did.
    const std::optional<double>& rest_frame() const { return rest_frame_; }

  private:
    void read_report(const std::filesystem::path& path);

    echinus::PointCacheReader cache_;
    echinus::MeshAndEdges cloth_;
    std::vector<SavedCollider> colliders_;
    echinus::Vec3d up_;
    std::optional<double> rest_frame_;
};

/// Up to `count` samples, ascending: the last, the first, and then one by one that in which the cloth differs
/// most from all those chosen before.
std::vector<std::size_t> choose_moments(const SimulationFolder& folder, std::size_t count);
