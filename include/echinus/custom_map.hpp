#pragma once

#include <echinus/contact.hpp>
#include <echinus/export.hpp>
#include <echinus/geometry.hpp>

#include <cstdint>
#include <span>

ECHINUS_EXPORT_BEGIN

namespace echinus {

/// A user-defined structure that a collider queries in place of a map: a distance field, an analytic shape,
/// another library. Derive from it and pass a shared pointer to a collider (collider.hpp).
///
/// A simulation pushes particles to the points of the contacts. It guarantees less than with an exact map:
/// particles are not swept, so a particle may pass through a part that is thinner than the particle's path in
/// one frame.
class CustomMap {
  public:
    virtual ~CustomMap() = default;

    // All points are in the map's own frame and unit. A call has at most a few thousand of them. Some may be
    // NaN or infinite; their answers are ignored. Any number of threads may call these functions at once.

    /// @param points_local  [n]
    /// @param inside        [n] out: 1 inside, 0 outside
    virtual void contains_batch(std::span<const Vec3f> points_local,
                                std::span<std::uint8_t> inside) const noexcept = 0;

    /// Finds a contact for each particle that is inside, or outside and at most the margin away from the
    /// surface: the point of the surface to which it is pushed out, and the normal there. Particles that are
    /// farther away may get a contact as well, since a map that measures along rays must search beyond the
    /// margin to find all contacts within it.
    ///
    /// The collider normalises the normals, and ignores contacts whose point, normal or depth is not finite.
    /// If the contact of a particle that is inside has the normal 0 and the particle's own position as
    /// `point`, the particle is not pushed: it moves as if there were no collider.
    /// @param points_local  [n]
    /// @param margin        not negative, finite
    /// @param contacts      [n] out, as Contact describes; every element must be written
    virtual void contacts_batch(std::span<const Vec3f> points_local, float margin,
                                std::span<Contact> contacts) const noexcept = 0;

  protected:
    CustomMap() = default;
    CustomMap(const CustomMap&) = default;
    CustomMap(CustomMap&&) = default;
    CustomMap& operator=(const CustomMap&) = default;
    CustomMap& operator=(CustomMap&&) = default;
};

} // namespace echinus

ECHINUS_EXPORT_END
