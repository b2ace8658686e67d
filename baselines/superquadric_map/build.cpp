#include "baselines/common/closed_mesh.hpp"
#include "baselines/superquadric_map/decompose.hpp"
#include "baselines/superquadric_map/fit.hpp"
#include "baselines/superquadric_map/layout.hpp"
#include "baselines/superquadric_map/make_report.hpp"
#include "baselines/superquadric_map/sampling.hpp"
#include "baselines/superquadric_map/segments.hpp"
#include "baselines/superquadric_map/superquadric_map.hpp"
#include "directions/lattice.hpp"
#include "geometry/parallel.hpp"

#include <echinus/error.hpp>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <string>

namespace echinus::baselines {

namespace {

constexpr std::size_t kFitSamples = 1000;

void require_usable(const SuperquadricMapOptions& options) {
    using Bounds = SuperquadricMapOptions;
    const auto demand = [](bool holds, const std::string& sentence) {
        if (!holds) throw Error(ErrorCode::InvalidOptions, sentence);
    };
    const auto within = [&](const char* name, std::uint32_t count, std::uint32_t least, std::uint32_t most) {
        demand(count >= least && count <= most, std::string(name) + " is " + std::to_string(count) +
                                                    ", outside [" + std::to_string(least) + ", " +
                                                    std::to_string(most) + "]");
    };
    within("segment_count", options.segment_count, 0, Bounds::kMaxSegmentCount);
    if (options.byte_budget == 0) {
        within("omega_count", options.omega_count, Bounds::kMinSampleCount, Bounds::kMaxSampleCount);
        within("eta_count", options.eta_count, Bounds::kMinSampleCount, Bounds::kMaxSampleCount);
    }
    within("decomposition_face_limit", options.decomposition_face_limit, 4, 1U << 20U);
    demand(options.concavity > 0 && options.concavity <= 1,
           "concavity is " + std::to_string(options.concavity) + ", outside (0, 1]");
}

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

std::size_t bytes_of(std::size_t segment_count, std::size_t columns, std::size_t rows, EntryFormat format) {
    const std::size_t sample = format == EntryFormat::Float32 ? sizeof(float) : sizeof(std::uint16_t);
    return segment_count *
           (sizeof(SegmentFrame) + (columns + rows) * sizeof(PowerPair) + columns * rows * sample);
}

SphericalGrid grid_for(const SuperquadricMapOptions& options, std::size_t segment_count) {
    if (options.byte_budget == 0) return {options.omega_count, options.eta_count, PoleAxis::Z};
    const auto bytes = [&](std::size_t count) {
        return bytes_of(segment_count, count, count, options.sample_format);
    };
    std::uint32_t fits = 0; // by halving: the largest count that does
    for (std::uint32_t step = SuperquadricMapOptions::kMaxSampleCount; step > 0; step /= 2)
        if (fits + step <= SuperquadricMapOptions::kMaxSampleCount &&
            bytes(fits + step) <= options.byte_budget)
            fits += step;
    constexpr std::uint32_t kLeast = SuperquadricMapOptions::kMinSampleCount;
    if (fits < kLeast)
        throw Error(ErrorCode::InvalidOptions, "the byte budget of " + std::to_string(options.byte_budget) +
                                                   " is too small: " + std::to_string(segment_count) +
                                                   " segments take at least " +
                                                   std::to_string(bytes(kLeast)));
    return {fits, fits, PoleAxis::Z};
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

/// Everything of the map about one segment.
struct BuiltSegment {
    Superquadric shape; ///< enlarged
    std::vector<float> samples;
    SegmentReport report;
};

/// Distances down from the superquadric; empty where a ray meets nothing.
std::vector<float> samples_of(const LatticeMesh& lattice, std::size_t own_face_count,
                              const Superquadric& shape, const SphericalGrid& grid,
                              SuperquadricSampling sampling) {
    const std::vector<Vec3d> points = sample_points(shape, grid, sampling);
    std::vector<float> samples = outermost_crossings(lattice, own_face_count, shape, grid, points);
    for (std::size_t i = 0; i < samples.size(); ++i)
        samples[i] = samples[i] < 0 ? SegmentArrays::kEmpty
                                    : std::max(static_cast<float>(length(points[i])) - samples[i], 0.0F);
    return samples;
}

BuiltSegment build_segment(const Segment& segment, const SphericalGrid& grid, SuperquadricSampling sampling,
                           double mesh_radius) {
    const SurfaceSamples surface = sample_surface(segment.mesh.vertices, segment.hull_faces(), kFitSamples);
    BuiltSegment built;
    if (surface.points.empty()) {
        built.shape = point_at(segment.mesh.vertices[0], mesh_radius);
        built.samples.assign(grid.direction_count(), SegmentArrays::kEmpty);
        built.report = report_on(segment, built.shape, 1);
    } else {
        Superquadric shape = fit_superquadric(surface.points).shape;
        // The lattice's origin misses all faces, so it may lie a step beside the centre that was fitted.
        const LatticeMesh lattice = snap_to_lattice(segment.mesh, Vec3f(shape.centre));
        shape.centre = Vec3d(lattice.centre);
        const double enlargement = enlargement_for(shape, segment.mesh);
        built.report = report_on(segment, shape, enlargement);
        shape.sizes *= enlargement;
        built.shape = shape;
        built.samples = samples_of(lattice, segment.face_numbers.size(), shape, grid, sampling);
    }
    const auto empty = std::ranges::count_if(built.samples, [](float sample) { return sample < 0; });
    built.report.empty_sample_share = static_cast<double>(empty) / static_cast<double>(built.samples.size());
    return built;
}

std::vector<BuiltSegment> build_segments(const std::vector<Segment>& segments, const SphericalGrid& grid,
                                         const SuperquadricMapOptions& options, double mesh_radius,
                                         const Progress& progress) {
    std::vector<BuiltSegment> built(segments.size());
    std::mutex mutex;
    std::size_t done = 0;
    parallel_for(segments.size(), options.thread_count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            built[i] = build_segment(segments[i], grid, options.sampling, mesh_radius);
            const std::lock_guard lock(mutex);
            if (progress)
                progress("fit and sample", static_cast<double>(++done) / static_cast<double>(built.size()));
        }
    });
    return built;
}

SegmentFrame frame_of(const BuiltSegment& segment) {
    const Superquadric& shape = segment.shape;
    SegmentFrame frame;
    frame.axes[0] = Vec3f(shape.rotation.apply({1, 0, 0}));
    frame.axes[1] = Vec3f(shape.rotation.apply({0, 1, 0}));
    frame.axes[2] = Vec3f(shape.rotation.apply({0, 0, 1}));
    frame.centre = Vec3f(shape.centre);
    frame.sizes = Vec3f(shape.sizes);
    frame.eta_exponent = static_cast<float>(shape.eta_exponent);
    frame.omega_exponent = static_cast<float>(shape.omega_exponent);
    frame.radius = length(frame.sizes); // no superquadric leaves its box
    frame.largest_distance = std::max(0.0F, *std::ranges::max_element(segment.samples));
    return frame;
}

void store_powers(const Superquadric& shape, SegmentArrays& map) {
    const auto stored = [](const ProfilePoint& p) {
        return PowerPair{static_cast<float>(p.cosine), static_cast<float>(p.sine)};
    };
    const std::uint32_t rows = map.grid.colatitude_count(), columns = map.grid.longitude_count();
    for (std::uint32_t row = 0; row < rows; ++row)
        map.eta_powers.push_back(
            stored(profile_point(eta_of_row(row, rows), shape.eta_exponent, map.sampling)));
    for (std::uint32_t column = 0; column < columns; ++column)
        map.omega_powers.push_back(
            stored(profile_point(circle_point(column, columns), shape.omega_exponent, map.sampling)));
}

std::uint16_t to_16_bits(float sample, float largest) {
    if (sample < 0) return SegmentArrays::kEmpty16;
    const double share = largest > 0 ? static_cast<double>(sample) / largest : 0;
    return static_cast<std::uint16_t>(std::lround(share * SegmentArrays::kSteps16));
}

void store(const BuiltSegment& segment, EntryFormat format, SegmentArrays& map) {
    map.frames.push_back(frame_of(segment));
    store_powers(segment.shape, map);
    if (format == EntryFormat::Float32)
        map.samples.insert(map.samples.end(), segment.samples.begin(), segment.samples.end());
    else
        for (const float sample : segment.samples)
            map.samples16.push_back(to_16_bits(sample, map.frames.back().largest_distance));
}

} // namespace

SuperquadricMap SuperquadricMap::build(const TriangleMesh& mesh, const SuperquadricMapOptions& options,
                                       const Progress& progress) {
    require_usable(options);
    require_closed(mesh, "a superquadric map");
    const TriangleMesh welded = weld(mesh); // faces keep their numbers
    const MeshReport inspected = inspect(welded);
    const TriangleMesh solid = wound_outward(welded, inspected);
    Decomposition decomposition;
    if (encloses_volume(inspected))
        decomposition = decompose(
            solid, {options.segment_count, options.concavity, options.decomposition_face_limit}, progress);

    auto map = std::make_shared<SegmentArrays>();
    map->grid = grid_for(options, decomposition.segment_count);
    map->sampling = options.sampling;
    auto report = std::make_shared<SuperquadricReport>();
    report->segment_of_face = decomposition.segment_of_face;
    const double radius = inspected.bounding_sphere.radius;
    for (const BuiltSegment& segment :
         build_segments(make_segments(solid, decomposition), map->grid, options, radius, progress)) {
        store(segment, options.sample_format, *map);
        report->segments.push_back(segment.report);
    }
    measure_coverage(solid, *map, radius, *report);
    return {std::move(map), std::move(report)};
}

} // namespace echinus::baselines
