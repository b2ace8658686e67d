// What is inside, and the nearest way out.

#include "exact_map/layout.hpp"
#include "exact_map/nearest.hpp"
#include "exact_map/nearest_faces.hpp"
#include "exact_map/sides.hpp"
#include "exact_map/spatial_order.hpp"
#include "exact_map/winding.hpp"
#include "geometry/parallel.hpp"
#include "simd/dispatch.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <memory>
#include <new>
#include <vector>

namespace echinus {

namespace {

Containment containment(const ExactMapView& map, const LatticeFrame& frame, const Vec3f& point_local) {
    const Winding winding = winding_at(map, frame, point_local);
    return {is_inside(map.rule, winding.number), winding.certain};
}

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
        const Containment found =
            is_finite(point_local) ? containment(map_, frame_, point_local) : Containment{};
        const Side side = side_of(found);
        if (!is_wanted(point_local, side)) return no_contact(point_local, side);
        const auto nearest = nearest_point(map_, place_of(point_local), stretch_, farthest(side));
        return nearest ? contact_at(point_local, side, *nearest) : no_contact(point_local, side);
    }

    const Vec3d& stretch() const { return stretch_; }
    Vec3d place_of(const Vec3f& point_local) const { return frame_.to_lattice(point_local); }

    /// Is there a nearest point to be looked for?
    bool is_wanted(const Vec3f& point_local, Side side) const {
        return ((side & kInside) != 0 || margin_ > 0) && is_finite(point_local);
    }
    /// How far, in lattice steps.
    double farthest(Side side) const { return (side & kInside) != 0 ? kEverywhere : margin_; }

    static Contact no_contact(const Vec3f& point_local, Side side) {
        Contact result;
        result.point = point_local;
        result.certain = (side & kUncertain) == 0;
        return result;
    }

    Contact contact_at(const Vec3f& point_local, Side side, const NearestPoint& nearest) const {
        Contact result;
        const bool inside = (side & kInside) != 0;
        result.inside = inside;
        result.certain = (side & kUncertain) == 0;
        result.point = Vec3f(frame_.to_local(nearest.point));
        const double distance = nearest.distance * unit_ * frame_.step;
        result.depth = static_cast<float>(inside ? distance : -distance);
        result.normal = outward_normal(nearest, place_of(point_local), inside);
        result.face = static_cast<std::int32_t>(map_.face_numbers[nearest.face]);
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

namespace {

/// Contacts of a piece of a batch: their sides first, then the nearest faces of those that want one, in an
/// order in which neighbours follow each other.
/// @throws std::bad_alloc
void find_contacts(const ExactMapView& map, const ContactSearch& search,
                   const StridedSpan<const Vec3f>& points_local, std::span<Contact> contacts) {
    const auto sides = std::make_unique_for_overwrite<Side[]>(contacts.size());
    find_sides(map, points_local, {sides.get(), contacts.size()});
    std::vector<Station> stations;
    for (std::size_t i = 0; i < contacts.size(); ++i) {
        contacts[i] = ContactSearch::no_contact(points_local[i], sides[i]);
        if (search.is_wanted(points_local[i], sides[i]))
            stations.push_back({morton_key(search.place_of(points_local[i])), static_cast<std::uint32_t>(i)});
    }
    std::vector<Station> spare(stations.size());
    sort_by_key(stations, spare);

    constexpr std::size_t kBlock = 256;
    std::array<NearestSearch, kBlock> searches;
    std::array<std::uint32_t, kBlock> faces;
    for (std::span<const Station> rest = stations; !rest.empty();) {
        const std::span<const Station> block = rest.first(std::min(kBlock, rest.size()));
        rest = rest.subspan(block.size());
        for (std::size_t k = 0; k < block.size(); ++k) {
            const std::uint32_t particle = block[k].particle;
            searches[k] = {search.place_of(points_local[particle]), search.farthest(sides[particle])};
        }
        find_nearest_faces(map, search.stretch(), std::span(searches).first(block.size()),
                           std::span(faces).first(block.size()));
        for (std::size_t k = 0; k < block.size(); ++k) {
            if (faces[k] == kNoFace) continue;
            const std::uint32_t particle = block[k].particle;
            contacts[particle] =
                search.contact_at(points_local[particle], sides[particle],
                                  nearest_point_on_face(map, faces[k], searches[k].place, search.stretch()));
        }
    }
}

} // namespace

void contacts_batch(const ExactMapView& map, StridedSpan<const Vec3f> points_local, float margin,
                    std::span<Contact> contacts, const Vec3d& stretch, unsigned thread_count) noexcept {
    assert(points_local.size() == contacts.size());
    const ContactSearch search(map, stretch, margin);
    for_each_piece(contacts.size(), thread_count, [&](std::size_t begin, std::size_t end) {
        if (use_kernels()) {
            try {
                find_contacts(map, search, points_local.subspan(begin, end - begin),
                              contacts.subspan(begin, end - begin));
                return;
            } catch (const std::bad_alloc&) { // the reference needs no memory
            }
        }
        for (std::size_t i = begin; i < end; ++i) contacts[i] = search(points_local[i]);
    });
}

} // namespace echinus
