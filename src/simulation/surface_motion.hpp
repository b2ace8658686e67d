#pragma once

#include "simulation/particles.hpp"

namespace echinus {

/// How the surface of a collider deforms in a frame: each of its vertices goes straight, in the body frame
/// (the collider's frame with its scale applied), whatever the collider itself does meanwhile.
struct SurfaceMotion {
    PointArrays from, to; ///< [vertex_count of the model]
    /// Where vertices are when a share of the frame is over.
    PointArrays at(float share) const {
        PointArrays places = to;
        if (share == 1) return places;
        for (std::size_t v = 0; v < places.x.size(); ++v) places.set(v, from[v] + (to[v] - from[v]) * share);
        return places;
    }
};

} // namespace echinus
