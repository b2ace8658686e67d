#include <echinus/mesh.hpp>

#include <algorithm>
#include <limits>

namespace echinus {

namespace {

double segment_distance(const Vec3d& a, const Vec3d& b, const Vec3d& point) {
    const Vec3d ab = b - a;
    const double ab_sq = dot(ab, ab);
    const double t = ab_sq > 0 ? std::clamp(dot(point - a, ab) / ab_sq, 0.0, 1.0) : 0.0;
    return length(point - (a + ab * t));
}

/// The nearest of the three edges, unless the point projects into the triangle. Triangles without area need
/// no special case: they consist of their edges.
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
