#pragma once

#include "collider/frame_change.hpp"
#include "exact_map/query/stretched_contact.hpp"

#include <echinus/collider.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <span>

/// How each kind of map is queried in its own frame, and how its contacts are converted to the world. The
/// conversion is done in place, since most particles have no contact, and copying their answers would take
/// longer.
namespace echinus {

/// An exact map handles the stretch itself, so that only the pose remains to be applied.
class ExactQueries {
  public:
    /// Points of a batch are converted to the local frame in pieces that stay in the first-level cache.
    static constexpr std::size_t kPieceSize = 256;

    ExactQueries(const FrameChange& frame, const ExactMap& map, float margin_world = 0)
        : frame_(frame), map_(map.view()), margin_(margin_world) {}

    bool ask_contains(const Vec3f& point_local) const { return contains(map_, point_local); }
    void ask_contains(std::span<const Vec3f> points_local, std::span<std::uint8_t> inside) const {
        contains_batch(map_, points_local, inside);
    }
    Contact ask_contact(const Vec3f& point_local) const {
        return stretched_contact(map_, point_local, margin_, frame_.scale());
    }
    void ask_contacts(std::span<const Vec3f> points_local, std::span<Contact> contacts) const {
        stretched_contacts_batch(map_, points_local, margin_, contacts, frame_.scale());
    }
    void to_world(Contact& contact, const Vec3f&, const Vec3f& point_world) const {
        if (!contact.found()) {
            contact.point = point_world;
            return;
        }
        contact.point = frame_.point_to_world(contact.point);
        contact.normal = frame_.normal_to_world(contact.normal);
    }

  private:
    const FrameChange& frame_;
    ExactMapView map_;
    float margin_;
};

class RadialQueries {
  public:
    static constexpr std::size_t kPieceSize = 256;

    RadialQueries(const FrameChange& frame, const DistanceMap& map, float margin_world = 0)
        : frame_(frame), map_(map.view()), margin_world_(margin_world),
          // The largest local length that corresponds to the margin along any ray.
          margin_local_(static_cast<float>(margin_world / frame.least_scale())) {}

    bool ask_contains(const Vec3f& point_local) const { return contains(map_, point_local); }
    void ask_contains(std::span<const Vec3f> points_local, std::span<std::uint8_t> inside) const {
        contains_batch(map_, points_local, inside);
    }
    Contact ask_contact(const Vec3f& point_local) const { return contact(map_, point_local, margin_local_); }
    void ask_contacts(std::span<const Vec3f> points_local, std::span<Contact> contacts) const {
        contacts_batch(map_, points_local, margin_local_, contacts);
    }
    void to_world(Contact& contact, const Vec3f& point_local, const Vec3f& point_world) const {
        if (contact.found() && !frame_.uniform()) stretch(contact, point_local);
        if (!contact.found()) {
            contact.point = point_world;
            return;
        }
        contact.point = frame_.point_to_world(contact.point);
        contact.normal = frame_.normal_to_world(contact.normal);
        if (frame_.uniform()) contact.depth = static_cast<float>(contact.depth * frame_.least_scale());
    }

  private:
    /// Scales the depth, measured along the ray, and the normal. A contact within the largest local margin
    /// may be beyond the margin in the world.
    void stretch(Contact& contact, const Vec3f& point_local) const {
        const Vec3d from_centre = Vec3d(point_local) - Vec3d(map_.centre);
        const Vec3d ray = from_centre == Vec3d{} ? Vec3d(contact.point) - Vec3d(point_local) : from_centre;
        contact.depth = static_cast<float>(contact.depth * frame_.stretch_along(ray));
        contact.normal = frame_.scaled_normal(contact.normal);
        if (!contact.inside && -contact.depth > margin_world_) contact = {};
    }

    const FrameChange& frame_;
    DistanceMapView map_;
    float margin_world_, margin_local_;
};

/// Does not rely on the answers of a custom map.
class CustomQueries {
  public:
    /// Larger than for the other kinds, since each call of a custom map may have a fixed cost.
    static constexpr std::size_t kPieceSize = 4096;

    CustomQueries(const FrameChange& frame, const std::shared_ptr<const CustomMap>& map,
                  float margin_world = 0)
        : frame_(frame), map_(*map), margin_local_(widest_margin(frame, margin_world)) {}

    bool ask_contains(const Vec3f& point_local) const {
        std::uint8_t inside = 0;
        ask_contains({&point_local, 1}, {&inside, 1});
        return inside != 0;
    }
    void ask_contains(std::span<const Vec3f> points_local, std::span<std::uint8_t> inside) const {
        map_.contains_batch(points_local, inside);
        for (std::size_t i = 0; i < inside.size(); ++i)
            inside[i] = inside[i] != 0 && is_finite(points_local[i]) ? 1 : 0;
    }
    Contact ask_contact(const Vec3f& point_local) const {
        Contact result;
        ask_contacts({&point_local, 1}, {&result, 1});
        return result;
    }
    void ask_contacts(std::span<const Vec3f> points_local, std::span<Contact> contacts) const {
        map_.contacts_batch(points_local, margin_local_, contacts);
    }
    /// The scaled normal is a unit normal, whatever the length of the map's normal.
    void to_world(Contact& contact, const Vec3f& point_local, const Vec3f& point_world) const {
        if (!is_usable(contact, point_local)) {
            contact = {};
            contact.point = point_world;
            return;
        }
        const Vec3d way_out = Vec3d(contact.point) - Vec3d(point_local);
        contact.depth = static_cast<float>(contact.depth * frame_.stretch_along(way_out));
        contact.point = frame_.point_to_world(contact.point);
        contact.normal = frame_.normal_to_world(frame_.scaled_normal(contact.normal));
    }

  private:
    static float widest_margin(const FrameChange& frame, float margin_world) {
        const double margin = margin_world > 0 ? margin_world / frame.least_scale() : 0;
        return static_cast<float>(std::min(margin, double{std::numeric_limits<float>::max()}));
    }
    static bool is_usable(const Contact& contact, const Vec3f& point_local) {
        return contact.found() && is_finite(point_local) && is_finite(contact.point) &&
               is_finite(contact.normal) && std::isfinite(contact.depth);
    }

    const FrameChange& frame_;
    const CustomMap& map_;
    float margin_local_;
};

// The queries for each kind of map; overloaded, so that a visitor can choose.

inline ExactQueries queries(const FrameChange& frame, const ExactMap& map, float margin_world = 0) {
    return {frame, map, margin_world};
}
inline RadialQueries queries(const FrameChange& frame, const DistanceMap& map, float margin_world = 0) {
    return {frame, map, margin_world};
}
inline CustomQueries queries(const FrameChange& frame, const std::shared_ptr<const CustomMap>& map,
                             float margin_world = 0) {
    return {frame, map, margin_world};
}

} // namespace echinus
