#pragma once

#include "simulation/particles.hpp"

#include <echinus/simulation.hpp>

#include <cstdint>
#include <optional>
#include <vector>

namespace echinus {

/// How each piece of a deformable moves as a whole in a frame. What cannot go its way relative to its piece
/// still goes along with it: a crumple that stopped in the world would hang in the air.
class CommonMotion {
  public:
    explicit CommonMotion(const Deformable& deformable);

    /// @param goals  where the frame leads the particles, from where it began
    void measure(const Particles& particles, const PointArrays& goals);
    /// The mean way of the vertex' piece: 0 of one that is pinned somewhere, and none of one that is attached
    /// to a model, which goes along with that.
    std::optional<Vec3f> way_of(std::uint32_t vertex) const;
    /// The pieces have numbers, below the number of vertices.
    std::uint32_t piece_of(std::uint32_t vertex) const { return piece_of_[vertex]; }

  private:
    enum class Held : std::uint8_t { No, Pinned, Attached };

    struct Piece {
        Held held = Held::No;
        double count = 0;
        Vec3d sum{};
    };
    std::vector<std::uint32_t> piece_of_; ///< by vertex
    std::vector<Piece> pieces_;
};

} // namespace echinus
