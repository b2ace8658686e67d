#pragma once

#include <echinus/error.hpp>
#include <echinus/map_file.hpp>

#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace echinus::test {

/// Points in and around a map's sphere, on its seam and poles, and those that are no points at all.
inline std::vector<Vec3f> telling_points(const DistanceMapView& map) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    std::vector<Vec3f> points{map.centre, {0, 0, 0}, {kNan, 0, 0}, {kInfinity, 0, 0}, {3e38F, 3e38F, -3e38F}};
    for (const float fraction : {0.0F, 1e-30F, 0.25F, 0.5F, 0.9999F, 1.0F, 1.5F}) {
        const float r = map.radius * fraction;
        for (const Vec3f& d : {Vec3f{r, 0, 0}, Vec3f{-r, -0.0F, 0}, Vec3f{0, r, 0}, Vec3f{0, 0, r},
                               Vec3f{0, 0, -r}, Vec3f{r * 0.3F, r * -0.4F, r * 0.6F}}) {
            points.push_back(map.centre + d);
        }
    }
    return points;
}

/// What a reader of hostile bytes must do: refuse them with an Error, or give a map that can be queried
/// anywhere, looked at, and written again so that it reads back the same.
/// @return  whether the bytes were taken as a map
/// @throws std::logic_error when it does something else
inline bool attack_map_file(std::span<const std::byte> bytes) {
    // A buffer of exactly this size: the address sanitizer sees every read beyond it.
    const auto storage = std::make_shared<std::vector<std::byte>>(bytes.begin(), bytes.end());
    storage->shrink_to_fit();
    std::optional<DistanceMap> map;
    try {
        map = load_distance_map(*storage, storage, "attacked");
    } catch (const Error& error) {
        const std::string sentence = error.what();
        const bool proper = sentence.starts_with("attacked: ") && sentence.find('\n') == std::string::npos;
        if (!proper) throw std::logic_error("not a proper sentence: " + sentence);
        return false;
    }
    const std::vector<Vec3f> points = telling_points(*map);
    std::vector<Contact> contacts(points.size());
    contacts_batch(*map, points, map->view().radius, contacts);
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (contacts[i].inside != contains(*map, points[i])) {
            throw std::logic_error("contact and contains disagree");
        }
    }
    std::size_t direction_count = 0;
    for (const std::size_t count : entry_histogram(*map)) direction_count += count;
    if (direction_count != map->view().direction_count()) throw std::logic_error("histogram is not complete");

    const std::vector<std::byte> written = serialise(*map);
    if (serialise(load_distance_map(written, nullptr, "written")) != written) {
        throw std::logic_error("what was written does not read back the same");
    }
    return true;
}

} // namespace echinus::test
