// What is inside, and the nearest way out.

#include "exact_map/layout.hpp"
#include "exact_map/nearest.hpp"
#include "exact_map/sides.hpp"
#include "exact_map/winding.hpp"
#include "geometry/parallel.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace echinus {

namespace {

Containment containment(const ExactMapView& map, const LatticeFrame& frame, const Vec3f& point_local) {
    const Winding winding = winding_at(map, frame, point_local);
    return {is_inside(map.rule, winding.number), winding.certain};
}

/// In lattice steps: the diameter of the lattice and more.
constexpr double kEverything = 4 * static_cast<double>(kLatticeExtent);

/// Two snapped positions differ from the true ones by at most sqrt(3) lattice steps together.
constexpr double kSnapping = 2;

/// Contacts in a stretched world. The stretch is taken apart into one number, which is the unit of lengths,
/// and what is left for the axes, at most 1.
class ContactSearch {
  public:
    ContactSearch(const ExactMapView& map, const Vec3d& stretch, float margin)
        : map_(map), frame_(frame_of(map)),
          unit_(std::max({std::fabs(stretch.x), std::fabs(stretch.y), std::fabs(stretch.z)})),
          stretch_(stretch * (1 / unit_)), margin_(margin > 0 ? margin / (unit_ * frame_.step) : 0) {}

    Contact operator()(const Vec3f& point_local) const {
        Contact result;
        result.point = point_local;
        if (!is_finite(point_local)) return result;
        const Containment found = containment(map_, frame_, point_local);
        result.certain = found.certain;
        if (!found.inside && margin_ == 0) return result;
        const Vec3d place = frame_.to_lattice(point_local);
        const auto nearest = nearest_point(map_, place, stretch_, found.inside ? kEverything : margin_);
        if (!nearest) return result;
        result.inside = found.inside;
        result.point = Vec3f(frame_.to_local(nearest->point));
        const double distance = nearest->distance * unit_ * frame_.step;
        result.depth = static_cast<float>(found.inside ? distance : -distance);
        result.normal = outward_normal(*nearest, place, found.inside);
        result.face = static_cast<std::int32_t>(map_.face_numbers[nearest->face]);
        result.feature = nearest->feature;
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

    /// Turns a normal of the faces to where it leads out of the solid: faces may be turned the other way.
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

} // namespace

bool contains(const ExactMapView& map, Vec3f point_local) noexcept {
    return classify(map, point_local).inside;
}

Containment classify(const ExactMapView& map, Vec3f point_local) noexcept {
    return containment(map, frame_of(map), point_local);
}

Contact contact(const ExactMapView& map, Vec3f point_local, float margin, const Vec3d& stretch) noexcept {
    return ContactSearch(map, stretch, margin)(point_local);
}

void contains_batch(const ExactMapView& map, StridedSpan<const Vec3f> points_local,
                    std::span<std::uint8_t> inside, unsigned thread_count) noexcept {
    assert(points_local.size() == inside.size());
    for_each_piece(inside.size(), thread_count, [&](std::size_t begin, std::size_t end) {
        const std::span<Side> sides = inside.subspan(begin, end - begin);
        find_sides(map, points_local.subspan(begin, end - begin), sides);
        if (map.border.empty()) return;
        for (Side& side : sides) side &= kInside;
    });
}

void contacts_batch(const ExactMapView& map, StridedSpan<const Vec3f> points_local, float margin,
                    std::span<Contact> contacts, const Vec3d& stretch, unsigned thread_count) noexcept {
    assert(points_local.size() == contacts.size());
    const ContactSearch search(map, stretch, margin);
    for_each_piece(contacts.size(), thread_count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) contacts[i] = search(points_local[i]);
    });
}

} // namespace echinus
