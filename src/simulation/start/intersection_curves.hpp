#pragma once

#include "simulation/surfaces/elements.hpp"

#include <echinus/geometry.hpp>
#include <echinus/intersections.hpp>

#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// An edge that passes through a face.
struct Crossing {
    std::uint32_t edge, face;

    friend auto operator<=>(const Crossing&, const Crossing&) = default;
};

/// The crossings of a surface with itself, by the curves of intersection on which they lie.
/// @param pairs  the intersecting pairs of elements
std::vector<std::vector<Crossing>> intersection_curves(const Elements& elements,
                                                       std::span<const Vec3f> positions,
                                                       std::span<const FacePair> pairs);

/// The pieces into which a curve of intersection cuts a surface.
class CutPieces {
  public:
    explicit CutPieces(const Elements& elements);

    /// Cuts the edges of a curve, and undoes the previous cut. The cost is proportional to all pieces but the
    /// largest.
    void cut(std::span<const Crossing> curve);
    /// The number of vertices in the piece of a vertex; that of all vertices for a piece that is connected
    /// with the largest one. @pre the vertex is an end of an edge of the curve
    std::size_t size_at(std::uint32_t vertex);

  private:
    std::uint32_t find(std::uint32_t vertex);
    void start(std::uint32_t vertex);
    void grow(std::uint32_t vertex);
    void reach(std::uint32_t root, std::uint32_t vertex);

    const Elements& elements_;
    std::uint32_t curve_ = 0;                   ///< counts the cuts
    std::vector<std::uint32_t> reached_by_;     ///< [vertex] the last curve from which it was reached
    std::vector<std::uint32_t> cut_by_;         ///< [edge] the last curve that cut it
    std::vector<std::uint32_t> parents_;        ///< [vertex] of a forest with a tree for each piece
    std::vector<std::uint32_t> sizes_, active_; ///< [root] its vertices, and those that have yet to grow
    std::vector<std::uint32_t> queue_;
    std::size_t growing_count_ = 0; ///< the number of pieces with active vertices
};

} // namespace echinus
