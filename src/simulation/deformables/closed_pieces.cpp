#include "simulation/deformables/closed_pieces.hpp"

#include "geometry/union_find.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <span>

namespace echinus {

namespace {

/// A share of the cube of a piece's extent: a smaller volume is only rounding.
constexpr double kLeastVolume = 1e-6;

std::vector<Triangle> faces_of_cloth(const Deformable& deformable) {
    std::vector<bool> is_body(deformable.particle_count());
    for (const ElasticTetrahedron& tetrahedron : deformable.tetrahedra)
        for (const std::uint32_t particle : tetrahedron.particles) is_body[particle] = true;
    std::vector<Triangle> cloth;
    for (const Triangle& face : deformable.faces)
        if (!is_body[face[0]] || !is_body[face[1]] || !is_body[face[2]]) cloth.push_back(face);
    return cloth;
}

/// Six times the volume of a piece, with its sign.
struct Volume {
    double sixfold = 0, area = 0;

    void add(const Triangle& face, std::span<const Vec3f> places, const Vec3d& origin) {
        const Vec3d a = Vec3d(places[face[0]]) - origin, b = Vec3d(places[face[1]]) - origin,
                    c = Vec3d(places[face[2]]) - origin;
        sixfold += dot(a, cross(b, c));
        area += length(cross(b - a, c - a));
    }
    bool is_some() const { return std::abs(sixfold) > kLeastVolume * area * std::sqrt(area); }
};

} // namespace

std::vector<Triangle> closed_pieces(const Deformable& deformable) {
    std::vector<Triangle> faces = faces_of_cloth(deformable);
    UnionFind pieces(deformable.particle_count());
    struct Sides {
        int count = 0, turn = 0;
    };
    std::map<std::array<std::uint32_t, 2>, Sides> edges;
    for (const Triangle& face : faces)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = face[k], b = face[(k + 1) % 3];
            pieces.join(a, b);
            Sides& sides = edges[{std::min(a, b), std::max(a, b)}];
            ++sides.count;
            sides.turn += a < b ? 1 : -1;
        }
    std::vector<bool> is_open(deformable.particle_count());
    for (const auto& [ends, sides] : edges)
        if (sides.count != 2 || sides.turn != 0) is_open[pieces.find(ends[0])] = true;
    std::erase_if(faces, [&](const Triangle& face) { return is_open[pieces.find(face[0])]; });

    const std::vector<Vec3f>& rest =
        deformable.rest_positions.empty() ? deformable.positions : deformable.rest_positions;
    std::map<std::uint32_t, std::array<Volume, 2>> volumes; // at rest and at the start, by piece
    for (const Triangle& face : faces) {
        const std::uint32_t piece = pieces.find(face[0]);
        auto& [at_rest, at_start] = volumes[piece];
        at_rest.add(face, rest, Vec3d(rest[piece]));
        at_start.add(face, deformable.positions, Vec3d(deformable.positions[piece]));
    }
    for (Triangle& face : faces) {
        const auto& [at_rest, at_start] = volumes[pieces.find(face[0])];
        const Volume& volume = at_rest.is_some() ? at_rest : at_start;
        if (volume.is_some() && volume.sixfold < 0) std::swap(face[1], face[2]);
    }
    return faces;
}

} // namespace echinus
