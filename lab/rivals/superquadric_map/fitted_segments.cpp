#include "rivals/superquadric_map/fitted_segments.hpp"

#include "geometry/parallel.hpp"
#include "rivals/superquadric_map/fit.hpp"
#include "rivals/superquadric_map/segment_query.hpp"
#include "rivals/superquadric_map/segments.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <mutex>
#include <utility>

namespace echinus::rivals {

namespace {

constexpr std::size_t kErrorSamples = 2000;
constexpr std::size_t kCoverageSamples = 20000;
constexpr double kTolerance = 0.01; // of the bounding radius

struct Coverage {
    bool is_covered = false, is_buried = false;
};

Coverage coverage_of(const SegmentArrays& map, const Vec3f& point, float tolerance) {
    Coverage result;
    for (std::size_t segment = 0; segment < map.frames.size(); ++segment) {
        // The cosine shortens distances, so segments farther away along the ray may cover the point.
        const SegmentAnswer answer = ask(map, segment, point, 4 * tolerance);
        if (!answer.is_known) continue;
        const Vec3f normal = surface_normal(map, segment, answer.place, answer.at);
        const float cosine =
            answer.at.distance > 0 ? std::fabs(dot(normal, answer.place)) / answer.at.distance : 1;
        const float depth = answer.depth * cosine;
        result.is_covered |= std::fabs(depth) <= tolerance;
        result.is_buried |= depth > tolerance;
    }
    return result;
}

double area_of(const TriangleMesh& mesh) {
    return sample_surface(mesh.vertices, mesh.faces, 0).area;
}

Vec3f middle_of(const TriangleMesh& mesh, const Triangle& face) {
    return (mesh.vertices[face[0]] + mesh.vertices[face[1]] + mesh.vertices[face[2]]) * (1.0F / 3);
}

template <typename... Values>
void append(std::string& text, const char* format, Values... values) {
    char line[256];
    std::snprintf(line, sizeof line, format, values...);
    text += line;
}

} // namespace

SegmentReport report_on(const Segment& segment, const Superquadric& fitted, double enlargement) {
    SegmentReport report;
    report.fitted = fitted;
    report.enlargement = enlargement;
    report.face_count = segment.face_numbers.size();
    for (const Vec3f& p : segment.mesh.vertices)
        report.radius = std::max(report.radius, length(Vec3d(p) - fitted.centre));
    const SurfaceSamples samples = sample_surface(segment.mesh.vertices, segment.own_faces(), kErrorSamples);
    report.area_share = samples.area; // divided when all are known
    double sum = 0;
    for (const Vec3d& p : samples.points) {
        const double error = p == fitted.centre ? 0 : std::fabs(fitted.radial_distance(p));
        sum += error;
        report.largest_fit_error = std::max(report.largest_fit_error, error);
    }
    if (!samples.points.empty() && report.radius > 0) {
        report.mean_fit_error = sum / (static_cast<double>(samples.points.size()) * report.radius);
        report.largest_fit_error /= report.radius;
    }
    return report;
}

void measure_coverage(const TriangleMesh& mesh, const SegmentArrays& map, double bounding_radius,
                      SuperquadricReport& report) {
    report.tolerance = kTolerance * bounding_radius;
    const auto tolerance = static_cast<float>(report.tolerance);
    const double area = area_of(mesh);
    for (SegmentReport& segment : report.segments) segment.area_share /= area;

    std::size_t uncovered = 0, buried = 0;
    const SurfaceSamples samples = sample_surface(mesh.vertices, mesh.faces, kCoverageSamples);
    for (const Vec3d& p : samples.points) {
        const Coverage coverage = coverage_of(map, Vec3f(p), tolerance);
        uncovered += coverage.is_covered ? 0 : 1;
        buried += coverage.is_buried ? 1 : 0;
    }
    const auto count = static_cast<double>(std::max<std::size_t>(samples.points.size(), 1));
    report.uncovered_area_share = static_cast<double>(uncovered) / count;
    report.buried_area_share = static_cast<double>(buried) / count;
    for (std::uint32_t face = 0; face < mesh.faces.size(); ++face)
        if (!coverage_of(map, middle_of(mesh, mesh.faces[face]), tolerance).is_covered)
            report.uncovered_faces.push_back(face);
}

FitError fit_error(const SuperquadricReport& report) {
    FitError error;
    double area = 0;
    for (const SegmentReport& segment : report.segments) {
        error.mean += segment.area_share * segment.mean_fit_error;
        area += segment.area_share;
        error.largest = std::max(error.largest, segment.largest_fit_error);
    }
    if (area > 0) error.mean /= area;
    return error;
}

std::string describe(const SuperquadricReport& report) {
    std::string text =
        "segment   faces   area   mean error  largest   empty   a1 a2 a3 (radii)      e1     e2\n";
    for (std::size_t i = 0; i < report.segments.size(); ++i) {
        const SegmentReport& s = report.segments[i];
        const double unit = s.radius > 0 ? 1 / s.radius : 0;
        append(text, "%7zu %7zu %5.1f %%  %8.2f %%  %6.2f %%  %4.1f %%   %.3f %.3f %.3f    %.3f  %.3f\n", i,
               s.face_count, 100 * s.area_share, 100 * s.mean_fit_error, 100 * s.largest_fit_error,
               100 * s.empty_sample_share, s.fitted.sizes.x * unit, s.fitted.sizes.y * unit,
               s.fitted.sizes.z * unit, s.fitted.eta_exponent, s.fitted.omega_exponent);
    }
    append(
        text,
        "not covered within %.4g: %.2f %% of the area, %zu of %zu faces; buried deeper than that: %.2f %%\n",
        report.tolerance, 100 * report.uncovered_area_share, report.uncovered_faces.size(),
        report.segment_of_face.size(), 100 * report.buried_area_share);
    return text;
}

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
