#include "rivals/superquadric_map/convex_hull.hpp"

#include <LinearMath/btConvexHullComputer.h>

#include <algorithm>

namespace echinus::rivals {

namespace {

/// Relative to their mean and size, since Bullet computes with floats.
std::vector<double> normalised(std::span<const Vec3f> points) {
    Vec3d mean;
    for (const Vec3f& p : points) mean += Vec3d(p) * (1.0 / static_cast<double>(points.size()));
    double size = 0;
    for (const Vec3f& p : points) size = std::max(size, length(Vec3d(p) - mean));
    std::vector<double> coordinates;
    for (const Vec3f& p : points) {
        const Vec3d q = (Vec3d(p) - mean) * (size > 0 ? 1 / size : 0);
        coordinates.insert(coordinates.end(), {q.x, q.y, q.z});
    }
    return coordinates;
}

} // namespace

std::vector<Triangle> convex_hull(std::span<const Vec3f> points) {
    const std::vector<double> coordinates = normalised(points);
    btConvexHullComputer hull;
    hull.compute(coordinates.data(), 3 * sizeof(double), static_cast<int>(points.size()), 0, 0);
    std::vector<Triangle> faces;
    for (int face = 0; face < hull.faces.size(); ++face) {
        std::vector<std::uint32_t> corners;
        const auto* const first = &hull.edges[hull.faces[face]];
        const auto* edge = first;
        do {
            corners.push_back(
                static_cast<std::uint32_t>(hull.original_vertex_index[edge->getSourceVertex()]));
            edge = edge->getNextEdgeOfFace();
        } while (edge != first);
        for (std::size_t k = 2; k < corners.size(); ++k)
            faces.push_back({corners[0], corners[k - 1], corners[k]});
    }
    return faces;
}

} // namespace echinus::rivals
