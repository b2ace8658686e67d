#pragma once

#include "directions/cast_rays.hpp"
#include "directions/grids.hpp"

namespace echinus {

/// Is the centre inside, by the parity of each ray, weighted by the ray's solid angle? On a closed mesh all
/// rays agree; on an open one the majority of the sphere decides.
struct CentreSide {
    bool inside;
    float wrong_parity_share; ///< of the directions
};

CentreSide side_of_centre(const Crossings& crossings, const AnyGrid& grid);

} // namespace echinus
