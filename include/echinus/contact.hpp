#pragma once

#include <echinus/export.hpp>
#include <echinus/geometry.hpp>

#include <cstdint>

ECHINUS_EXPORT_BEGIN

namespace echinus {

/// Which part of a triangle the nearest point lies on.
enum class Feature : std::uint8_t {
    Unknown, ///< no contact, or one of a distance map, which does not contain the mesh
    Face,
    Edge,
    Vertex,
};

/// A query's answer for one particle: inside or not, how deep, which way out. The same for every kind of map.
///
/// The push-out moves the particle to `point`. A particle that is outside and farther than the margin, or not
/// finite, gets the default value: not inside, depth 0, normal 0, face -1, and `point` the particle itself.
struct Contact {
    static constexpr std::int32_t kUnknownFace = -1;

    Vec3f point;   ///< the point of the surface to which the particle is pushed out, in the frame of the
                   ///< query
    Vec3f normal;  ///< unit normal of the surface at `point`, out of the solid; 0 when there is no contact
    float depth{}; ///< distance from the particle to `point`: positive inside, negative outside, 0 for no
                   ///< contact
    std::int32_t face = kUnknownFace; ///< the face of the mesh that contains `point`, if the map knows it
    bool inside = false;
    /// False where the mesh is open and `inside` was decided by the generalised winding number
    /// (exact_map.hpp). A distance map never marks its answers.
    bool certain = true;
    Feature feature = Feature::Unknown; ///< the nearest part of the face

    /// Inside, or outside within the margin.
    bool found() const { return inside || normal != Vec3f{}; }
};

} // namespace echinus

ECHINUS_EXPORT_END
