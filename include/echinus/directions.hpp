#pragma once

#include <cstdint>

namespace echinus {

/// Which axis of the mesh the poles of the (longitude, colatitude) grid lie on.
enum class PoleAxis : std::uint8_t { X, Y, Z };

} // namespace echinus
