#include "baselines/dense_grid/dense_grid.hpp"

#include <echinus/exact_map.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace echinus::baselines {

namespace {

struct Box {
    Vec3f low, high;
};

Box box_of(const TriangleMesh& mesh) {
    Box box{mesh.vertices[mesh.faces.front()[0]], mesh.vertices[mesh.faces.front()[0]]};
    for (const Triangle& face : mesh.faces)
        for (const std::uint32_t v : face) {
            const Vec3f& p = mesh.vertices[v];
            box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
            box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
        }
    return box;
}

std::uint32_t nodes_along(float low, float high, double spacing) {
    return static_cast<std::uint32_t>(std::ceil((double{high} - double{low}) / spacing)) + 1;
}

std::array<std::uint32_t, 3> nodes_of(const Box& box, double spacing) {
    // Two nodes at least: an interpolation needs a cell.
    return {std::max(2U, nodes_along(box.low.x, box.high.x, spacing)),
            std::max(2U, nodes_along(box.low.y, box.high.y, spacing)),
            std::max(2U, nodes_along(box.low.z, box.high.z, spacing))};
}

std::size_t bytes_of(const std::array<std::uint32_t, 3>& nodes) {
    return sizeof(float) * nodes[0] * nodes[1] * nodes[2];
}

} // namespace

DenseGrid DenseGrid::with_spacing(const TriangleMesh& mesh, double spacing) {
    return {mesh, spacing};
}

DenseGrid DenseGrid::with_bytes(const TriangleMesh& mesh, std::size_t byte_budget) {
    const Box box = box_of(mesh);
    const Vec3d size = Vec3d(box.high) - Vec3d(box.low);
    double too_fine = 0, coarse_enough = std::max({size.x, size.y, size.z});
    for (int i = 0; i < 50; ++i) {
        const double middle = (too_fine + coarse_enough) / 2;
        const bool fits = bytes_of(nodes_of(box, middle)) <= byte_budget;
        (fits ? coarse_enough : too_fine) = middle;
    }
    return {mesh, coarse_enough};
}

/// The samples come from an exact map, a row of nodes at a time: the fastest exact distances at hand, so that
/// the grid's build time is not held against it.
DenseGrid::DenseGrid(const TriangleMesh& mesh, double spacing) {
    const Box box = box_of(mesh);
    const std::array<std::uint32_t, 3> nodes = nodes_of(box, spacing);
    std::ranges::copy(nodes, node_counts_);
    low_ = box.low;
    nodes_per_unit_ = static_cast<float>(1 / spacing);
    samples_.resize(std::size_t{nodes[0]} * nodes[1] * nodes[2]);

    ExactMapOptions options;
    options.thread_count = 1;
    const ExactMap map = ExactMap::build(mesh, options);
    const float farthest = 4 * map.view().radius;
    std::vector<Vec3f> points(nodes[0]);
    std::vector<Contact> contacts(nodes[0]);
    float* sample = samples_.data();
    for (std::uint32_t z = 0; z < nodes[2]; ++z)
        for (std::uint32_t y = 0; y < nodes[1]; ++y) {
            for (std::uint32_t x = 0; x < nodes[0]; ++x)
                points[x] = Vec3f(Vec3d(low_) + Vec3d(x, y, z) * spacing);
            echinus::contacts_batch(map.view(), points, farthest, contacts);
            for (const Contact& contact : contacts) *sample++ = -contact.depth;
        }
}

} // namespace echinus::baselines
