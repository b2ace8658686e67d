#pragma once

#include <echinus/geometry.hpp>

/// What a rival answers about a particle: all that a push-out takes.
struct DepthNormal {
    float depth = 0;       ///< positive inside, 0 outside
    echinus::Vec3f normal; ///< out of the solid
};
