#include "judges/ray_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace echinus::test {

namespace {

/// About twice the square root of the number of faces: most faces then fall into a few cells and most cells
/// list a few faces.
std::size_t cells_across(std::size_t face_count) {
    const auto wanted = static_cast<std::size_t>(2 * std::sqrt(static_cast<double>(face_count)));
    return std::clamp<std::size_t>(wanted, 16, 1024);
}

Vec3d unit_of(const Vec3d& v) {
    return v * (1 / length(v));
}

} // namespace

RayGrid::RayGrid(std::span<const Corners> faces, const Vec3d& direction, double slack)
    : u_(unit_of(cross(direction, {1, 0, 0}))), v_(unit_of(cross(direction, u_))), along_(unit_of(direction)),
      count_(cells_across(faces.size())) {
    extents_.reserve(faces.size());
    for (const Corners& face : faces) extents_.push_back(extent_of(face, slack));
    find_bounds();
    fill_lists();
}

RayGrid::Extent RayGrid::extent_of(const Corners& face, double slack) const {
    const Place a = project(face[0]), b = project(face[1]), c = project(face[2]);
    return {std::min({a.u, b.u, c.u}) - slack, std::max({a.u, b.u, c.u}) + slack,
            std::min({a.v, b.v, c.v}) - slack, std::max({a.v, b.v, c.v}) + slack,
            std::max({a.along, b.along, c.along}) + slack};
}

void RayGrid::find_bounds() {
    std::ranges::fill(low_, std::numeric_limits<double>::infinity());
    std::ranges::fill(high_, -std::numeric_limits<double>::infinity());
    for (const Extent& extent : extents_) {
        low_[0] = std::min(low_[0], extent.low_u);
        low_[1] = std::min(low_[1], extent.low_v);
        high_[0] = std::max(high_[0], extent.high_u);
        high_[1] = std::max(high_[1], extent.high_v);
    }
}

/// Monotone in the coordinate, so a face's cells are those between the cells of its ends.
std::size_t RayGrid::cell_of(std::size_t axis, double coordinate) const {
    const double share = (coordinate - low_[axis]) / (high_[axis] - low_[axis]);
    const auto cell = static_cast<std::size_t>(share * static_cast<double>(count_));
    return std::min(cell, count_ - 1);
}

template <typename Visit>
void RayGrid::for_each_cell(const Extent& extent, const Visit& visit) const {
    const std::size_t last_u = cell_of(0, extent.high_u), last_v = cell_of(1, extent.high_v);
    for (std::size_t i = cell_of(0, extent.low_u); i <= last_u; ++i)
        for (std::size_t j = cell_of(1, extent.low_v); j <= last_v; ++j) visit(i * count_ + j);
}

void RayGrid::fill_lists() {
    offsets_.assign(count_ * count_ + 1, 0);
    for (const Extent& extent : extents_)
        for_each_cell(extent, [&](std::size_t cell) { ++offsets_[cell + 1]; });
    for (std::size_t cell = 0; cell < count_ * count_; ++cell) offsets_[cell + 1] += offsets_[cell];
    references_.resize(offsets_.back());
    std::vector<std::uint32_t> next(offsets_.begin(), offsets_.end() - 1);
    for (std::uint32_t face = 0; face < extents_.size(); ++face)
        for_each_cell(extents_[face], [&](std::size_t cell) { references_[next[cell]++] = face; });
}

} // namespace echinus::test
