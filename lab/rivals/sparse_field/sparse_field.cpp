#include "rivals/sparse_field/sparse_field.hpp"

#include "rivals/common/closed_mesh.hpp"

#include <echinus/error.hpp>

#include <openvdb/math/Stencils.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/MeshToVolume.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace echinus::rivals {

namespace {

constexpr float kVoxelsOutside = 3;
/// So far outside all eight samples around a place are in the band: 3 less the diagonal of a voxel. Beyond it
/// all is background and has no gradient.
constexpr float kVoxelsKnown = kVoxelsOutside - 1.7321F;
/// The low corner of the mesh's box in voxels: far enough from 0 for the voxels outside it, so that all lie
/// in one inner node of the tree, whose table of children is most of a small grid.
constexpr double kFirstVoxel = 8;
constexpr double kMaxVoxels = 1 << 30;

} // namespace

struct SparseField::Grid {
    openvdb::FloatGrid::Ptr grid; ///< distances in voxels
    Vec3d low;
    double spacing;
    std::uint32_t sample_count;
    std::size_t bytes = 0;

    Grid(const TriangleMesh& mesh, const Box& box, std::uint32_t sample_count_)
        : low(box.low), spacing(spacing_of_samples(box, sample_count_, kMaxSamples)),
          sample_count(sample_count_) {
        const auto nodes = nodes_over(box, spacing);
        if (nodes[0] * nodes[1] * nodes[2] > kMaxVoxels)
            throw Error(ErrorCode::InvalidOptions,
                        std::to_string(sample_count) + " samples along the longest side make a box of " +
                            std::to_string(nodes[0] * nodes[1] * nodes[2]) + " voxels; most are 2^30");
        openvdb::initialize();
        std::vector<openvdb::Vec3s> vertices;
        for (const Vec3f& vertex : mesh.vertices) {
            const Vec3d voxel = in_voxels(vertex);
            vertices.emplace_back(openvdb::Vec3d(voxel.x, voxel.y, voxel.z));
        }
        std::vector<openvdb::Vec3I> faces;
        for (const auto& [a, b, c] : mesh.faces) faces.emplace_back(a, b, c);
        const openvdb::tools::QuadAndTriangleDataAdapter<openvdb::Vec3s, openvdb::Vec3I> adapter(vertices,
                                                                                                 faces);
        grid = openvdb::tools::meshToVolume<openvdb::FloatGrid>(
            adapter, openvdb::math::Transform(), kVoxelsOutside, std::numeric_limits<float>::max());
        bytes = grid->memUsage();
    }

    Vec3d in_voxels(const Vec3f& point) const {
        const Vec3d first(kFirstVoxel, kFirstVoxel, kFirstVoxel);
        return (Vec3d(point) - low) * (1 / spacing) + first;
    }

    /// False for what is not finite, which OpenVDB cannot be asked about, and for what is far away.
    bool is_near(const Vec3d& voxel) const {
        const double last = sample_count + 2 * kFirstVoxel;
        const auto within = [&](double v) { return v > 0 && v < last; };
        return within(voxel.x) && within(voxel.y) && within(voxel.z);
    }
};

namespace {

/// The number of samples whose field, of those that were built, comes nearest to the budget from below. Bytes
/// grow like a power of the number, between its square and its cube: of two fields on both sides of the
/// budget the power is known, of one it is taken for the cube.
template <typename Grid>
std::unique_ptr<const Grid> finest_within(const TriangleMesh& mesh, const Box& box, std::size_t byte_budget) {
    constexpr double kGoodEnough = 0.95;
    const auto budget = static_cast<double>(byte_budget);
    auto best = std::make_unique<const Grid>(mesh, box, 2);
    if (best->bytes > byte_budget)
        throw Error(ErrorCode::InvalidOptions, "the coarsest sparse field takes " +
                                                   std::to_string(best->bytes) + " bytes; the budget is " +
                                                   std::to_string(byte_budget));
    const auto top_of_tree = static_cast<double>(best->bytes); // all fields have it
    std::uint32_t too_fine = SparseField::kMaxSamples + 1;
    double bytes_too_fine = 0;
    double next = 16;
    for (int builds = 0; builds < 12 && too_fine - best->sample_count > 1; ++builds) {
        next = std::clamp(std::floor(next), best->sample_count + 1.0, too_fine - 1.0);
        auto grid = std::make_unique<const Grid>(mesh, box, static_cast<std::uint32_t>(next));
        if (grid->bytes > byte_budget) {
            too_fine = grid->sample_count;
            bytes_too_fine = static_cast<double>(grid->bytes);
        } else {
            best = std::move(grid);
        }
        const auto bytes = static_cast<double>(best->bytes);
        if (bytes > kGoodEnough * budget) break;
        const double samples = best->sample_count;
        const double room =
            std::max(budget - top_of_tree, 1.0) / std::max(bytes - top_of_tree, top_of_tree / 16);
        if (bytes_too_fine == 0) {
            next = samples * std::clamp(std::cbrt(room), 1.02, 4.0);
        } else {
            const double power = std::log(bytes_too_fine / bytes) / std::log(too_fine / samples);
            const double predicted = samples * std::pow(budget * (1 + kGoodEnough) / 2 / bytes, 1 / power);
            // From the third on by halves in turn: samples fall into blocks of 8, so that bytes jump.
            next = builds % 2 == 0 ? (samples + too_fine) / 2 : predicted;
        }
    }
    return best;
}

Box box_of_closed(const TriangleMesh& mesh) {
    require_closed(mesh, "a sparse field");
    return box_of(mesh);
}

} // namespace

SparseField SparseField::with_samples(const TriangleMesh& mesh, std::uint32_t sample_count) {
    return SparseField(std::make_unique<const Grid>(mesh, box_of_closed(mesh), sample_count));
}

SparseField SparseField::with_bytes(const TriangleMesh& mesh, std::size_t byte_budget) {
    return SparseField(finest_within<Grid>(mesh, box_of_closed(mesh), byte_budget));
}

SparseField::SparseField(std::unique_ptr<const Grid> grid) : grid_(std::move(grid)) {}
SparseField::SparseField(SparseField&&) noexcept = default;
SparseField& SparseField::operator=(SparseField&&) noexcept = default;
SparseField::~SparseField() = default;

std::size_t SparseField::byte_count() const {
    return grid_->bytes;
}

double SparseField::spacing() const {
    return grid_->spacing;
}

std::uint32_t SparseField::sample_count() const {
    return grid_->sample_count;
}

void SparseField::contains_batch(std::span<const Vec3f> points, std::span<std::uint8_t> inside) const {
    const auto accessor = grid_->grid->getConstAccessor();
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3d voxel = grid_->in_voxels(points[i]);
        inside[i] = grid_->is_near(voxel) && openvdb::tools::BoxSampler::sample(
                                                 accessor, openvdb::Vec3d(voxel.x, voxel.y, voxel.z)) < 0;
    }
}

void SparseField::contacts_batch(std::span<const Vec3f> points, float margin,
                                 std::span<Contact> contacts) const {
    openvdb::math::BoxStencil<openvdb::FloatGrid> stencil(*grid_->grid);
    const auto spacing = static_cast<float>(grid_->spacing);
    const float farthest = std::min(margin / spacing, kVoxelsKnown);
    for (std::size_t i = 0; i < points.size(); ++i) {
        contacts[i] = no_contact(points[i]);
        const Vec3d voxel = grid_->in_voxels(points[i]);
        if (!grid_->is_near(voxel)) continue;
        const openvdb::Vec3d place(voxel.x, voxel.y, voxel.z);
        stencil.moveTo(place);
        const openvdb::Vec3s in_single(place);
        const float distance = stencil.interpolation(in_single);
        if (!(distance < 0 || (margin > 0 && distance <= farthest))) continue;
        openvdb::Vec3s normal = stencil.gradient(in_single);
        normal.normalize();
        contacts[i] = contact_along(points[i], -distance * spacing, {normal[0], normal[1], normal[2]});
    }
}

} // namespace echinus::rivals
