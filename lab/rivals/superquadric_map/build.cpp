#include "geometry/parallel.hpp"
#include "rivals/common/closed_mesh.hpp"
#include "rivals/superquadric_map/fitted_segments.hpp"
#include "rivals/superquadric_map/layout.hpp"
#include "rivals/superquadric_map/sampling.hpp"
#include "rivals/superquadric_map/superquadric_map.hpp"

#include <echinus/error.hpp>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <string>

namespace echinus::rivals {

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
std::vector<float> samples_of(const FittedSegment& segment, const SphericalGrid& grid,
                              SuperquadricSampling sampling) {
    if (!segment.lattice) return std::vector<float>(grid.direction_count(), SegmentArrays::kEmpty);
    const std::vector<Vec3d> points = sample_points(segment.shape, grid, sampling);
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
            samples[i] = samples_of(segments[i], grid, options.sampling);
            const std::lock_guard lock(mutex);
            if (progress)
                progress("sample", static_cast<double>(++done) / static_cast<double>(samples.size()));
        }
    });
    return samples;
}

double empty_share(const std::vector<float>& samples) {
    const auto empty = std::ranges::count_if(samples, [](float sample) { return sample < 0; });
    return static_cast<double>(empty) / static_cast<double>(samples.size());
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
    map->sampling = options.sampling;
    auto report = std::make_shared<SuperquadricReport>();
    report->segment_of_face = fitted.segment_of_face;
    const std::vector<std::vector<float>> samples = sample_all(fitted.segments, map->grid, options, progress);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        store(fitted.segments[i].shape, samples[i], options.sample_format, *map);
        report->segments.push_back(fitted.segments[i].report);
        report->segments.back().empty_sample_share = empty_share(samples[i]);
    }
    measure_coverage(fitted.solid, *map, fitted.radius, *report);
    return {std::move(map), std::move(report)};
}

SuperquadricMap SuperquadricMap::build(const TriangleMesh& mesh, const SuperquadricMapOptions& options,
                                       const Progress& progress) {
    return sample(SuperquadricSegments::fit(mesh, options, progress), options, progress);
}

} // namespace echinus::rivals
