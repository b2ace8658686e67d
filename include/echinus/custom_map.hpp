#pragma once

#include <echinus/contact.hpp>
#include <echinus/export.hpp>
#include <echinus/geometry.hpp>

#include <cstdint>
#include <span>

ECHINUS_EXPORT_BEGIN

namespace echinus {

/// A structure of the user's own that a collider asks in place of a map: a field of distances, an analytic
/// shape, another library. Derive from it and hand a collider a shared pointer to it (collider.hpp).
///
/// A simulation pushes particles where the contacts say. It promises less than with an exact map: nothing is
/// swept and nothing proven, so a particle may pass through what is thinner than its way in one frame.
class CustomMap {
  public:
    virtual ~CustomMap() = default;

    // All points are in the map's own frame and unit. A call has at most a few thousand of them, of which
    // some may be NaN or infinite: what is answered for these is not looked at. Any number of threads may
    // ask at once.

    /// @param points_local  [n]
    /// @param inside        [n] out: 1 inside, 0 outside
    virtual void contains_batch(std::span<const Vec3f> points_local,
                                std::span<std::uint8_t> inside) const noexcept = 0;

    /// For each particle that is inside, or outside and no farther from the surface than the margin: where on
    /// the surface the push-out leads and the normal there. One that is farther may be answered as well: a
    /// map that measures along rays has to look farther along them than the margin to find all.
    ///
    /// The collider makes a normal of any other length a unit normal, and takes an answer with a point, a
    /// normal or a depth that is not finite for no contact. One that is inside and has no normal leaves the
    /// particle where it is.
    /// @param points_local  [n]
    /// @param margin        not negative, finite
    /// @param contacts      [n] out, as Contact describes; all of them are to be written
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
