#include "directions/lattice.hpp"

#include "directions/crossing.hpp"
#include "mesh/used_vertices.hpp"

#include <echinus/error.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace echinus {

namespace {

/// The smallest float that is not below the distance of any point from the centre.
float enclosing_radius(const std::vector<Vec3f>& points, const Vec3f& centre) {
    double radius_sq = 0;
    for (const Vec3f& point : points) {
        const Vec3d d = Vec3d(point) - Vec3d(centre);
        radius_sq = std::max(radius_sq, dot(d, d));
    }
    const float radius = static_cast<float>(std::sqrt(radius_sq));
    const bool too_small = static_cast<double>(radius) * radius < radius_sq; // the product is exact
    return too_small ? std::nextafter(radius, std::numeric_limits<float>::infinity()) : radius;
}

/// Outside these bounds squares of lengths leave the range of float.
void require_usable(float radius) {
    if (radius == 0)
        throw Error(ErrorCode::InvalidMesh,
                    "all vertices of the mesh lie on one point, so that it has no inside");
    constexpr float kSmallest = 1e-15F;
    constexpr float kLargest = 1e15F;
    if (radius >= kSmallest && radius <= kLargest) return;
    std::ostringstream sentence;
    sentence << "the mesh has a bounding radius of " << radius << ", outside [" << kSmallest << ", "
             << kLargest << "]; choose another unit";
    throw Error(ErrorCode::InvalidMesh, sentence.str());
}

/// Does the origin lie on the line of one of the face's edges, or on the face itself?
bool touches_origin(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c) {
    const LatticePoint ab = cross(a, b);
    const LatticePoint bc = cross(b, c);
    const LatticePoint ca = cross(c, a);
    const LatticePoint zero{};
    if (ab == zero || bc == zero || ca == zero) return true;
    if (dot(a, bc) != 0) return false;
    // In the face's plane the three normals are parallel; they agree in direction exactly around the inside.
    const int sign = sign_of_perturbation(ab);
    return sign_of_perturbation(bc) == sign && sign_of_perturbation(ca) == sign;
}

bool touches_origin(const LatticeMesh& lattice) {
    return std::any_of(lattice.faces.begin(), lattice.faces.end(), [&](const Triangle& face) {
        return touches_origin(lattice.vertices[face[0]], lattice.vertices[face[1]],
                              lattice.vertices[face[2]]);
    });
}

LatticeMesh snap_around(const TriangleMesh& mesh, const std::vector<bool>& used, const Vec3f& centre,
                        float radius) {
    LatticeMesh lattice;
    lattice.centre = centre;
    lattice.radius = radius;
    lattice.frame = LatticeFrame(centre, radius);
    lattice.vertices.resize(mesh.vertices.size());
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
        if (used[i]) lattice.vertices[i] = lattice.snap(mesh.vertices[i]);
    for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
        lattice.faces.push_back(mesh.faces[i]);
        lattice.face_numbers.push_back(static_cast<std::uint32_t>(i));
        if (!is_collapsed(lattice.corners(static_cast<std::uint32_t>(lattice.faces.size() - 1)))) continue;
        lattice.faces.pop_back();
        lattice.face_numbers.pop_back();
    }
    return lattice;
}

/// A step that moves the centre's float coordinates: a lattice step, or more where float is coarser than the
/// lattice.
double centre_step(const LatticeMesh& lattice) {
    const Vec3f& c = lattice.centre;
    const float largest = std::max({std::fabs(c.x), std::fabs(c.y), std::fabs(c.z)});
    const float spacing = std::nextafter(largest, std::numeric_limits<float>::infinity()) - largest;
    return std::max(lattice.frame.step, static_cast<double>(spacing));
}

} // namespace

LatticePoint lattice_direction(const Vec3d& unit) {
    const Vec3d d = unit * static_cast<double>(kLatticeExtent);
    return rounded(d);
}

LatticeMesh snap_to_lattice(const TriangleMesh& mesh) {
    require_valid(mesh);
    return snap_to_lattice(mesh, Vec3f(smallest_enclosing_sphere(used_positions(mesh)).centre));
}

LatticeMesh snap_to_lattice(const TriangleMesh& mesh, const Vec3f& wanted_centre) {
    require_valid(mesh);
    const std::vector<bool> used = is_vertex_used(mesh);
    const std::vector<Vec3f> points = used_positions(mesh);
    const float radius = enclosing_radius(points, wanted_centre);
    require_usable(radius);
    LatticeMesh lattice = snap_around(mesh, used, wanted_centre, radius);
    const double step = centre_step(lattice);
    // Along the curve (t, t^2, t^3) a plane excludes at most three places and a line no more, so this ends;
    // the first try nearly always holds.
    for (double t = 1; touches_origin(lattice); ++t) {
        const Vec3f centre(Vec3d(wanted_centre) + Vec3d{t, t * t, t * t * t} * step);
        lattice = snap_around(mesh, used, centre, enclosing_radius(points, centre));
    }
    return lattice;
}

} // namespace echinus
