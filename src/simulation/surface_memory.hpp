#pragma once

#include <echinus/geometry.hpp>

namespace echinus {

/// What a simulation remembers of one particle and one collider with an exact map.
struct SurfaceMemory {
    Vec3f free_local; ///< the last place proven free, in the map's frame: exactly what was tested
    /// Where the nearest point was asked for, in the collider's frame with its scale applied.
    Vec3f asked_at;
    float clearance = -1; ///< no surface within this distance of asked_at; negative before the first answer
    Vec3f point, normal;  ///< the contact plane in the same frame; normal 0 when nothing was near
    bool was_free = false;
    bool lost = false; ///< in this frame
};

} // namespace echinus
