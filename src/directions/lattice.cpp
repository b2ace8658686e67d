#include "directions/lattice.hpp"

#include "directions/face_cone.hpp"
#include "files/text.hpp"
#include "mesh/require_valid.hpp"
#include "mesh/seams.hpp"

#include <echinus/error.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace echinus {

namespace {

/// The smallest float that is not less than the distance of any point from the centre.
float enclosing_radius(std::span<const Vec3f> points, const Vec3f& centre) {
    double radius_sq = 0;
    for (const Vec3f& point : points) {
        const Vec3d d = Vec3d(point) - Vec3d(centre);
        radius_sq = std::max(radius_sq, dot(d, d));
    }
    const float radius = static_cast<float>(std::sqrt(radius_sq));
    const bool too_small = static_cast<double>(radius) * radius < radius_sq; // the product is exact
    return too_small ? std::nextafter(radius, std::numeric_limits<float>::infinity()) : radius;
}

/// Outside these bounds, squares of lengths leave the range of float.
void require_usable(float radius) {
    if (radius == 0)
        throw Error(ErrorCode::InvalidMesh,
                    "all vertices of the mesh lie on one point, so that it has no inside");
    constexpr float kSmallest = 1e-15F;
    constexpr float kLargest = 1e15F;
    if (radius >= kSmallest && radius <= kLargest) return;
    throw Error(ErrorCode::InvalidMesh, "the mesh has a bounding radius of " + number_text(radius) +
                                            ", outside [" + number_text(kSmallest) + ", " +
                                            number_text(kLargest) + "]; choose another unit");
}

/// Does the origin lie on the line through one of the face's edges, or on the face itself?
bool touches_origin(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c) {
    const LatticePoint bc = cross(b, c);
    if (dot(a, bc) != 0) return false; // not in the face's plane
    const LatticePoint ab = cross(a, b);
    const LatticePoint ca = cross(c, a);
    const LatticePoint zero{};
    if (ab == zero || bc == zero || ca == zero) return true;
    // In the face's plane the three normals are parallel; all point the same way if and only if the origin is
    // inside.
    const int sign = sign_of_perturbation(ab);
    return sign_of_perturbation(bc) == sign && sign_of_perturbation(ca) == sign;
}

bool touches_origin(const LatticeMesh& lattice) {
    return std::any_of(lattice.faces.begin(), lattice.faces.end(), [&](const Triangle& face) {
        return touches_origin(lattice.vertices[face[0]], lattice.vertices[face[1]],
                              lattice.vertices[face[2]]);
    });
}

/// A step that changes the float coordinates of the centre: a lattice step, or more if float is coarser than
/// the lattice.
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

std::vector<LatticePoint> lattice_directions(const std::vector<Vec3d>& units) {
    std::vector<LatticePoint> result;
    result.reserve(units.size());
    for (const Vec3d& unit : units) result.push_back(lattice_direction(unit));
    return result;
}

void LatticeSnapper::require_valid(std::span<const Vec3f> vertices) {
    require_numberable(faces_.size(), vertices.size());
    if (!used_ || used_->vertex_count() != vertices.size()) used_.emplace(faces_, vertices.size());
    used_->require_valid(vertices, faces_);
    if (!open_vertices_) open_vertices_ = find_open_vertices(faces_, vertices.size());
}

/// Finds the seams of an open surface.
void LatticeSnapper::find_seams(std::span<const Vec3f> vertices, double bounding_radius) {
    joined_vertices_ = join_near_vertices(vertices, *open_vertices_, seam_width(bounding_radius));
}

void LatticeSnapper::snap(std::span<const Vec3f> vertices, LatticeMesh& result) {
    require_valid(vertices);
    const Sphere sphere = smallest_enclosing_sphere(used_->positions(vertices, positions_));
    if (!faces_are_closed()) find_seams(vertices, sphere.radius);
    snap_valid(vertices, Vec3f(sphere.centre), result);
}

void LatticeSnapper::snap(std::span<const Vec3f> vertices, const Vec3f& centre, LatticeMesh& result) {
    require_valid(vertices);
    if (!faces_are_closed())
        find_seams(vertices, smallest_enclosing_sphere(used_->positions(vertices, positions_)).radius);
    snap_valid(vertices, centre, result);
}

void LatticeSnapper::snap_valid(std::span<const Vec3f> vertices, const Vec3f& wanted_centre,
                                LatticeMesh& result) {
    const std::span<const Vec3f> points = used_->positions(vertices, positions_);
    const float radius = enclosing_radius(points, wanted_centre);
    require_usable(radius);
    snap_around(vertices, wanted_centre, radius, result);
    const double step = centre_step(result);
    // A plane or a line excludes at most three points of the curve (t, t^2, t^3), so the loop ends; the first
    // attempt nearly always succeeds.
    for (double t = 1; touches_origin(result); ++t) {
        const Vec3f centre(Vec3d(wanted_centre) + Vec3d{t, t * t, t * t * t} * step);
        snap_around(vertices, centre, enclosing_radius(points, centre), result);
    }
}

void LatticeSnapper::snap_around(std::span<const Vec3f> vertices, const Vec3f& centre, float radius,
                                 LatticeMesh& result) const {
    result.centre = centre;
    result.radius = radius;
    result.frame = LatticeFrame(centre, radius);
    result.vertices.resize(vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i)
        result.vertices[i] = (*used_)[i] ? result.snap(vertices[i]) : LatticePoint{};
    for (std::size_t i = 0; i < joined_vertices_.size(); ++i)
        result.vertices[(*open_vertices_)[i]] = result.vertices[joined_vertices_[i]];
    result.faces.resize(faces_.size());
    result.face_numbers.resize(faces_.size());
    std::size_t kept = 0;
    for (std::size_t i = 0; i < faces_.size(); ++i) {
        const Triangle face = faces_[i];
        result.faces[kept] = face;
        result.face_numbers[kept] = static_cast<std::uint32_t>(i); // smaller than kMostFaces
        kept += is_collapsed(result.corners(static_cast<std::uint32_t>(kept))) ? 0 : 1;
    }
    result.faces.resize(kept);
    result.face_numbers.resize(kept);
}

LatticeMesh snap_to_lattice(const TriangleMesh& mesh) {
    LatticeMesh lattice;
    LatticeSnapper(mesh.faces).snap(mesh.vertices, lattice);
    return lattice;
}

LatticeMesh snap_to_lattice(const TriangleMesh& mesh, const Vec3f& centre) {
    LatticeMesh lattice;
    LatticeSnapper(mesh.faces).snap(mesh.vertices, centre, lattice);
    return lattice;
}

void snap_at_lowest_cost(LatticeSnapper& snapper, std::span<const Vec3f> vertices,
                         const std::function<double(const LatticeMesh&)>& cost_of, LatticeMesh& best) {
    snapper.snap(vertices, best);
    double best_cost = cost_of(best);
    const double radius = best.radius;
    LatticeMesh other;
    for (double step : {0.25, 0.125, 0.0625}) {
        const Vec3d start(best.centre);
        for (const Vec3d& side : {Vec3d{1, 0, 0}, Vec3d{-1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, -1, 0},
                                  Vec3d{0, 0, 1}, Vec3d{0, 0, -1}}) {
            snapper.snap(vertices, Vec3f(start + side * (step * radius)), other);
            const double cost = cost_of(other);
            if (!(cost < best_cost)) continue;
            best_cost = cost;
            std::swap(best, other);
        }
    }
}

} // namespace echinus
