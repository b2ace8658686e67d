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

/// How the surface of a collider deforms in a frame: each of its vertices goes straight, in the body frame
/// (the collider's frame with its scale applied), whatever the collider itself does meanwhile.
struct SurfaceMotion {
    PointArrays from, to; ///< [vertex_count of the model]
    /// Where vertices are when a share of the frame is over.
    PointArrays at(float share) const {
        PointArrays places = to;
        if (share == 1) return places;
        for (std::size_t v = 0; v < places.x.size(); ++v) places.set(v, from[v] + (to[v] - from[v]) * share);
        return places;
    }
};

/// Shares of a triangle's corners in the point of it that is nearest to one in its plane.
std::array<float, 3> shares_in(const std::array<Vec3f, 3>& corners, const Vec3f& point);

/// A collider whose surface deforms: an exact map for each frame, and the way from one to the next.
class DeformingCollider {
  public:
    /// @param map   of the surface as it is
    /// @param name  of the collider, for errors
    DeformingCollider(const ExactMap& map, std::string name);
    DeformingCollider(const DeformingCollider& other);
    DeformingCollider& operator=(const DeformingCollider&) = delete;

    /// The next frame leads the vertices there.
    /// @throws Error InvalidOptions for another number of vertices, or as ExactMapBuilder::rebuild(); then
    /// nothing has changed
    void lead_to(std::span<const Vec3f> vertices_local);
    /// Along a cache, from the next frame on. @throws Error InvalidOptions
    void follow(VertexCache cache);

    /// Builds the map of the next frame's end if the collider follows a cache there and the map has not been
    /// built yet. Another thread may do so while a frame is computed.
    /// @param end_time  when the next frame ends, seconds since the simulation began
    /// @throws Error as ExactMapBuilder::rebuild() of the cache's vertices; then nothing has changed
    void build_ahead(double end_time);
    /// Gives the collider the map of the frame's end, for which build_ahead() was called.
    void begin_frame(Collider& collider);
    /// As it was before it deformed.
    const ExactMap& first_map() const { return first_map_; }
    /// Reading gives the collider the map of the surface as it is.
    void archive(StateArchive& state, Collider& collider);

    /// In this frame, or null: the surface does not deform.
    const SurfaceMotion* motion() const { return deforms_ ? &motion_ : nullptr; }

    /// In the mesh's order.
    const std::vector<Triangle>& faces() const { return *faces_; }
    /// At the end of this frame, local.
    const std::vector<Vec3f>& vertices() const { return vertices_; }
    /// Of a face at the end of this frame, in the body frame.
    std::array<Vec3f, 3> corners(const Triangle& face, const Vec3d& scale) const;
    /// Has it come to the last sample?
    bool has_arrived(double time) const;

  private:
    ExactMap built_of(std::span<const Vec3f> vertices);
    ExactMap archived_map(const StateArchive& state, std::span<const Vec3f> vertices);
    template <typename Build>
    ExactMap naming_it(const std::string& vertices, const Build& build) const;
    void find_motion(const Collider& collider);

    std::string name_;
    ExactMap first_map_;
    bool has_deformed_ = false; ///< the collider has another map
    std::shared_ptr<const std::vector<Triangle>> faces_;
    ExactMapOptions options_;
    /// They take turns: the one builds while the other's map is in use, so that both use their memory again.
    std::array<std::optional<ExactMapBuilder>, 2> builders_;
    std::size_t turn_ = 0;
    std::vector<Vec3f> vertices_;
    std::optional<VertexCache> cache_;
    std::uint64_t cache_hash_ = 0;
    std::vector<Vec3f> next_vertices_;
    std::optional<ExactMap> next_map_;
    std::vector<Vec3f> prepared_vertices_;
    std::optional<ExactMap> prepared_map_; ///< of these
    bool deforms_ = false;
    SurfaceMotion motion_;
};

} // namespace echinus
