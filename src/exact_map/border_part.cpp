#include "exact_map/border_part.hpp"

#include "directions/face_cone.hpp"

#include <cmath>
#include <numbers>

namespace echinus {

namespace {

/// A hair's breadth in the direction in which the perturbation (e, e^2, e^3) leads away from a ray first.
Vec3d nudge_from_ray(const LatticePoint& d) {
    constexpr double kHair =
        0x1p-22; // lattice steps: less than what parts lattice points from rays, more than rounding
    // At the origin, the tip of all cone triangles, only the direction matters: it has to pass by their
    // sides.
    if (d == LatticePoint{}) return {0x1p-10, 0x1p-31, 0x1p-52};
    const bool along_x = d.y == 0 && d.z == 0;
    return along_x ? Vec3d{0, kHair, 0} : Vec3d{kHair, 0, 0};
}

/// Solid angle of the cone triangle (origin, a, b) seen from share * d. On which side of it that lies, where
/// the angle jumps by a full turn, is decided exactly, and so is whether it lies in the triangle's plane.
/// There, and above all on its sides through the origin, where rays through border vertices run, the place is
/// nudged, so that the two triangles on both sides of such a ray add up. Van Oosterom and Strackee 1983, as
/// in mesh/winding_number.cpp.
double cone_solid_angle(const LatticePoint& a, const LatticePoint& b, const LatticePoint& d, double share) {
    const LatticePoint normal = cross(a, b);
    const std::int64_t volume = -dot(d, normal);
    const Vec3d nudge = volume == 0 ? nudge_from_ray(d) : Vec3d{};
    const Vec3d p = Vec3d(d) * share + nudge;
    const Vec3d pa = Vec3d(a) - p, pb = Vec3d(b) - p, po = p * -1.0;
    const double la = length(pa), lb = length(pb), lo = length(po);
    const double numerator =
        volume == 0 ? std::fabs(dot(nudge, Vec3d(normal))) : share * std::fabs(static_cast<double>(volume));
    const double denominator = la * lb * lo + dot(pa, pb) * lo + dot(pb, po) * la + dot(po, pa) * lb;
    const double angle = 2 * std::atan2(numerator, denominator);
    const bool positive = volume != 0 ? volume > 0 : sign_of_perturbation(normal) < 0;
    return positive ? angle : -angle;
}

} // namespace

double border_part(std::span<const BorderEdge> border, std::span<const Vec3<std::int32_t>> vertices,
                   const LatticePoint& d, double share) {
    double sum = 0;
    for (const BorderEdge& edge : border)
        sum += edge.multiplicity *
               cone_solid_angle(LatticePoint(vertices[edge.a]), LatticePoint(vertices[edge.b]), d, share);
    return sum / (4 * std::numbers::pi);
}

} // namespace echinus
