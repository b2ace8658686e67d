#include "rivals/superquadric_map/fitted_segments.hpp"

#include "geometry/parallel.hpp"
#include "rivals/superquadric_map/fit.hpp"
#include "rivals/superquadric_map/make_report.hpp"
#include "rivals/superquadric_map/segments.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

namespace echinus::rivals {

namespace {

constexpr std::size_t kFitSamples = 1000;

bool encloses_volume(const MeshReport& report) {
    constexpr double kFlat = 1e-9; // far below any solid, far above the rounding of the sum
    const double radius = report.bounding_sphere.radius;
    return std::fabs(report.signed_volume) > kFlat * radius * radius * radius;
}

TriangleMesh wound_outward(TriangleMesh mesh, const MeshReport& report) {
    if (report.signed_volume < 0)
        for (Triangle& face : mesh.faces) std::swap(face[1], face[2]);
    return mesh;
}

/// By which a superquadric has to grow to hold all vertices, and so, being convex, all faces.
double enlargement_for(const Superquadric& shape, const TriangleMesh& solid) {
    double largest = 0;
    for (const Vec3f& p : solid.vertices) {
        const Vec3d place = shape.to_frame(Vec3d(p));
        if (place != Vec3d{}) largest = std::max(largest, 1 / shape.factor_to_surface(place));
    }
    constexpr double kRounding = 1 + 1e-6;
    return largest * kRounding;
}

/// A segment whose faces have no area has nothing inside: a point.
Superquadric point_at(const Vec3f& place, double radius) {
    Superquadric shape;
    shape.centre = Vec3d(place);
    shape.sizes = Vec3d{1, 1, 1} * (1e-6 * radius);
    return shape;
}

Vec3d mean_of(const std::vector<Vec3d>& points) {
    Vec3d sum;
    for (const Vec3d& p : points) sum += p;
    return sum * (1 / static_cast<double>(points.size()));
}

FittedSegment fit_segment(const Segment& segment, double mesh_radius) {
    const SurfaceSamples surface = sample_surface(segment.mesh.vertices, segment.hull_faces(), kFitSamples);
    FittedSegment fitted;
    fitted.own_face_count = segment.face_numbers.size();
    if (surface.points.empty()) {
        fitted.shape = point_at(segment.mesh.vertices[0], mesh_radius);
        fitted.report = report_on(segment, fitted.shape, 1);
        return fitted;
    }
    fitted.shape = fit_superquadric(surface.points).shape;
    // All that lies between the centre and the hull counts as solid, but the best fit to a sharp or flat hull
    // may have its centre beside it.
    if (!segment.holds(fitted.shape.centre)) fitted.shape.centre = mean_of(surface.points);
    // The lattice's origin misses all faces, so it may lie a step beside the centre that was fitted.
    fitted.lattice = snap_to_lattice(segment.mesh, Vec3f(fitted.shape.centre));
    fitted.shape.centre = Vec3d(fitted.lattice->centre);
    const double enlargement = enlargement_for(fitted.shape, segment.mesh);
    fitted.report = report_on(segment, fitted.shape, enlargement);
    fitted.shape.sizes *= enlargement;
    return fitted;
}

} // namespace

FittedSegments fit_segments(const TriangleMesh& mesh, const DecompositionOptions& options,
                            unsigned thread_count, const Progress& progress) {
    const TriangleMesh welded = weld(mesh); // faces keep their numbers
    const MeshReport inspected = inspect(welded);
    FittedSegments result;
    result.solid = wound_outward(welded, inspected);
    result.radius = inspected.bounding_sphere.radius;
    if (!encloses_volume(inspected)) return result;

    Decomposition decomposition = decompose(result.solid, options, progress);
    const std::vector<Segment> segments = make_segments(result.solid, decomposition);
    result.segment_of_face = std::move(decomposition.segment_of_face);
    result.segments.resize(segments.size());
    std::mutex mutex;
    std::size_t done = 0;
    parallel_for(segments.size(), thread_count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            result.segments[i] = fit_segment(segments[i], result.radius);
            const std::lock_guard lock(mutex);
            if (progress) progress("fit", static_cast<double>(++done) / static_cast<double>(segments.size()));
        }
    });
    return result;
}

} // namespace echinus::rivals
