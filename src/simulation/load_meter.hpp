#pragma once

#include "simulation/particles.hpp"
#include "simulation/state/state_archive.hpp"

#include <echinus/simulation.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace echinus {

/// Adds up what the colliders give to the particles: of each push the change of momentum, and of that
/// momentum the moment. What a collider bears is the opposite.
class LoadMeter {
  public:
    /// @pre the deformable is valid
    LoadMeter(const Deformable& deformable, std::size_t collider_count);

    /// A frame begins, in which the colliders stand here.
    void begin_frame(const std::vector<Collider>& colliders);
    /// Takes note of all velocities.
    void note(const Particles& particles);
    /// What has changed since note() was a collider's doing.
    void charge(std::size_t collider, const Particles& particles);
    /// The same of one particle.
    void charge(std::size_t collider, std::uint32_t particle, const Particles& particles);
    /// It was the doing of sticks and folds. What they give to all particles together came from those that
    /// are held, and is charged to the collider that holds them all.
    void charge_holder(const Particles& particles) {
        if (holder_) charge(*holder_, particles);
    }

    /// What was charged were changes of velocity in substeps; now they are of substeps so many times as long.
    void scale(double factor) {
        for (Sum& sum : sums_) sum = {sum.motion * factor, sum.moment * factor};
    }
    /// Of the frame that has ended.
    /// @param time_step, substep_seconds  of a frame and of a substep
    Load load_on(std::size_t collider, double time_step, double substep_seconds) const;

    void archive(StateArchive& state);

  private:
    struct Sum {
        Vec3d motion, moment; ///< mass times way in a substep; moments about the collider's translation
    };

    std::vector<double> masses_; ///< 0 of a pinned particle
    std::optional<std::size_t> holder_;
    std::vector<Vec3d> centres_;
    std::vector<Sum> sums_; ///< by collider, given to the particles
    PointArrays noted_;     ///< ways in a substep
};

} // namespace echinus
