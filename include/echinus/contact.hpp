#pragma once

#include <echinus/export.hpp>
#include <echinus/geometry.hpp>

#include <cstdint>

ECHINUS_EXPORT_BEGIN

namespace echinus {

/// The part of a triangle on which the nearest point lies.
enum class Feature : std::uint8_t {
    Unknown, ///< there is no contact, or the map is a distance map, which does not store its mesh
    Face,
    Edge,
    Vertex,
};

/// The answer of a query for one particle: whether it is inside, how deep, and where the push-out leads. Maps
/// of every kind return this type.
///
/// The push-out moves the particle to `point`. For a particle that is outside and farther away than the
/// margin, or not finite, the members keep their defaults (not inside, depth 0, normal 0, no face), and
/// `point` is the particle itself. For a particle with NaN an exact map returns `certain` = false.
struct Contact {
    Vec3f point;   ///< the point of the surface to which the push-out leads, in the frame of the query
    Vec3f normal;  ///< outward unit normal of the surface at `point`; 0 without a contact
    float depth{}; ///< distance from the particle to `point`: positive inside, negative outside, 0 without
                   ///< a contact
    std::uint32_t face = kNoIndex; ///< the face of the mesh that contains `point`, if the map knows it
    bool inside = false;
    /// False if the mesh is open and the generalised winding number is near one half, so that `inside`
    /// depends on how the holes would be closed (kCertainMargin in exact_map.hpp). It is always true with a
    /// distance map, which does not assess its answers.
    bool certain = true;
    Feature feature = Feature::Unknown; ///< the part of the face that contains `point`

    /// Is there a contact? The particle is then inside, or outside within the margin.
    bool found() const { return inside || normal != Vec3f{}; }
};

} // namespace echinus

ECHINUS_EXPORT_END
