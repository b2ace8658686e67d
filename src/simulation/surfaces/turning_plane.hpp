#pragma once

#include "simulation/surfaces/separation.hpp"

#include <array>

namespace echinus {

/// Do the parts of a pair stay apart while its vertices go straight ways together? In each piece of the ways
/// a plane along one normal has to separate them at both ends, and then it does so in between; from piece to
/// piece it may turn. No piece is too short unless the parts meet, or turn very fast.
/// @param least_gap  that they have to keep; positive
bool stay_apart(PairKind kind, const std::array<Vec3f, 4>& from, const std::array<Vec3f, 4>& to,
                float least_gap);

} // namespace echinus
