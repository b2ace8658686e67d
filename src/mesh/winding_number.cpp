#include "mesh/winding_number.hpp"

#include <numbers>

namespace echinus {

namespace {

/// Signed solid angle of a triangle seen from the origin, after van Oosterom and Strackee, "The Solid Angle
/// of a Plane Triangle" (1983): tan(angle / 2) = a.(b x c) / (|a||b||c| + (a.b)|c| + (b.c)|a| + (c.a)|b|).
/// Positive when the triangle is clockwise seen from the origin, which is then behind it.
double solid_angle(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const double la = length(a);
    const double lb = length(b);
    const double lc = length(c);
    return 2 *
           std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
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

} // namespace echinus
