#pragma once

#include "geometry/union_find.hpp"
#include "simulation/particles.hpp"

#include <echinus/simulation.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace echinus {

/// How each connected piece of a deformable moves as a whole in a frame. Layers that hold each other back
/// still go along with their piece: if they stopped in the world, a crumpled cloth would hang in the air.
class CommonMotion {
  public:
    explicit CommonMotion(const Deformable& deformable);

    /// @param goals  where the frame leads the particles from where they began
    void measure(const Particles& particles, const PointArrays& goals);
    /// From now on in this frame, the pieces of these vertices count as one. @return whether they did not
    /// before
    bool join(std::span<const std::uint32_t> vertices);

    /// The least vertex of the piece that a vertex belongs to.
    std::uint32_t piece_of(std::uint32_t vertex) { return joined_.find(vertex); }
    /// The displacement of a piece: that of its centre of mass, or the one of all of its pinned vertices,
    /// which hold it; none if these differ.
    std::optional<Vec3f> displacement_of(std::uint32_t piece) const;

    /// The velocity that truncation takes from vertices is lost to their piece, unless it is held.
    void begin_losses();
    void lose(std::uint32_t vertex, const Vec3f& velocity);
    /// By how much the vertex' piece has become slower: 0 for one that is held.
    Vec3f loss_of(std::uint32_t vertex);

  private:
    struct Piece {
        double mass = 0;
        Vec3d momentum{}, lost_momentum{};
        bool is_held = false, is_pulled_apart = false;
        Vec3f held{}; ///< the displacement of its pinned vertices
        void add(const Piece& other);
    };

    UnionFind connected_, joined_;
    std::vector<Piece> pieces_;  ///< by their least vertices
    std::vector<double> masses_; ///< by vertex, 0 of one that is pinned
};

} // namespace echinus
