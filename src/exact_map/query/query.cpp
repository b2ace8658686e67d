#include "exact_map/layout.hpp"
#include "exact_map/query/contact_search.hpp"
#include "exact_map/query/nearest.hpp"
#include "exact_map/query/sides.hpp"
#include "exact_map/query/stretched_contact.hpp"
#include "exact_map/query/winding.hpp"
#include "geometry/parallel.hpp"
#include "geometry/precondition.hpp"
#include "simd/dispatch.hpp"

#include <echinus/exact_map.hpp>

#include <algorithm>
#include <limits>
#include <new>

namespace echinus {

// Tests for inside or outside, and the nearest way out.

bool contains(const ExactMapView& map, Vec3f point_local) noexcept {
    return (find_side(map, frame_of(map), point_local, false).side & kInsideBit) != 0;
}

Containment classify(const ExactMapView& map, Vec3f point_local) noexcept {
    const Winding winding = winding_at(map, frame_of(map), point_local);
    return {is_inside(map.rule, winding.number), winding.certain && !has_nan(point_local), winding.computed};
}

namespace {

/// The same as search(point_local), computed by vector instructions.
Contact find_contact(const ContactSearch& search, const Vec3f& point_local) {
    if (!use_kernels()) return search(point_local);
    const ExactMapView& map = search.map();
    const auto [side, near_leaf] = find_side(map, search.frame(), point_local, search.farthest(Side{0}) > 0);
    if (!search.is_wanted(point_local, side)) return ContactSearch::no_contact(point_local, side);
    const NearestSearch nearest{search.place_of(point_local), search.farthest(side), near_leaf};
    const std::uint32_t face = find_nearest_face(map, search.stretch(), nearest);
    if (face == kNoFace) return ContactSearch::no_contact(point_local, side);
    return search.contact_at(point_local, side,
                             nearest_point_on_face(map, face, nearest.place, search.stretch()));
}

} // namespace

Contact contact(const ExactMapView& map, Vec3f point_local, float margin) noexcept {
    return stretched_contact(map, point_local, margin, {1, 1, 1});
}

Contact stretched_contact(const ExactMapView& map, const Vec3f& point_local, float margin,
                          const Vec3d& stretch) noexcept {
    return find_contact(ContactSearch(map, stretch, margin), point_local);
}

void contains_batch(const ExactMapView& map, StridedSpan<const Vec3f> points_local,
                    std::span<std::uint8_t> inside, unsigned thread_count) noexcept {
    if (!is_met(points_local.size() == inside.size(),
                "contains_batch: the number of answers differs from the number of points"))
        return;
    for_each_piece(inside.size(), thread_count, [&](std::size_t begin, std::size_t end) {
        const std::span<Side> sides = inside.subspan(begin, end - begin);
        find_sides(map, points_local.subspan(begin, end - begin), sides);
        if (map.border.empty()) return;
        for (Side& side : sides) side &= kInsideBit;
    });
}

void classify_batch(const ExactMapView& map, StridedSpan<const Vec3f> points_local,
                    std::span<Containment> answers, unsigned thread_count) noexcept {
    if (!is_met(points_local.size() == answers.size(),
                "classify_batch: the number of answers differs from the number of points"))
        return;
    answer_each(answers, thread_count, [&](std::size_t i) { return classify(map, points_local[i]); });
}

void contacts_batch(const ExactMapView& map, StridedSpan<const Vec3f> points_local, float margin,
                    std::span<Contact> contacts, unsigned thread_count) noexcept {
    stretched_contacts_batch(map, points_local, margin, contacts, {1, 1, 1}, thread_count);
}

void stretched_contacts_batch(const ExactMapView& map, const StridedSpan<const Vec3f>& points_local,
                              float margin, std::span<Contact> contacts, const Vec3d& stretch,
                              unsigned thread_count) noexcept {
    if (!is_met(points_local.size() == contacts.size(),
                "contacts_batch: the number of contacts differs from the number of points"))
        return;
    const ContactSearch search(map, stretch, margin);
    for_each_piece(contacts.size(), thread_count, [&](std::size_t begin, std::size_t end) {
        if (use_kernels()) {
            try {
                find_contacts(search, points_local.subspan(begin, end - begin),
                              contacts.subspan(begin, end - begin));
                return;
            } catch (const std::bad_alloc&) { // the reference needs no memory
            }
        }
        for (std::size_t i = begin; i < end; ++i) contacts[i] = search(points_local[i]);
    });
}

namespace {

ContactSearch search_everywhere(const ExactMapView& map) {
    return {map, {1, 1, 1}, std::numeric_limits<float>::infinity()};
}

} // namespace

float winding_number(const ExactMapView& map, Vec3f point_local, float tolerance) noexcept {
    if (has_nan(point_local)) return std::numeric_limits<float>::quiet_NaN();
    const double wanted = tolerance > 0 ? double{tolerance} : 0;
    return static_cast<float>(winding_number_at(map, frame_of(map), point_local, wanted));
}

void winding_number_batch(const ExactMapView& map, StridedSpan<const Vec3f> points_local,
                          std::span<float> windings, float tolerance, unsigned thread_count) noexcept {
    if (!is_met(points_local.size() == windings.size(),
                "winding_number_batch: the number of winding numbers differs from the number of points"))
        return;
    answer_each(windings, thread_count,
                [&](std::size_t i) { return winding_number(map, points_local[i], tolerance); });
}

float signed_distance(const ExactMapView& map, Vec3f point_local, Vec3f* gradient) noexcept {
    const Contact contact = find_contact(search_everywhere(map), point_local);
    if (gradient != nullptr) *gradient = contact.normal;
    return contact.face == kNoIndex ? signed_distance_without_contact(point_local) : -contact.depth;
}

void signed_distance_batch(const ExactMapView& map, StridedSpan<const Vec3f> points_local,
                           std::span<float> distances, std::span<Vec3f> gradients,
                           unsigned thread_count) noexcept {
    if (!is_met(points_local.size() == distances.size(),
                "signed_distance_batch: the number of distances differs from the number of points"))
        return;
    if (!is_met(gradients.empty() || gradients.size() == distances.size(),
                "signed_distance_batch: the number of gradients differs from the number of points"))
        return;
    const ContactSearch search = search_everywhere(map);
    for_each_piece(distances.size(), thread_count, [&](std::size_t begin, std::size_t end) {
        const StridedSpan<const Vec3f> points = points_local.subspan(begin, end - begin);
        const std::span<Vec3f> wanted_gradients =
            gradients.empty() ? gradients : gradients.subspan(begin, end - begin);
        if (use_kernels()) {
            try {
                find_signed_distances(search, points, distances.subspan(begin, end - begin),
                                      wanted_gradients);
                return;
            } catch (const std::bad_alloc&) { // the reference needs no memory
            }
        }
        for (std::size_t i = begin; i < end; ++i)
            distances[i] = signed_distance(map, points_local[i], gradients.empty() ? nullptr : &gradients[i]);
    });
}

namespace {

std::vector<std::uint32_t> longest_lists(const ExactMapView& map) {
    std::vector<std::uint32_t> longest(map.face_count());
    for (std::size_t band = 0; band + 1 < map.bands.size(); ++band) {
        const std::uint32_t first = map.bands[band].first_reference;
        const std::uint32_t last = map.bands[band + 1].first_reference;
        for (std::uint32_t r = first; r < last; ++r) {
            std::uint32_t& length = longest[map.references[r]];
            length = std::max(length, last - first);
        }
    }
    return longest;
}

} // namespace

ExactMapSurface reconstruct_surface(const ExactMapView& map) {
    ExactMapSurface surface;
    surface.mesh.origin = map.origin;
    const LatticeFrame frame = frame_of(map);
    for (const Vec3<std::int32_t>& vertex : map.vertices)
        surface.mesh.vertices.push_back(Vec3f(frame.to_local(Vec3d(vertex))));
    for (std::size_t face = 0; face < map.face_count(); ++face)
        surface.mesh.faces.push_back(
            {map.corners[3 * face], map.corners[3 * face + 1], map.corners[3 * face + 2]});
    surface.longest_list = longest_lists(map);
    return surface;
}

} // namespace echinus
