#pragma once

#include "exact_map/query/stretched_contact.hpp"

#include <echinus/error.hpp>
#include <echinus/map_file.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

namespace echinus::test {

/// Points in and around a map's sphere, on its seam and poles, and points that are not finite.
inline std::vector<Vec3f> telling_points(const Vec3f& centre, float radius) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    std::vector<Vec3f> points{centre, {0, 0, 0}, {kNan, 0, 0}, {kInfinity, 0, 0}, {3e38F, 3e38F, -3e38F}};
    for (const float fraction : {0.0F, 1e-30F, 0.25F, 0.5F, 0.9999F, 1.0F, 1.5F}) {
        const float r = radius * fraction;
        for (const Vec3f& d : {Vec3f{r, 0, 0}, Vec3f{-r, -0.0F, 0}, Vec3f{0, r, 0}, Vec3f{0, 0, r},
                               Vec3f{0, 0, -r}, Vec3f{r * 0.3F, r * -0.4F, r * 0.6F}}) {
            points.push_back(centre + d);
        }
    }
    return points;
}

/// The same, plus points on, inside and beyond the surface along the lines from the centre to some vertices.
inline std::vector<Vec3f> telling_points(const ExactMapView& map) {
    std::vector<Vec3f> points = telling_points(map.centre, map.radius);
    const float step = map.radius / 524288; // of the lattice
    const std::size_t stride = 1 + map.vertices.size() / 6;
    for (std::size_t i = 0; i < map.vertices.size(); i += stride)
        for (const float factor : {0.97F, 1.0F, 1.03F})
            points.push_back(map.centre + Vec3f(map.vertices[i]) * (step * factor));
    return points;
}

inline void demand(bool holds, const char* what) {
    if (!holds) throw std::logic_error(what);
}

inline void attack_map(const DistanceMap& map) {
    const std::vector<Vec3f> points = telling_points(map.view().centre, map.view().radius);
    std::vector<Contact> contacts(points.size());
    contacts_batch(map.view(), points, map.view().radius, contacts);
    std::vector<std::uint8_t> inside(points.size());
    contains_batch(map.view(), points, inside);
    for (std::size_t i = 0; i < points.size(); ++i) {
        demand(contacts[i].inside == contains(map.view(), points[i]), "contact and contains disagree");
        demand(inside[i] == (contacts[i].inside ? 1 : 0), "contains_batch and contact disagree");
    }
    std::size_t direction_count = 0;
    for (const std::size_t count : entry_histogram(map)) direction_count += count;
    demand(direction_count == map.view().direction_count(), "histogram is not complete");
}

/// A map whose bands contradict its faces may answer two queries differently; agreement of batches and single
/// queries is tested elsewhere, on sound maps only.
inline void attack_map(const ExactMap& map) {
    const ExactMapView& view = map.view();
    const std::vector<Vec3f> points = telling_points(view);
    std::vector<std::uint8_t> inside(points.size());
    contains_batch(view, points, inside);
    std::vector<Contact> contacts(points.size());
    contacts_batch(view, points, view.radius, contacts);
    stretched_contacts_batch(view, points, view.radius * 0.01F, contacts, {2, -1, 0.5});
    stretched_contacts_batch(view, points, 3e38F, contacts, {1e-3, 1, 1e3});
    stretched_contacts_batch(view, points, 0, contacts, {1e-300, 1e300, 1});
    for (std::size_t i = 0; i < points.size(); ++i) {
        demand(classify(view, points[i]).inside == contains(view, points[i]),
               "classify and contains disagree");
        for (const std::size_t stride : {1, 7}) {
            const SweepHit hit = sweep(view, points[i], points[(i + stride) % points.size()]);
            demand(hit.fraction >= 0 && hit.fraction <= 1, "a sweep ends beyond its way");
        }
    }
}

/// A reader of hostile bytes must either refuse them with an Error, or give a map that can be queried
/// anywhere, inspected, and written again so that it reads back the same.
/// @return  whether the bytes were taken as a map
/// @throws std::logic_error when it does neither
inline bool attack_map_file(std::span<const std::byte> bytes) {
    // A buffer of exactly this size: the address sanitizer sees every read beyond it.
    const auto storage = std::make_shared<std::vector<std::byte>>(bytes.begin(), bytes.end());
    storage->shrink_to_fit();
    std::unique_ptr<const AnyMap> map;
    try {
        map = std::make_unique<const AnyMap>(load_map(*storage, storage, "attacked"));
    } catch (const Error& error) {
        const std::string sentence = error.what();
        const bool proper = sentence.starts_with("attacked: ") && sentence.find('\n') == std::string::npos;
        if (!proper) throw std::logic_error("not a proper sentence: " + sentence);
        return false;
    }
    std::visit([](const auto& kind) { attack_map(kind); }, *map);
    const std::vector<std::byte> written = serialise(*map);
    demand(serialise(load_map(written, nullptr, "written")) == written,
           "what was written does not read back the same");
    return true;
}

} // namespace echinus::test
