#pragma once

#include "simulation/particles.hpp"
#include "simulation/state/state_archive.hpp"

#include <echinus/collider.hpp>
#include <echinus/exact_map.hpp>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace echinus {

/// How the surface of a collider deforms in a frame: each of its vertices moves straight in the body frame
/// (the collider's frame with its scale applied), independently of the motion of the collider itself.
struct SurfaceMotion {
    PointArrays from, to; ///< [vertex_count of the model]
    /// The positions of the vertices after a share of the frame.
    PointArrays at(float share) const {
        PointArrays places = to;
        if (share == 1) return places;
        for (std::size_t v = 0; v < places.x.size(); ++v) places.set(v, from[v] + (to[v] - from[v]) * share);
        return places;
    }
};

/// The shares of a triangle's corners in the point of the triangle that is nearest to a point in its plane.
std::array<float, 3> shares_in(const std::array<Vec3f, 3>& corners, const Vec3f& point);

/// A collider whose surface deforms: an exact map for each frame, and the motion from each frame to the next.
class DeformingCollider {
  public:
    /// @param map   the map of the present surface
    /// @param name  the collider's name, for errors
    DeformingCollider(const ExactMap& map, std::string name);
    DeformingCollider(const DeformingCollider& other);
    DeformingCollider& operator=(const DeformingCollider&) = delete;

    /// The next frame leads the vertices to these positions.
    /// @throws Error InvalidOptions for a different number of vertices, or the errors of
    /// ExactMapBuilder::rebuild(); then nothing has changed
    void lead_to(std::span<const Vec3f> vertices_local);
    /// Makes the vertices follow a cache from the next frame on. @throws Error InvalidOptions
    void follow(VertexCache cache);

    /// Builds the map for the end of the next frame if the collider follows a cache and that map has not been
    /// built yet. Another thread may do so while a frame is computed.
    /// @param end_time  the end of the next frame, in seconds since the simulation began
    /// @throws Error the errors of ExactMapBuilder::rebuild() for the cache's vertices; then nothing has
    /// changed
    void build_ahead(double end_time);
    /// Gives the collider the map of the frame's end, for which build_ahead() was called.
    void begin_frame(Collider& collider);
    /// The map of the surface before it deformed.
    const ExactMap& first_map() const { return first_map_; }
    /// Reading gives the collider the map of the surface that was saved.
    void archive(StateArchive& state, Collider& collider);

    /// The motion in this frame, or null if the surface does not deform.
    const SurfaceMotion* motion() const { return deforms_ ? &motion_ : nullptr; }

    /// In the order of the mesh.
    const std::vector<Triangle>& faces() const { return *faces_; }
    /// At the end of this frame, in local coordinates.
    const std::vector<Vec3f>& vertices() const { return vertices_; }
    /// The corners of a face at the end of this frame, in the body frame.
    std::array<Vec3f, 3> corners(const Triangle& face, const Vec3d& scale) const;
    /// Whether the last sample has been reached.
    bool has_arrived(double time) const;

  private:
    ExactMap built_of(std::span<const Vec3f> vertices);
    ExactMap archived_map(const StateArchive& state, std::span<const Vec3f> vertices);
    template <typename Build>
    ExactMap naming_it(const std::string& vertices, const Build& build) const;
    void find_motion(const Collider& collider);

    std::string name_;
    ExactMap first_map_;
    bool has_deformed_ = false; ///< whether the collider has a different map
    std::shared_ptr<const std::vector<Triangle>> faces_;
    ExactMapOptions options_;
    /// They take turns: one builds while the map of the other is in use, so that both can reuse their memory.
    std::array<std::optional<ExactMapBuilder>, 2> builders_;
    std::size_t turn_ = 0;
    std::vector<Vec3f> vertices_;
    std::optional<VertexCache> cache_;
    std::uint64_t cache_hash_ = 0;
    std::vector<Vec3f> next_vertices_;
    std::optional<ExactMap> next_map_;
    std::vector<Vec3f> prepared_vertices_;
    std::optional<ExactMap> prepared_map_; ///< for prepared_vertices_
    bool deforms_ = false;
    SurfaceMotion motion_;
};

} // namespace echinus
