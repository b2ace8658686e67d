#pragma once

#include <echinus/geometry.hpp>

#include <array>
#include <cstdint>

namespace echinus {

/// What may meet: the first belongs to the deformable, the second to its opponent.
enum class PairKind : std::uint8_t { VertexFace, FaceVertex, EdgeEdge };

/// Vertices of the deformable's part of a pair. Of the opponent's there are 4 less.
constexpr std::size_t own_count(PairKind kind) {
    return kind == PairKind::VertexFace ? 1 : kind == PairKind::FaceVertex ? 3 : 2;
}

/// Two convex sets with a plane between them.
struct Separation {
    Vec3f normal; ///< of unit length to rounding, from the opponent to the deformable
    /// Every vertex of the one lies at least so far from every vertex of the other along the normal: proven,
    /// rounding included. Not above the distance. Not positive: no plane was found.
    float gap = 0;
    /// Shares of the four vertices in the two nearest points: the deformable's first.
    std::array<float, 4> weights{};
};

/// @param points  the deformable's vertices of the pair, then the opponent's
Separation separation(PairKind kind, const std::array<Vec3f, 4>& points);

} // namespace echinus
