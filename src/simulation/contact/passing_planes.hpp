#pragma once

#include "simulation/surfaces/separation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace echinus {

/// The parts of a pair, one of which goes past the other: the plane across the shortest distance between them
/// then stands in the way, though another one, along the displacement, separates them all the time.
template <typename T>
struct PassingParts {
    PairKind kind;
    std::array<Vec3<T>, 4> points; ///< of the pair, where its displacement begins
    Vec3<T> normal;                ///< across the shortest distance, of unit length
    Vec3<T> ahead;                 ///< how far the first part goes, seen from the second

    /// Normals of planes that may separate them: along the displacement and an edge, or that of the face or
    /// of both edges (the axes that separate swept polyhedra, Gottschalk et al. 1996), and the given one
    /// turned to be along the displacement, or along one of two edges, which may be parallel. Of unit length,
    /// towards the first part; zero where there is none.
    std::array<Vec3<T>, 6> normals() const {
        const auto edge = [&](std::size_t a, std::size_t b) { return points[b] - points[a]; };
        const auto turned_along = [&](const Vec3<T>& direction) {
            return normal - direction * (dot(direction, normal) / dot(direction, direction));
        };
        std::array<Vec3<T>, 6> result{turned_along(ahead)};
        if (kind == PairKind::EdgeEdge) {
            result[1] = cross(edge(0, 1), edge(2, 3));
            result[2] = cross(edge(0, 1), ahead);
            result[3] = cross(edge(2, 3), ahead);
            result[4] = turned_along(edge(0, 1));
            result[5] = turned_along(edge(2, 3));
        } else {
            const std::size_t a = kind == PairKind::VertexFace ? 1 : 0, b = a + 1, c = a + 2;
            result[1] = cross(edge(a, b), edge(a, c));
            result[2] = cross(edge(a, b), ahead);
            result[3] = cross(edge(b, c), ahead);
            result[4] = cross(edge(c, a), ahead);
        }
        for (Vec3<T>& n : result) {
            const T size = length(n);
            n = size > 0 ? n * ((dot(n, normal) < 0 ? -1 : 1) / size) : Vec3<T>{};
        }
        return result;
    }

    /// How far apart the parts are along a normal; negative where it does not separate them.
    T gap_along(const Vec3<T>& across) const {
        T nearest = std::numeric_limits<T>::infinity(), farthest = -nearest;
        for (std::size_t k = 0; k < 4; ++k) {
            const T at = dot(across, points[k]);
            if (k < own_count(kind))
                nearest = std::min(nearest, at);
            else
                farthest = std::max(farthest, at);
        }
        return nearest - farthest;
    }
};

} // namespace echinus
