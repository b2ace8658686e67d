#pragma once

#include "simulation/collisions.hpp"
#include "simulation/particles.hpp"
#include "simulation/surfaces/common_motion.hpp"
#include "simulation/surfaces/leading.hpp"
#include "simulation/surfaces/near_models.hpp"
#include "simulation/surfaces/self_surface.hpp"

#include <echinus/simulation.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace echinus {

/// Keeps the surface of a deformable, its faces and edges, from meeting models (docs/surfaces.md). In the
/// relaxations, as contacts; at the end of a frame by truncation: a vertex that could meet something on its
/// way goes only as far as is proven.
class SurfaceCollision {
  public:
    SurfaceCollision(const Deformable& deformable, const std::vector<Collider>& colliders,
                     const Particles& particles, const SimulationOptions& options);

    /// Particles so near to a collider go along with its surface where that deforms.
    float carry_reach(std::size_t collider) const { return carry_reaches_[collider]; }

    /// @param motions     [collider_count] how surfaces deform in this frame, null where they do not; they
    ///                    live as long as the frame
    /// @param collisions  of the particles with the same colliders, which know some distances already
    /// @param options     with the time step and the substeps of this frame
    void begin_frame(const std::vector<Collider>& colliders, std::span<const SurfaceMotion* const> motions,
                     const Collisions& collisions, const Particles& particles,
                     const SimulationOptions& options, const Workers& workers);
    /// After the first integration of a frame, before its colliders have moved.
    void look_ahead(const std::vector<Collider>& colliders, const Particles& particles,
                    const Workers& workers);
    void begin_substep(const std::vector<Collider>& colliders);
    /// @param meter  of the loads on the colliders, or null
    void relax(Particles& particles, SimulationProfile& profile, LoadMeter* meter);
    /// Only the contacts with models of chosen particles, [particle_count] 1.
    void relax_part(std::span<const std::uint8_t> chosen, Particles& particles, SimulationProfile& profile,
                    LoadMeter* meter);
    /// A collider that was away in this frame is not any more (BroadPhase), at the end of it.
    void meet_late(std::size_t collider, const Collider& at_end, const Particles& particles,
                   const Workers& workers);
    /// @param meter  has noted the velocities, or null
    void end_frame(Particles& particles, SimulationProfile& profile, LoadMeter* meter,
                   const Workers& workers);

    void archive(StateArchive& state);

  private:
    void keep_gaps(const std::vector<Collider>& colliders, const Particles& particles);
    bool pass(Particles& particles, bool is_first, const Workers& workers);
    void find_leaving(const PointArrays& places, const Workers& workers);
    void shorten_ways(bool is_first, const Particles& particles, const Workers& workers);
    Vec3f find_place(std::uint32_t vertex, bool is_first, const Particles& particles, const Workers& workers);
    bool has_one_frame() const;
    void find_bases(SelfSurface::Bases& bases, bool is_first, const Particles& particles,
                    const Workers& workers);
    void find_common_motion(PointArrays& places, const Particles& particles, const Workers& workers);
    bool goes_along(std::uint32_t vertex);
    bool join_stuck_pieces();
    void shorten_velocities(Particles& particles, SimulationProfile& profile, LoadMeter* meter);
    const ModelSurface* carrier() const;
    Vec3f base_of(std::uint32_t vertex, bool is_first, const Particles& particles, const Workers& workers);

    SimulationOptions options_;
    std::shared_ptr<const Elements> elements_;
    NearModels models_;
    std::vector<float> carry_reaches_; ///< by model
    std::vector<float> extents_; ///< by model, the deformable last: coordinates for which least gaps allow
    std::optional<SelfSurface> self_;
    std::optional<Leading> leading_; ///< always, once constructed
    CommonMotion common_motion_;
    std::vector<RigidTransform> poses_; ///< of the colliders, as of the last substep
    std::vector<float> inverse_masses_;
    /// Where one model is near, the deformable's own pairs are looked at in its frame, so that what it takes
    /// along rests.
    const RigidTransform* own_pose() const {
        return own_frame_ < models_.count() ? &poses_[own_frame_] : nullptr;
    }
    std::size_t own_frame_ = 0;               ///< a collider, or beyond the last: the world
    std::vector<RigidTransform> start_poses_; ///< of the colliders
    PointArrays expected_, goals_, ends_;
    PointArrays common_displacements_; ///< by vertex: with which its piece took it along in this frame, or 0
    std::vector<std::uint8_t> goes_along_;       ///< by piece: models permit its common motion to all of it
    std::vector<std::vector<float>> clearances_; ///< by model and vertex
    std::vector<std::uint32_t> leaving_;
    std::vector<std::uint8_t> is_leaving_, is_truncated_;
    std::vector<std::uint32_t> stopped_by_; ///< by vertex: the model beside which its way ended last
    std::uint64_t squeezed_now_ = 0;        ///< vertices without a place
};

} // namespace echinus
