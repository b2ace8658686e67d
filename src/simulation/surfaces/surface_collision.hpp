#pragma once

#include "simulation/collisions.hpp"
#include "simulation/particles.hpp"
#include "simulation/surfaces/model_surface.hpp"
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

    /// @param collisions  of the particles with the same colliders, which know some distances already
    void begin_frame(const std::vector<Collider>& colliders, const Collisions& collisions,
                     const Particles& particles);
    /// After the first integration of a frame, before its colliders have moved.
    void look_ahead(const std::vector<Collider>& colliders, const Particles& particles);
    void begin_substep(const std::vector<Collider>& colliders);
    void relax(Particles& particles, SimulationProfile& profile);
    /// Only the contacts with models of chosen particles, [particle_count] 1.
    void relax_part(std::span<const std::uint8_t> chosen, Particles& particles, SimulationProfile& profile);
    void end_frame(Particles& particles, SimulationProfile& profile);

  private:
    void keep_gaps(const std::vector<Collider>& colliders, const Particles& particles);
    bool pass(Particles& particles, bool is_first);
    void find_leaving();
    void shorten_ways(bool is_first, const Particles& particles);
    Vec3f find_place(std::uint32_t vertex, bool is_first, const Particles& particles);

    SimulationOptions options_;
    std::shared_ptr<const Elements> elements_;
    std::vector<ModelSurface> models_;
    std::vector<float> extents_; ///< by model, the deformable last: coordinates for which least gaps allow
    std::optional<SelfSurface> self_;
    std::vector<RigidTransform> poses_; ///< of the colliders, as of the last substep
    std::vector<float> inverse_masses_;
    const ModelSurface* carrier() const { return carrier_ < models_.size() ? &models_[carrier_] : nullptr; }
    const RigidTransform* carrier_pose() const { return carrier() != nullptr ? &poses_[carrier_] : nullptr; }
    std::size_t carrier_ = 0; ///< the first collider that moves; beyond the last where none does
    PointArrays expected_, goals_, ends_;
    std::vector<std::vector<float>> clearances_; ///< by model and vertex
    std::vector<std::uint32_t> leaving_;
    std::vector<std::uint8_t> is_leaving_, is_truncated_;
    std::uint64_t squeezed_now_ = 0; ///< vertices without a place
};

} // namespace echinus
