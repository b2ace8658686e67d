#pragma once

#include <echinus/geometry.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus::test {

/// Finds the faces that a ray of one fixed direction can meet. Faces are projected along it, and each cell of
/// a grid lists those whose bounding rectangle touches it.
class RayGrid {
  public:
    using Corners = std::array<Vec3d, 3>;

    /// @param slack  how far a ray may stray sideways from the direction, rounding included
    RayGrid(std::span<const Corners> faces, const Vec3d& direction, double slack);

    /// Calls visit(face) for every face that the ray from a point may meet, and for a few more.
    template <typename Visit>
    void for_each_near(const Vec3d& point, const Visit& visit) const {
        const Place place = project(point);
        if (!(place.u >= low_[0] && place.u <= high_[0] && place.v >= low_[1] && place.v <= high_[1])) return;
        const std::size_t cell = cell_of(0, place.u) * count_ + cell_of(1, place.v);
        for (std::uint32_t r = offsets_[cell]; r < offsets_[cell + 1]; ++r) {
            const Extent& extent = extents_[references_[r]];
            if (place.u < extent.low_u || place.u > extent.high_u || place.v < extent.low_v ||
                place.v > extent.high_v || place.along > extent.high_along)
                continue;
            visit(references_[r]);
        }
    }

  private:
    struct Place {
        double u, v, along;
    };
    /// A face's projection, widened by the slack.
    struct Extent {
        double low_u, high_u, low_v, high_v, high_along;
    };

    Place project(const Vec3d& p) const { return {dot(p, u_), dot(p, v_), dot(p, along_)}; }
    Extent extent_of(const Corners& face, double slack) const;
    void find_bounds();
    std::size_t cell_of(std::size_t axis, double coordinate) const;
    template <typename Visit>
    void for_each_cell(const Extent& extent, const Visit& visit) const;
    void fill_lists();

    Vec3d u_, v_, along_; ///< orthonormal
    double low_[2] = {}, high_[2] = {};
    std::size_t count_ = 1; ///< cells along u and along v
    std::vector<Extent> extents_;
    std::vector<std::uint32_t> offsets_, references_;
};

} // namespace echinus::test
