#include "geometry/parallel.hpp"
#include "rivals/common/closed_mesh.hpp"
#include "rivals/superquadric_map/fit.hpp"
#include "rivals/superquadric_map/layout.hpp"
#include "rivals/superquadric_map/segments.hpp"
#include "rivals/superquadric_map/superquadric.hpp"
#include "rivals/superquadric_map/superquadric_map.hpp"

#include <echinus/error.hpp>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace echinus::rivals {

/// A segment and the superquadric around it.
struct FittedSegment {
    Superquadric shape; ///< enlarged so that it holds the segment
    /// The segment around the superquadric's centre, its own faces before the hull's; none where no face has
    /// an area.
    std::optional<LatticeMesh> lattice;
    std::size_t own_face_count = 0;
};

/// All of a map but its samples.
struct FittedSegments {
    std::vector<FittedSegment> segments;
};

namespace {

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
        return fitted;
    }
    fitted.shape = fit_superquadric(surface.points).shape;
    // All that lies between the centre and the hull counts as solid, but the best fit to a sharp or flat hull
    // may have its centre beside it.
    if (!segment.holds(fitted.shape.centre)) fitted.shape.centre = mean_of(surface.points);
    // The lattice's origin misses all faces, so it may lie a step beside the centre that was fitted.
    fitted.lattice = snap_to_lattice(segment.mesh, Vec3f(fitted.shape.centre));
    fitted.shape.centre = Vec3d(fitted.lattice->centre);
    fitted.shape.sizes *= enlargement_for(fitted.shape, segment.mesh);
    return fitted;
}

/// @param mesh  closed
/// @param thread_count  0: all cores. The result does not depend on it.
FittedSegments fit_segments(const TriangleMesh& mesh, const DecompositionOptions& options,
                            unsigned thread_count, const Progress& progress) {
    const TriangleMesh welded = weld(mesh); // faces keep their numbers
    const MeshReport inspected = inspect(welded);
    FittedSegments result;
    if (!encloses_volume(inspected)) return result;

    const TriangleMesh solid = wound_outward(welded, inspected);
    const std::vector<Segment> segments = make_segments(solid, decompose(solid, options, progress));
    result.segments.resize(segments.size());
    std::mutex mutex;
    std::size_t done = 0;
    parallel_for(segments.size(), thread_count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            result.segments[i] = fit_segment(segments[i], inspected.bounding_sphere.radius);
            const std::lock_guard lock(mutex);
            if (progress) progress("fit", static_cast<double>(++done) / static_cast<double>(segments.size()));
        }
    });
    return result;
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
    constexpr std::uint32_t kMin = SuperquadricMapOptions::kMinSampleCount;
    if (fits < kMin)
        throw Error(ErrorCode::InvalidOptions, "the byte budget of " + std::to_string(options.byte_budget) +
                                                   " is too small: " + std::to_string(segment_count) +
                                                   " segments take at least " + std::to_string(bytes(kMin)));
    return {fits, fits, PoleAxis::Z};
}

/// Distances down from the superquadric; empty where a ray meets nothing.
std::vector<float> samples_of(const FittedSegment& segment, const SphericalGrid& grid) {
    if (!segment.lattice) return std::vector<float>(grid.direction_count(), SegmentArrays::kEmpty);
    const std::vector<Vec3d> points = sample_points(segment.shape, grid);
    std::vector<float> samples =
        outermost_crossings(*segment.lattice, segment.own_face_count, segment.shape, grid, points);
    for (std::size_t i = 0; i < samples.size(); ++i)
        samples[i] = samples[i] < 0 ? SegmentArrays::kEmpty
                                    : std::max(static_cast<float>(length(points[i])) - samples[i], 0.0F);
    return samples;
}

/// The samples of all segments.
std::vector<std::vector<float>> sample_all(const std::vector<FittedSegment>& segments,
                                           const SphericalGrid& grid, const SuperquadricMapOptions& options,
                                           const Progress& progress) {
    std::vector<std::vector<float>> samples(segments.size());
    std::mutex mutex;
    std::size_t done = 0;
    parallel_for(segments.size(), options.thread_count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            samples[i] = samples_of(segments[i], grid);
            const std::lock_guard lock(mutex);
            if (progress)
                progress("sample", static_cast<double>(++done) / static_cast<double>(samples.size()));
        }
    });
    return samples;
}

SegmentFrame frame_of(const Superquadric& shape, const std::vector<float>& samples) {
    SegmentFrame frame;
    frame.axes[0] = Vec3f(shape.rotation.apply({1, 0, 0}));
    frame.axes[1] = Vec3f(shape.rotation.apply({0, 1, 0}));
    frame.axes[2] = Vec3f(shape.rotation.apply({0, 0, 1}));
    frame.centre = Vec3f(shape.centre);
    frame.sizes = Vec3f(shape.sizes);
    frame.eta_exponent = static_cast<float>(shape.eta_exponent);
    frame.omega_exponent = static_cast<float>(shape.omega_exponent);
    frame.radius = length(frame.sizes); // no superquadric leaves its box
    frame.largest_distance = std::max(0.0F, *std::ranges::max_element(samples));
    return frame;
}

void store_powers(const Superquadric& shape, SegmentArrays& map) {
    const auto stored = [](const ProfilePoint& p) {
        return PowerPair{static_cast<float>(p.cosine), static_cast<float>(p.sine)};
    };
    const std::uint32_t rows = map.grid.colatitude_count(), columns = map.grid.longitude_count();
    for (std::uint32_t row = 0; row < rows; ++row)
        map.eta_powers.push_back(stored(profile_point(eta_of_row(row, rows), shape.eta_exponent)));
    for (std::uint32_t column = 0; column < columns; ++column)
        map.omega_powers.push_back(
            stored(profile_point(circle_point(column, columns), shape.omega_exponent)));
}

std::uint16_t to_16_bits(float sample, float largest) {
    if (sample < 0) return SegmentArrays::kEmpty16;
    const double share = largest > 0 ? static_cast<double>(sample) / largest : 0;
    return static_cast<std::uint16_t>(std::lround(share * SegmentArrays::kSteps16));
}

void store(const Superquadric& shape, const std::vector<float>& samples, EntryFormat format,
           SegmentArrays& map) {
    map.frames.push_back(frame_of(shape, samples));
    store_powers(shape, map);
    if (format == EntryFormat::Float32)
        map.samples.insert(map.samples.end(), samples.begin(), samples.end());
    else
        for (const float sample : samples)
            map.samples16.push_back(to_16_bits(sample, map.frames.back().largest_distance));
}

} // namespace

SuperquadricSegments SuperquadricSegments::fit(const TriangleMesh& mesh,
                                               const SuperquadricMapOptions& options,
                                               const Progress& progress) {
    require_usable(options);
    require_closed(mesh, "a superquadric map");
    return SuperquadricSegments(std::make_shared<FittedSegments>(
        fit_segments(mesh, {options.segment_count, options.concavity, options.decomposition_face_limit},
                     options.thread_count, progress)));
}

std::size_t SuperquadricSegments::count() const {
    return fitted_->segments.size();
}

SuperquadricMap SuperquadricMap::sample(const SuperquadricSegments& segments,
                                        const SuperquadricMapOptions& options, const Progress& progress) {
    require_usable(options);
    const FittedSegments& fitted = *segments.fitted_;
    auto map = std::make_shared<SegmentArrays>();
    map->grid = grid_for(options, fitted.segments.size());
    const std::vector<std::vector<float>> samples = sample_all(fitted.segments, map->grid, options, progress);
    for (std::size_t i = 0; i < samples.size(); ++i)
        store(fitted.segments[i].shape, samples[i], options.sample_format, *map);
    return SuperquadricMap(std::move(map));
}

SuperquadricMap SuperquadricMap::build(const TriangleMesh& mesh, const SuperquadricMapOptions& options,
                                       const Progress& progress) {
    return sample(SuperquadricSegments::fit(mesh, options, progress), options, progress);
}

} // namespace echinus::rivals
