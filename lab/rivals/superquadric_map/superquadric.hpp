#pragma once

#include "directions/lattice.hpp"
#include "directions/spherical_grid.hpp"
#include "geometry/elementary.hpp"

#include <echinus/geometry.hpp>
#include <echinus/mesh.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace echinus::rivals {

/// ln(e^a + e^b) without overflow; minus infinity stands for ln 0.
inline double log_of_sum(double a, double b) {
    const double largest = std::max(a, b);
    if (std::isinf(largest)) return largest;
    return largest + std::log1p(std::exp(std::min(a, b) - largest));
}

/// The terms of a superquadric's inside-outside function as logarithms: powers of 2 / 0.1 = 20 leave the
/// range of floating point long before the place is far away.
struct LogPowers {
    double x, y, z; ///< of (x / a1)^(2/e2), (y / a2)^(2/e2), (z / a3)^(2/e1)
    double section; ///< of the sum of the first two
    double disc;    ///< of that sum to the power e2 / e1
    double whole;   ///< of F

    LogPowers(const Vec3d& place, const Vec3d& sizes, double eta_exponent, double omega_exponent)
        : x(2 / omega_exponent * std::log(std::fabs(place.x) / sizes.x)),
          y(2 / omega_exponent * std::log(std::fabs(place.y) / sizes.y)),
          z(2 / eta_exponent * std::log(std::fabs(place.z) / sizes.z)), section(log_of_sum(x, y)),
          disc(omega_exponent / eta_exponent * section), whole(log_of_sum(disc, z)) {}
};

// Superquadrics, or superellipsoids (Barr, "Superquadrics and angle-preserving transformations", IEEE
// Computer Graphics and Applications 1(1), 1981): with powers that keep the sign, the points
//
//     r(eta, omega) = (a1 cos^e1(eta) cos^e2(omega), a2 cos^e1(eta) sin^e2(omega), a3 sin^e1(eta))
//
// for eta in [-pi/2, pi/2] and omega in [-pi, pi), or where the inside-outside function
//
//     F(x, y, z) = ((x / a1)^(2/e2) + (y / a2)^(2/e2))^(e2/e1) + (z / a3)^(2/e1)
//
// is 1. Exponents near 0 give boxes and cylinders, 1 ellipsoids, 2 double pyramids; all of these are convex.

/// Coordinates on a superquadric, radians. They are not angles of space unless both exponents are 1.
struct SuperquadricAngles {
    double eta;   ///< latitude in [-pi/2, pi/2]
    double omega; ///< longitude in [-pi, pi]
};

struct Superquadric {
    /// Beyond them fits are ill-conditioned or the solid is not convex (Solina and Bajcsy 1990, section III).
    static constexpr double kMinExponent = 0.1, kMaxExponent = 2;

    Vec3d centre;              ///< in the frame of the points that were fitted
    Rotation rotation;         ///< from the superquadric's frame to theirs
    Vec3d sizes{1, 1, 1};      ///< a1, a2, a3: half the extents along its own axes
    double eta_exponent = 1;   ///< e1: of the profile, along the z axis
    double omega_exponent = 1; ///< e2: of the cross-section

    Vec3d to_frame(const Vec3d& point) const { return rotation.inverse().apply(point - centre); }
    Vec3d from_frame(const Vec3d& place) const { return rotation.apply(place) + centre; }

    /// ln F, which stays finite where F itself, with powers up to 20, does not; minus infinity at the centre.
    /// @param place  in the superquadric's frame
    double log_inside_outside(const Vec3d& place) const;

    /// By which a place has to be multiplied to lie on the surface: F^(-e1/2). Infinity at the centre.
    double factor_to_surface(const Vec3d& place) const;

    /// Distance of a point from the surface along the ray from the centre, negative inside: |p| (1 -
    /// F^(-e1/2)), the error of fit of Gross and Boult, "Error of fit measures for recovering parametric
    /// solids", ICCV 1988.
    /// @param point  in the frame of the points that were fitted; not the centre itself
    double radial_distance(const Vec3d& point) const;

    /// Where the ray from the centre through a place meets the surface; (0, 0) at the centre.
    SuperquadricAngles angles_of(const Vec3d& place) const;

    /// r(eta, omega), in the superquadric's frame.
    Vec3d surface_point(const SuperquadricAngles& angles) const;
};

/// sign(base) |base|^exponent.
double signed_power(double base, double exponent);

/// The surface as triangles, closed and outward, for pictures and tests.
/// @param eta_count    rows of faces between the poles, at least 2
/// @param omega_count  faces of a row, at least 3
TriangleMesh tessellate(const Superquadric& shape, std::uint32_t eta_count, std::uint32_t omega_count);

/// A point of a superellipse with half axes 1: the cosine and sine of an angle to the power of an exponent.
struct ProfilePoint {
    double cosine, sine;
};
/// The angle eta of a row of samples. Rows run down from the pole of +z.
inline CirclePoint eta_of_row(std::uint32_t row, std::uint32_t row_count) {
    const CirclePoint from_pole = circle_point(2 * std::uint64_t{row} + 1, 4 * std::uint64_t{row_count});
    return {from_pole.sine, from_pole.cosine};
}
ProfilePoint profile_point(const CirclePoint& angle, double exponent);

/// The samples of a superquadric's grid as points of its surface, in its frame, by index in the grid.
std::vector<Vec3d> sample_points(const Superquadric& shape, const SphericalGrid& grid);

/// How far from the centre each ray crosses a face of the segment for the last time or, where it crosses
/// none, a face of its hull, in the mesh's unit; negative where it misses both. The rays run from the
/// lattice's origin through the sample points; which faces they meet is decided exactly.
/// @param lattice         the segment, around the superquadric's centre
/// @param own_face_count  so many faces are the segment's, the others the hull's
/// @param shape           gives the samples' frame
std::vector<float> outermost_crossings(const LatticeMesh& lattice, std::size_t own_face_count,
                                       const Superquadric& shape, const SphericalGrid& grid,
                                       const std::vector<Vec3d>& sample_points);

} // namespace echinus::rivals
