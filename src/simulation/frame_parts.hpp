#pragma once

#include "simulation/collisions.hpp"
#include "simulation/particles.hpp"

#include <echinus/simulation.hpp>

#include <cstdint>
#include <vector>

namespace echinus {

/// Into how many equal parts a frame is divided, which are computed as frames of their own.
///
/// Contact keeps layers apart along planes that it finds when a frame begins. Where vertices go farther than
/// an edge is long, relative to each other or to a model that they may reach, it knows too little of where
/// they will meet: truncation stops them wherever they are, and leaves knots that nothing opens again. So in
/// a part they go no farther than that, as the frame begins. What moves as a whole, however fast, takes whole
/// frames.
class FrameParts {
  public:
    /// @param options  with the solver, the time step and the substeps of an undivided frame
    FrameParts(const Deformable& deformable, const SimulationOptions& options);

    /// Of the frame that begins.
    /// @param collisions  have begun it as one that is not divided
    std::uint32_t count(const std::vector<Collider>& colliders, const Collisions& collisions,
                        const Particles& particles);
    SimulationOptions options_of_part(std::uint32_t count) const;

  private:
    Vec3f mean_way(const Particles& particles) const;
    double longest_less(const Vec3f& common, const Particles& particles) const;
    double longest_beside(const Collider& collider, double most, const Particles& particles);

    SimulationOptions options_;
    double edge_length_; ///< the mean
    // Of a model
    std::vector<float> clearances_; ///< [particle_count]
    std::vector<Vec3f> places_;     ///< that may reach it in the frame
    std::vector<float> ways_;
    std::vector<Contact> contacts_;
};

} // namespace echinus
