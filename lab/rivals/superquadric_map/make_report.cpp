#include "rivals/superquadric_map/make_report.hpp"

#include "rivals/superquadric_map/segment_query.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

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

} // namespace echinus::rivals
