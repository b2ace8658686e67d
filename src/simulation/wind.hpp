#pragma once

#include "simulation/particles.hpp"

#include <echinus/simulation.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// Wind as a change of velocity between frames.
class Wind {
  public:
    /// Gives each particle a share of the wind's velocity across the faces around it, as seen from the
    /// particle: the mean over these faces.
    /// @param wind_step  how far the air moves in one frame
    void blow(std::span<const Triangle> faces, const Vec3f& wind_step, float share, Particles& particles);

  private:
    /// The motion that the faces around a particle would give it.
    struct Gust {
        Vec3f sum;
        std::uint32_t face_count = 0;

        void add(const Vec3f& across) {
            sum += across;
            ++face_count;
        }
        Vec3f mean() const { return sum * (1 / static_cast<float>(face_count)); }
    };

    std::vector<Gust> gusts_; ///< of each particle
};

} // namespace echinus
