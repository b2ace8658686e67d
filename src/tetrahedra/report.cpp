#include "geometry/elementary.hpp"
#include "geometry/orientation.hpp"
#include "tetrahedra/tetrahedron_faces.hpp"

#include <echinus/error.hpp>
#include <echinus/tetrahedra.hpp>

#include <algorithm>
#include <limits>
#include <numbers>
#include <string>

namespace echinus {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Extremes {
    double least = kInfinity, greatest = -kInfinity;

    void add(double value) {
        least = std::min(least, value);
        greatest = std::max(greatest, value);
    }
};

using Corners = std::array<Vec3d, 4>;

Corners corners_of(const TetrahedralMesh& mesh, const Tetrahedron& tetrahedron) {
    Corners corners;
    for (std::size_t i = 0; i < 4; ++i) corners[i] = Vec3d(mesh.vertices[tetrahedron[i]]);
    return corners;
}

/// The dihedral angle at the edge from a to b; c and d are the other two corners.
double angle_at_edge(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
    const Vec3d to_c = cross(b - a, c - a), to_d = cross(b - a, d - a);
    return portable_atan2(length(cross(to_c, to_d)), dot(to_c, to_d));
}

void add_edges(const Corners& p, Extremes& lengths, Extremes& angles) {
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = i + 1; j < 4; ++j) {
            const std::size_t k = i != 0 ? 0 : j != 1 ? 1 : 2, l = 6 - i - j - k;
            lengths.add(length(p[j] - p[i]));
            angles.add(angle_at_edge(p[i], p[j], p[k], p[l]));
        }
}

std::size_t count_used(const TetrahedralMesh& mesh) {
    std::vector<std::uint8_t> is_used(mesh.vertices.size());
    for (const Tetrahedron& tetrahedron : mesh.tetrahedra)
        for (const std::uint32_t vertex : tetrahedron) is_used[vertex] = 1;
    return static_cast<std::size_t>(std::count(is_used.begin(), is_used.end(), 1));
}

} // namespace

TetrahedralReport inspect_tetrahedra(const TetrahedralMesh& mesh) {
    require_valid_tetrahedra(mesh);
    Extremes lengths, angles, volumes;
    double volume = 0;
    for (std::size_t number = 0; number < mesh.tetrahedra.size(); ++number) {
        add_edges(corners_of(mesh, mesh.tetrahedra[number]), lengths, angles);
        volumes.add(tetrahedron_volume(mesh, number));
        volume += tetrahedron_volume(mesh, number);
    }
    constexpr double kDegrees = 180 / std::numbers::pi;
    return {mesh.tetrahedra.size(),
            count_used(mesh),
            volume,
            volumes.least,
            lengths.least,
            lengths.greatest,
            angles.least * kDegrees,
            angles.greatest * kDegrees,
            inspect(boundary(mesh))};
}

void require_valid_tetrahedra(const TetrahedralMesh& mesh) {
    if (mesh.tetrahedra.empty()) throw Error(ErrorCode::InvalidMesh, "the body has no tetrahedra");
    require_indices(mesh);
    for (std::size_t number = 0; number < mesh.tetrahedra.size(); ++number) {
        const Tetrahedron& corners = mesh.tetrahedra[number];
        for (const std::uint32_t vertex : corners)
            if (!is_finite(mesh.vertices[vertex]))
                throw Error(ErrorCode::InvalidMesh, "vertex " + std::to_string(vertex) + " of tetrahedron " +
                                                        std::to_string(number) + " is not finite");
        const auto corner = [&](int i) { return mesh.vertices[corners[i]]; };
        // orientation() is 1 if the first three turn clockwise seen from the last.
        const int side = orientation(corner(0), corner(1), corner(2), corner(3));
        if (side == 0)
            throw Error(ErrorCode::InvalidMesh,
                        "tetrahedron " + std::to_string(number) + " is flat; leave it out");
        if (side > 0)
            throw Error(ErrorCode::InvalidMesh, "tetrahedron " + std::to_string(number) +
                                                    " has a negative volume; exchange two of its corners");
    }
    sorted_face_uses(mesh); // throws if two tetrahedra overlap at a face
}

} // namespace echinus
