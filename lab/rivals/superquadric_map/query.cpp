#include "rivals/superquadric_map/layout.hpp"
#include "rivals/superquadric_map/superquadric_map.hpp"

#include <array>
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

// The normals of the surface that a map stands for.

namespace {

/// The map's point at a sample, in the segment's frame. @param sample  not empty
Vec3f map_point(const SegmentArrays& map, std::size_t segment, std::uint32_t index, float sample) {
    const Vec3f p = map.surface_point(segment, index);
    return p * (1 - sample / length(p));
}

/// The gradient of the inside-outside function but for a factor.
Vec3f superquadric_normal(const SegmentFrame& frame, const Vec3f& place) {
    const float e1 = frame.eta_exponent, e2 = frame.omega_exponent;
    const float x = 2 / e2 * log2_of_ratio(place.x, frame.sizes.x);
    const float y = 2 / e2 * log2_of_ratio(place.y, frame.sizes.y);
    const float z = 2 / e1 * log2_of_ratio(place.z, frame.sizes.z);
    const float section = log2_of_sum(x, y);
    const float disc = e2 / e1 * section;
    const float whole = log2_of_sum(disc, z);
    const auto slope = [](float log_share, float coordinate) {
        return std::fabs(coordinate) > 0 ? std::exp2(log_share) / coordinate : 0;
    };
    const Vec3f gradient{slope(disc - whole + x - section, place.x),
                         slope(disc - whole + y - section, place.y), slope(z - whole, place.z)};
    const float size = length(gradient);
    if (size > 0 && std::isfinite(size)) return gradient * (1 / size);
    return {1, 0, 0}; // at the centre, whose way out is along the first axis
}

} // namespace

Vec3f surface_normal(const SegmentArrays& map, std::size_t segment, const Vec3f& place,
                     const SuperquadricPlace& at) {
    const SampleCell cell(map, segment, at.at);
    if (cell.is_complete) {
        std::array<Vec3f, 4> p;
        for (std::size_t k = 0; k < 4; ++k)
            p[k] = map_point(map, segment, cell.cell.corners[k], cell.samples[k]);
        const float u = cell.cell.u, v = cell.cell.v;
        const Vec3f along_omega = (p[1] - p[0]) * (1 - v) + (p[3] - p[2]) * v;
        const Vec3f along_theta = (p[2] - p[0]) * (1 - u) + (p[3] - p[1]) * u;
        const Vec3f normal = cross(along_theta, along_omega);
        const float size_sq = dot(normal, normal);
        // Outward means away from the centre; beyond a pole columns run the other way.
        const Vec3f outward = at.distance > 0 ? place : Vec3f{1, 0, 0};
        if (size_sq > 1e-12F * dot(along_omega, along_omega) * dot(along_theta, along_theta) && size_sq > 0)
            return normal * (std::copysign(1.0F, dot(normal, outward)) / std::sqrt(size_sq));
    }
    return superquadric_normal(map.frames[segment], place);
}

} // namespace echinus::rivals
