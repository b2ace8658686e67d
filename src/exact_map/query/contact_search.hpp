#pragma once

#include "exact_map/layout.hpp"
#include "exact_map/query/nearest.hpp"
#include "exact_map/query/sides.hpp"
#include "exact_map/query/winding.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace echinus {

/// The errors of two snapped positions together are at most sqrt(3) lattice steps.
inline constexpr double kSnapping = 2;

/// The signed distance of a point that is not finite.
inline float signed_distance_without_contact(const Vec3f& point_local) {
    return has_nan(point_local) ? std::numeric_limits<float>::quiet_NaN()
                                : std::numeric_limits<float>::infinity();
}

/// Contacts in a stretched world. The stretch is factored into one number, the unit of lengths, and factors
/// of the axes, which are at most 1.
class ContactSearch {
  public:
    ContactSearch(const ExactMapView& map, const Vec3d& stretch, float margin)
        : map_(map), frame_(frame_of(map)),
          unit_(std::max({std::fabs(stretch.x), std::fabs(stretch.y), std::fabs(stretch.z)})),
          stretch_(stretch * (1 / unit_)), margin_(margin > 0 ? margin / (unit_ * frame_.step) : 0) {}

    Contact operator()(const Vec3f& point_local) const {
        const Side side = side_at(map_, frame_, point_local);
        if (!is_wanted(point_local, side)) return no_contact(point_local, side);
        const Vec3d place = place_of(point_local);
        const auto face = nearest_face(map_, place, stretch_, farthest(side));
        return face ? contact_at(point_local, side, nearest_point_on_face(map_, *face, place, stretch_))
                    : no_contact(point_local, side);
    }

    const ExactMapView& map() const { return map_; }
    const LatticeFrame& frame() const { return frame_; }
    double unit() const { return unit_; }
    const Vec3d& stretch() const { return stretch_; }
    Vec3d place_of(const Vec3f& point_local) const { return frame_.to_lattice(point_local); }

    /// Does this particle need the nearest point?
    bool is_wanted(const Vec3f& point_local, Side side) const {
        return ((side & kInsideBit) != 0 || margin_ > 0) && is_finite(point_local);
    }
    /// The distance up to which the nearest point is needed, in lattice steps.
    double farthest(Side side) const {
        return (side & kInsideBit) != 0 ? std::numeric_limits<double>::infinity() : margin_;
    }

    static Contact no_contact(const Vec3f& point_local, Side side) {
        Contact result;
        set_no_contact(result, point_local, side);
        return result;
    }
    /// Writes the result member by member: wide loads that copied a whole contact made elsewhere would have
    /// to wait for the narrow stores before them.
    static void set_no_contact(Contact& contact, const Vec3f& point_local, Side side) {
        contact.point = point_local;
        contact.normal = {};
        contact.depth = 0;
        contact.face = kNoIndex;
        contact.inside = false;
        contact.certain = (side & kUncertainBit) == 0 && !has_nan(point_local);
        contact.feature = Feature::Unknown;
    }

    Contact contact_at(const Vec3f& point_local, Side side, const NearestPoint& nearest) const {
        Contact result;
        const bool inside = (side & kInsideBit) != 0;
        result.inside = inside;
        result.certain = (side & kUncertainBit) == 0;
        result.point = Vec3f(frame_.to_local(nearest.point));
        const double distance = nearest.distance * unit_ * frame_.step;
        result.depth = static_cast<float>(inside ? distance : -distance);
        result.normal = outward_normal(nearest, place_of(point_local), inside);
        result.face = map_.face_numbers[nearest.face];
        result.feature = nearest.feature;
        return result;
    }

  private:
    Vec3f outward_normal(const NearestPoint& nearest, const Vec3d& place, bool inside) const {
        const Vec3d offset = nearest.point - place;
        if (length(offset) <= kSnapping)
            return outward(nearest.point, pseudonormal(map_, nearest, stretch_, kSnapping));
        const Vec3d in_world{offset.x * stretch_.x, offset.y * stretch_.y, offset.z * stretch_.z};
        return Vec3f(in_world * ((inside ? 1 : -1) / nearest.distance));
    }

    /// Returns the normal that points out of the solid: the faces may have the opposite orientation.
    Vec3f outward(const Vec3d& point, const Vec3f& normal) const {
        constexpr double kClear = 2 * kSnapping;
        const Vec3d along{normal.x / stretch_.x, normal.y / stretch_.y, normal.z / stretch_.z};
        const Vec3d clear = along * (kClear / length(along));
        const auto inside_at = [&](const Vec3d& place) {
            return is_inside(map_.rule, winding_at(map_, rounded(place)).number);
        };
        return inside_at(point + clear) && !inside_at(point - clear) ? -normal : normal;
    }

    const ExactMapView& map_;
    LatticeFrame frame_;
    double unit_;
    Vec3d stretch_;
    double margin_; ///< in lattice steps
};

/// The contacts of many particles. They equal those of the scalar search on every instruction set.
/// @throws std::bad_alloc
/// @pre points_local.size() == contacts.size()
void find_contacts(const ContactSearch& search, const StridedSpan<const Vec3f>& points_local,
                   std::span<Contact> contacts);

/// The signed distances and, if requested, the gradients; otherwise like find_contacts().
/// @param search     must have no limit of distance
/// @param gradients  empty, or as long as `distances`
void find_signed_distances(const ContactSearch& search, const StridedSpan<const Vec3f>& points_local,
                           std::span<float> distances, std::span<Vec3f> gradients);

} // namespace echinus
