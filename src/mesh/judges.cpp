#include "geometry/elementary.hpp"
#include "mesh/faces.hpp"

#include <echinus/mesh.hpp>

#include <algorithm>
#include <limits>
#include <numbers>

namespace echinus {

namespace {

/// Signed solid angle of a triangle seen from the origin, after van Oosterom and Strackee, "The Solid Angle
/// of a Plane Triangle" (1983): tan(angle / 2) = a.(b x c) / (|a||b||c| + (a.b)|c| + (b.c)|a| + (c.a)|b|).
/// Positive if the triangle is clockwise seen from the origin, which is then behind it.
double solid_angle(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const double la = length(a);
    const double lb = length(b);
    const double lc = length(c);
    return 2 * portable_atan2(dot(a, cross(b, c)),
                              la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
}

} // namespace

double winding_number(std::span<const Vec3f> vertices, std::span<const Triangle> faces, const Vec3d& point) {
    double sum = 0;
    for (const Triangle& face : faces)
        sum += solid_angle(Vec3d(vertices[face[0]]) - point, Vec3d(vertices[face[1]]) - point,
                           Vec3d(vertices[face[2]]) - point);
    return sum / (4 * std::numbers::pi);
}

double winding_number(const TriangleMesh& mesh, const Vec3d& point) {
    return winding_number(mesh.vertices, mesh.faces, point);
}

namespace {

double segment_distance(const Vec3d& a, const Vec3d& b, const Vec3d& point) {
    const Vec3d ab = b - a;
    const double ab_sq = dot(ab, ab);
    const double t = ab_sq > 0 ? std::clamp(dot(point - a, ab) / ab_sq, 0.0, 1.0) : 0.0;
    return length(point - (a + ab * t));
}

/// The distance to the nearest of the three edges or, if the point projects into the triangle, to its plane.
/// Triangles without area need no special case: they consist of their edges.
double triangle_distance(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& point) {
    const Vec3d normal = cross(b - a, c - a);
    const double normal_sq = dot(normal, normal);
    const bool projects_inside = normal_sq > 0 && dot(cross(b - a, point - a), normal) >= 0 &&
                                 dot(cross(c - b, point - b), normal) >= 0 &&
                                 dot(cross(a - c, point - c), normal) >= 0;
    if (projects_inside) return std::abs(dot(point - a, normal)) / std::sqrt(normal_sq);
    return std::min(
        {segment_distance(a, b, point), segment_distance(b, c, point), segment_distance(c, a, point)});
}

} // namespace

double unsigned_distance(const TriangleMesh& mesh, const Vec3d& point) {
    double smallest = std::numeric_limits<double>::infinity();
    for (const Triangle& face : mesh.faces)
        smallest =
            std::min(smallest, triangle_distance(Vec3d(mesh.vertices[face[0]]), Vec3d(mesh.vertices[face[1]]),
                                                 Vec3d(mesh.vertices[face[2]]), point));
    return smallest;
}

} // namespace echinus
