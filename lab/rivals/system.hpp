#pragma once

#include <echinus/contact.hpp>
#include <echinus/geometry.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>

/// The systems that answer the same questions as the maps of Echinus do.
namespace echinus::rivals {

/// Told by a build that takes long what it does and how much of that is done, 0 to 1. From one thread at a
/// time. What it throws ends the build and reaches the caller.
using Progress = std::function<void(std::string_view stage, double share)>;

/// A structure around a closed mesh that can be asked about particles: what all systems have in common, so
/// that a comparison treats them alike. Each is built by its own function with its own options. All points
/// are in the mesh's frame and unit. Immutable once built; any number of threads may query one.
class System {
  public:
    virtual ~System() = default;

    /// Short, the same for all resolutions: "dense", "openvdb", "embree", "exact" ...
    virtual std::string name() const = 0;

    /// All that a query reads.
    virtual std::size_t byte_count() const = 0;

    /// The parts that byte_count() includes, for the footnote of a table.
    virtual std::string_view counted() const = 0;

    /// Decides which particles are inside. A particle that is not finite is outside.
    /// @param inside  [n] 1 or 0. @pre points.size() == inside.size()
    virtual void contains_batch(std::span<const Vec3f> points, std::span<std::uint8_t> inside) const = 0;

    /// How deep is each particle, or how far outside within the margin, and which way is out? One farther
    /// outside, or not finite, gets no_contact(). A system that finds a particle inside and no way out says
    /// so: inside, with no normal and depth 0.
    /// @param margin    by the system's own measure of distance; not negative
    /// @param contacts  [n] @pre points.size() == contacts.size()
    virtual void contacts_batch(std::span<const Vec3f> points, float margin,
                                std::span<Contact> contacts) const = 0;

    /// Of the particles inside alone.
    void contacts_batch(std::span<const Vec3f> points, std::span<Contact> contacts) const {
        contacts_batch(points, 0, contacts);
    }

    /// Of one particle: the scalar query where a system has one, and a batch of one where not.
    virtual bool contains(const Vec3f& point) const {
        std::uint8_t inside = 0;
        contains_batch({&point, 1}, {&inside, 1});
        return inside != 0;
    }
    virtual Contact contact(const Vec3f& point, float margin = 0) const {
        Contact contact;
        contacts_batch({&point, 1}, margin, {&contact, 1});
        return contact;
    }

  protected:
    System() = default;
    System(const System&) = default;
    System(System&&) = default;
    System& operator=(const System&) = default;
    System& operator=(System&&) = default;
};

/// The answer for a particle outside.
inline Contact no_contact(const Vec3f& point) {
    Contact none;
    none.point = point;
    return none;
}

/// The answer for a particle at this depth, negative outside, where the surface is straight along the normal.
inline Contact contact_along(const Vec3f& point, float depth, const Vec3f& normal) {
    Contact result;
    result.point = point + normal * depth;
    result.normal = normal;
    result.depth = depth;
    result.inside = depth > 0;
    return result;
}

} // namespace echinus::rivals
