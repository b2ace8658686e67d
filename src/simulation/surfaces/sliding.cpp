#include "simulation/surfaces/sliding.hpp"

#include <array>
#include <cmath>

namespace echinus {

namespace {

template <typename Visit>
void for_each_face_at(const Ridge& ridge, const Elements& elements, const Visit& visit) {
    for (const std::uint32_t number : elements.at(ridge.a)) {
        const Element& element = elements.all[number];
        if (element.is_face() && element.has(ridge.b)) visit(element.vertices);
    }
}

bool rise_above(const Ridge& ridge, const Elements& elements, const PointArrays& positions,
                const Vec3f& normal) {
    constexpr float kFlat = 1e-3F; // the sine of an angle
    bool rise = false;
    for_each_face_at(ridge, elements, [&](const std::array<std::uint32_t, 3>& face) {
        for (const std::uint32_t vertex : face) {
            const Vec3f away = positions[vertex] - positions[ridge.a];
            rise = rise || (vertex != ridge.b && dot(normal, away) > kFlat * length(away));
        }
    });
    return rise;
}

Vec3f across_of(const std::array<std::uint32_t, 3>& face, const PointArrays& positions) {
    const Vec3f a = positions[face[0]];
    return cross(positions[face[1]] - a, positions[face[2]] - a);
}

/// Of the faces there the normal, from either side, that is most like another one; 0 if they have no area.
Vec3f face_normal(const Ridge& ridge, const Elements& elements, const PointArrays& positions,
                  const Vec3f& like) {
    Vec3f best;
    for_each_face_at(ridge, elements, [&](const std::array<std::uint32_t, 3>& face) {
        const Vec3f across = across_of(face, positions);
        const float size = length(across);
        if (!(size > 0)) return;
        const Vec3f normal = across * ((dot(across, like) > 0 ? 1 : -1) / size);
        if (dot(normal, like) > dot(best, like)) best = normal;
    });
    return best;
}

/// Is no face there turned against this one, from either side, by more than the angle with this cosine?
bool are_smooth(const Ridge& ridge, const Elements& elements, const PointArrays& positions,
                const Vec3f& normal, float cosine) {
    bool smooth = true;
    for_each_face_at(ridge, elements, [&](const std::array<std::uint32_t, 3>& face) {
        const Vec3f across = across_of(face, positions);
        smooth = smooth && std::fabs(dot(across, normal)) >= cosine * length(across);
    });
    return smooth;
}

} // namespace

std::optional<Ridge> ridge_of(std::span<const std::uint32_t> vertices, std::span<const float> weights) {
    constexpr float kNoShare = 1e-6F; // rounded: on an edge of a face the three sum up to 1
    std::optional<Ridge> ridge;
    std::size_t count = 0;
    for (std::size_t k = 0; k < vertices.size(); ++k) {
        if (std::fabs(weights[k]) < kNoShare) continue;
        ridge = {vertices[k], count == 0 ? vertices[k] : ridge->a};
        ++count;
    }
    return count < 3 ? ridge : std::nullopt;
}

Faces faces_at(const Ridge& ridge, const Elements& elements, const PointArrays& positions,
               const Passage& passage, const SlidingLimits& limits) {
    const auto& [normal, way] = passage;
    if (!rise_above(ridge, elements, positions, normal)) return Faces::Low;
    const Vec3f side = face_normal(ridge, elements, positions, normal);
    if (!are_smooth(ridge, elements, positions, side, limits.smoothness)) return Faces::Crumpled;
    const bool is_above = dot(side, normal) >= limits.least_height;
    return is_above && -dot(side, way) < limits.towards * -dot(normal, way) ? Faces::Passed : Faces::Low;
}

} // namespace echinus
