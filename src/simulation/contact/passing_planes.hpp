#pragma once

#include "simulation/surfaces/separation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace echinus {

/// The parts of a pair that pass each other. The plane across the shortest distance between them is then in
/// the way, although another plane, along the displacement, may separate them all the time.
template <typename T>
struct PassingParts {
    PairKind kind;
    std::array<Vec3<T>, 4> points; ///< of the pair, at the beginning of its displacement
    Vec3<T> normal;                ///< across the shortest distance, of unit length
    Vec3<T> ahead;                 ///< the displacement of the first part relative to the second

    /// The unit normals of planes that may separate the parts, towards the first part; zero if there is none.
    /// These planes are along the displacement and an edge, along the face or along both edges (the axes that
    /// separate swept polyhedra, Gottschalk et al. 1996); further ones are the given plane turned to be along
    /// the displacement or along one of two edges, which may be parallel.
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

    /// The distance between the parts along a normal; negative if it does not separate them.
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
