#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// The particles of constraints that all have the same number of them.
class ConstraintParticles {
  public:
    /// @param particles_of  gives the particles of the constraint of a number, as an array
    template <typename ParticlesOf>
    ConstraintParticles(std::size_t count, std::size_t particle_count, const ParticlesOf& particles_of)
        : count_(count), particle_count_(particle_count) {
        for (std::size_t i = 0; i < count; ++i)
            for (const std::uint32_t particle : particles_of(i)) all_.push_back(particle);
    }

    std::size_t count() const { return count_; }
    std::size_t particle_count() const { return particle_count_; } ///< of the deformable
    std::span<const std::uint32_t> of(std::size_t constraint) const {
        const std::size_t each = all_.size() / count_;
        return std::span(all_).subspan(constraint * each, each);
    }

  private:
    std::size_t count_, particle_count_;
    std::vector<std::uint32_t> all_;
};

} // namespace echinus
