#include "rivals/superquadric_map/layout.hpp"
#include "rivals/superquadric_map/segment_query.hpp"
#include "rivals/superquadric_map/superquadric_map.hpp"

#include <cassert>
#include <cmath>

namespace echinus::rivals {

namespace {

bool is_inside_any(const SegmentArrays& map, const Vec3f& point_local) {
    for (std::size_t segment = 0; segment < map.frames.size(); ++segment) {
        const SegmentAnswer answer = ask(map, segment, point_local, 0);
        if (answer.is_known && answer.depth >= 0) return true;
    }
    return false;
}

/// @pre margin >= 0
Contact deepest_contact(const SegmentArrays& map, const Vec3f& point_local, float margin) {
    SegmentAnswer deepest;
    std::size_t its_segment = 0;
    for (std::size_t segment = 0; segment < map.frames.size(); ++segment) {
        const SegmentAnswer answer = ask(map, segment, point_local, margin);
        if (!answer.is_known || (deepest.is_known && !(answer.depth > deepest.depth))) continue;
        deepest = answer;
        its_segment = segment;
    }
    Contact contact = no_contact(point_local);
    if (!deepest.is_known || !(deepest.depth >= -margin)) return contact;
    const SegmentFrame& frame = map.frames[its_segment];
    const Vec3f ray = deepest.at.distance > 0 ? deepest.place * (1 / deepest.at.distance) : Vec3f{1, 0, 0};
    contact.inside = deepest.depth >= 0;
    contact.depth = deepest.depth;
    contact.point = frame.centre + frame.turned_from_frame(ray * (deepest.at.distance + deepest.depth));
    contact.normal = frame.turned_from_frame(surface_normal(map, its_segment, deepest.place, deepest.at));
    return contact;
}

/// NaN and negative margins ask for particles inside only.
float usable_margin(float margin) {
    return margin > 0 ? margin : 0;
}

} // namespace

std::size_t SuperquadricMap::byte_count() const {
    return arrays_->byte_count();
}
std::size_t SuperquadricMap::segment_count() const {
    return arrays_->frames.size();
}
std::uint32_t SuperquadricMap::omega_count() const {
    return arrays_->grid.longitude_count();
}
std::uint32_t SuperquadricMap::eta_count() const {
    return arrays_->grid.colatitude_count();
}

bool SuperquadricMap::contains(const Vec3f& point_local) const noexcept {
    return is_finite(point_local) && is_inside_any(*arrays_, point_local);
}

Contact SuperquadricMap::contact(const Vec3f& point_local, float margin) const noexcept {
    if (!is_finite(point_local)) return no_contact(point_local);
    return deepest_contact(*arrays_, point_local, usable_margin(margin));
}

void SuperquadricMap::contains_batch(std::span<const Vec3f> points, std::span<std::uint8_t> inside) const {
    assert(points.size() == inside.size());
    for (std::size_t i = 0; i < inside.size(); ++i) inside[i] = contains(points[i]) ? 1 : 0;
}

void SuperquadricMap::contacts_batch(std::span<const Vec3f> points, float margin,
                                     std::span<Contact> contacts) const {
    assert(points.size() == contacts.size());
    for (std::size_t i = 0; i < contacts.size(); ++i) contacts[i] = contact(points[i], margin);
}

} // namespace echinus::rivals
