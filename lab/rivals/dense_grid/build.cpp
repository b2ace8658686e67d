// From a mesh to samples: the fastest exact distances available, those of an exact map, on all cores if
// requested, to be fair to the grid's build time.

#include "rivals/common/closed_mesh.hpp"
#include "rivals/dense_grid/field.hpp"

#include <echinus/error.hpp>
#include <echinus/exact_map.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace echinus::rivals {

namespace {

/// Nodes that are asked about at once: enough for all cores, few enough to need little memory.
constexpr std::size_t kMaxAtOnce = std::size_t{1} << 17;
constexpr float kMaxSteps = 32767;

std::size_t bytes_of_sample(SampleFormat format) {
    return format == SampleFormat::Float32 ? sizeof(float) : sizeof(std::int16_t);
}

double count_of(const std::array<double, 3>& nodes) {
    return nodes[0] * nodes[1] * nodes[2];
}

/// Everything except the samples.
SampledField frame_of(const Box& box, double spacing, SampleFormat format) {
    if (!(spacing > 0) || spacing > box.longest_side())
        throw Error(ErrorCode::InvalidOptions,
                    "the spacing of a dense grid is to be positive and at most the mesh's longest side, " +
                        std::to_string(box.longest_side()) + "; it is " + std::to_string(spacing));
    const std::array<double, 3> nodes = nodes_over(box, spacing);
    if (count_of(nodes) > static_cast<double>(DenseGrid::kMaxNodes))
        throw Error(ErrorCode::InvalidOptions, "a dense grid of " + std::to_string(count_of(nodes)) +
                                                   " nodes is asked for; most are " +
                                                   std::to_string(DenseGrid::kMaxNodes));
    SampledField field;
    field.low = box.low;
    field.high = box.high;
    field.spacing = spacing;
    field.nodes_per_unit = static_cast<float>(1 / spacing);
    for (std::size_t axis = 0; axis < 3; ++axis) field.nodes[axis] = static_cast<std::int32_t>(nodes[axis]);
    field.format = format;
    return field;
}

Vec3f place_of(const SampledField& field, std::size_t node) {
    const auto row = static_cast<std::size_t>(field.row()), slice = static_cast<std::size_t>(field.slice());
    const Vec3d steps(static_cast<double>(node % row), static_cast<double>(node % slice / row),
                      static_cast<double>(node / slice));
    return Vec3f(Vec3d(field.low) + steps * field.spacing);
}

std::vector<float> signed_distances(const TriangleMesh& mesh, const SampledField& field,
                                    const DenseGridOptions& grid) {
    ExactMapOptions options;
    options.thread_count = grid.thread_count;
    const ExactMap map = ExactMap::build(mesh, options);
    const float farthest = 4 * map.view().radius + 2 * static_cast<float>(grid.padding); // it ends before
    std::vector<float> distances(static_cast<std::size_t>(field.slice()) *
                                 static_cast<std::size_t>(field.nodes[2]));
    std::vector<Vec3f> points;
    std::vector<Contact> contacts;
    for (std::size_t begin = 0; begin < distances.size(); begin += kMaxAtOnce) {
        const std::size_t count = std::min(kMaxAtOnce, distances.size() - begin);
        points.resize(count);
        contacts.resize(count);
        for (std::size_t i = 0; i < count; ++i) points[i] = place_of(field, begin + i);
        echinus::contacts_batch(map.view(), points, farthest, contacts, grid.thread_count);
        for (std::size_t i = 0; i < count; ++i) distances[begin + i] = -contacts[i].depth;
    }
    return distances;
}

void store_as_snorm16(const std::vector<float>& distances, SampledField& field) {
    float largest = 0;
    for (const float distance : distances) largest = std::max(largest, std::abs(distance));
    field.step = largest / kMaxSteps;
    field.snorm16.reserve(distances.size());
    for (const float distance : distances) {
        const float steps = std::clamp(distance / field.step, -kMaxSteps, kMaxSteps);
        field.snorm16.push_back(static_cast<std::int16_t>(std::lround(steps)));
    }
}

std::shared_ptr<const SampledField> sampled(const TriangleMesh& mesh, SampledField frame,
                                            const DenseGridOptions& options) {
    std::vector<float> distances = signed_distances(mesh, frame, options);
    if (frame.format == SampleFormat::Float32)
        frame.float32 = std::move(distances);
    else
        store_as_snorm16(distances, frame);
    return std::make_shared<const SampledField>(std::move(frame));
}

/// By halving: bytes fall as the spacing grows.
double finest_spacing_within(const Box& box, std::size_t byte_budget, SampleFormat format) {
    const std::size_t sample = bytes_of_sample(format);
    if (byte_budget < 8 * sample || byte_budget > DenseGrid::kMaxNodes * sample)
        throw Error(ErrorCode::InvalidOptions, "a dense grid takes " + std::to_string(8 * sample) + " to " +
                                                   std::to_string(DenseGrid::kMaxNodes * sample) +
                                                   " bytes; the budget is " + std::to_string(byte_budget));
    const double most_nodes = static_cast<double>(byte_budget / sample);
    double too_fine = 0, coarse_enough = box.longest_side();
    for (int i = 0; i < 50; ++i) {
        const double middle = (too_fine + coarse_enough) / 2;
        (count_of(nodes_over(box, middle)) <= most_nodes ? coarse_enough : too_fine) = middle;
    }
    return coarse_enough;
}

Box padded_box(const TriangleMesh& mesh, double padding) {
    require_closed(mesh, "a dense grid");
    Box box = box_of(mesh);
    if (!(padding >= 0 && padding <= box.longest_side()))
        throw Error(ErrorCode::InvalidOptions,
                    "the padding of a dense grid is to be at least 0 and at most the mesh's longest side, " +
                        std::to_string(box.longest_side()) + "; it is " + std::to_string(padding));
    const Vec3d wider(padding, padding, padding);
    box.low = Vec3f(Vec3d(box.low) - wider);
    box.high = Vec3f(Vec3d(box.high) + wider);
    return box;
}

} // namespace

DenseGrid DenseGrid::with_samples(const TriangleMesh& mesh, std::uint32_t sample_count,
                                  const DenseGridOptions& options) {
    const Box box = padded_box(mesh, options.padding);
    const double spacing = spacing_of_samples(box, sample_count, kMaxSamples);
    return DenseGrid(sampled(mesh, frame_of(box, spacing, options.format), options));
}

DenseGrid DenseGrid::with_bytes(const TriangleMesh& mesh, std::size_t byte_budget,
                                const DenseGridOptions& options) {
    const Box box = padded_box(mesh, options.padding);
    const double spacing = finest_spacing_within(box, byte_budget, options.format);
    return DenseGrid(sampled(mesh, frame_of(box, spacing, options.format), options));
}

DenseGrid DenseGrid::with_spacing(const TriangleMesh& mesh, double spacing, const DenseGridOptions& options) {
    const Box box = padded_box(mesh, options.padding);
    return DenseGrid(sampled(mesh, frame_of(box, spacing, options.format), options));
}

} // namespace echinus::rivals
