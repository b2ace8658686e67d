#pragma once

#include "simulation/particles.hpp"

#include <echinus/geometry.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace echinus {

/// The two elements that may meet: the first belongs to the deformable, the second to its opponent.
enum class PairKind : std::uint8_t { VertexFace, FaceVertex, EdgeEdge };

/// The number of vertices in the deformable's part of a pair. The opponent's part has the rest of the four.
constexpr std::size_t own_count(PairKind kind) {
    return kind == PairKind::VertexFace ? 1 : kind == PairKind::FaceVertex ? 3 : 2;
}

/// Two convex sets with a plane between them.
struct Separation {
    Vec3f normal; ///< of unit length to rounding, from the opponent to the deformable
    /// Every vertex of one set is at least this far from every vertex of the other along the normal; this is
    /// proven, including rounding. It does not exceed the distance. If it is not positive, no plane was
    /// found.
    float gap = 0;
    /// The shares of the four vertices in the two nearest points, the deformable's first.
    std::array<float, 4> weights{};
};

/// A vertex and a face, or two edges, that share no vertex.
struct Pair {
    std::array<std::uint32_t, 4> points; ///< the vertices of the deformable's part, then the opponent's
    PairKind kind;
};

/// @param points  the deformable's vertices of the pair, then the opponent's
Separation separation(PairKind kind, const std::array<Vec3f, 4>& points) noexcept;

/// The shares of the four points in the two nearest points, in double.
std::array<double, 4> nearest_points(PairKind kind, const std::array<Vec3d, 4>& points) noexcept;

/// separation() of many pairs, with the same bits for every instruction set.
/// @param own     the positions of the deformable's vertices
/// @param other   those of the opponent's
/// @param result  [pairs.size()] out
void separations(std::span<const Pair> pairs, const PointArrays& own, const PointArrays& other,
                 std::span<Separation> result) noexcept;

} // namespace echinus
