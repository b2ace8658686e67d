#pragma once

#include <echinus/mesh.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace echinus {

/// The common edge a b of two faces (a, b, c) and (b, a, d).
struct Hinge {
    std::uint32_t a, b, c, d;
};

/// The faces of a cloth and their connections.
struct ClothSurface {
    std::vector<Triangle> faces;                     ///< consistently oriented
    std::vector<std::array<std::uint32_t, 2>> edges; ///< each once, its smaller vertex first, ascending
    std::vector<Hinge> hinges;                       ///< by edge, ascending
};

/// Starting from the first face of each piece, turns each face that runs along a common edge in the same
/// direction as a face that was reached before.
/// @throws Error InvalidMesh, naming the faces and the edge, if an edge has more than two faces, a face has
/// two equal corners, or two faces have the same three
/// @pre indices are in range
ClothSurface surface_of(const TriangleMesh& mesh);

} // namespace echinus
