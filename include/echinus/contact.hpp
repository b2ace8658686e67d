#pragma once

#include <echinus/export.hpp>
#include <echinus/geometry.hpp>

#include <cstdint>

ECHINUS_EXPORT_BEGIN

namespace echinus {

/// Which part of a triangle the nearest point lies on.
enum class Feature : std::uint8_t {
    Unknown, ///< no contact, or a distance map, which does not know its mesh
    Face,
    Edge,
    Vertex,
};

/// A query's answer for one particle: inside or not, how deep, which way out. The same for every kind of map.
///
/// The push-out moves the particle to `point`. For a particle that is outside and farther than the margin, or
/// not finite, the members keep their defaults (not inside, depth 0, normal 0, face -1), and `point` is the
/// particle itself.
struct Contact {
    static constexpr std::int32_t kUnknownFace = -1;

    Vec3f point;   ///< the point of the surface that the push-out leads to, in the frame of the query
    Vec3f normal;  ///< unit normal of the surface at `point`, out of the solid; 0 when there is no contact
    float depth{}; ///< distance from the particle to `point`: positive inside, negative outside, 0 for no
                   ///< contact
    std::int32_t face = kUnknownFace; ///< the face of the mesh that contains `point`, if the map knows it
    bool inside = false;
    /// False where the mesh is open and the generalised winding number is near a half, so that `inside`
    /// depends on how one would close the holes (kCertainMargin in exact_map.hpp). Always true with a
    /// distance map, which does not judge its answers.
    bool certain = true;
    Feature feature = Feature::Unknown; ///< the part of the face that is nearest

    /// Inside, or outside within the margin.
    bool found() const { return inside || normal != Vec3f{}; }
};

} // namespace echinus

ECHINUS_EXPORT_END
