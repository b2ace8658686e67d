#pragma once

#include "directions/clipped_face.hpp"
#include "directions/octahedral_grid.hpp"
#include "geometry/whole_numbers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace echinus {

/// Visits the samples of one octant near a face. Each sample belongs to one octant: those on coordinate
/// planes to the positive side.
template <typename Visit>
class OctantSamples {
  public:
    OctantSamples(const OctahedralGrid& grid, std::uint32_t octant, const Visit& visit)
        : grid_(grid), n_(static_cast<std::int32_t>(grid.divisions())), negative_x_((octant & 1U) != 0),
          negative_y_((octant & 2U) != 0), negative_z_((octant & 4U) != 0), visit_(visit) {}

    void visit_near(const std::array<LatticePoint, 3>& face, double reach) const {
        ClippedFace part({folded(face[0]), folded(face[1]), folded(face[2])});
        // Slightly more than the octant, so that a face that touches it from outside is not lost.
        const double tolerance = (reach + kMargin) / n_;
        const Vec3d beside = Vec3d{1, 1, 1} * tolerance;
        part.cut(Vec3d{1, 0, 0} + beside);
        part.cut(Vec3d{0, 1, 0} + beside);
        part.cut(Vec3d{0, 0, 1} + beside);
        if (part.empty()) return;
        if (part.is_all_around()) return visit_all();

        double x_min = n_, x_max = 0, y_min = n_, y_max = 0, sum_min = n_, sum_max = 0;
        for (const Vec3d& p : part) {
            const double per_length = n_ / (p.x + p.y + p.z);
            const double x = p.x * per_length, y = p.y * per_length;
            x_min = std::min(x_min, x), x_max = std::max(x_max, x);
            y_min = std::min(y_min, y), y_max = std::max(y_max, y);
            sum_min = std::min(sum_min, x + y), sum_max = std::max(sum_max, x + y);
        }
        const double margin = reach + kMargin;
        const std::int32_t first_x = at_least(x_min - margin), last_x = at_most(x_max + margin);
        for (std::int32_t x = first_x; x <= last_x; ++x) {
            const std::int32_t first_y =
                std::max(at_least(y_min - margin), at_least(sum_min - 2 * margin) - x);
            const std::int32_t last_y = std::min(at_most(y_max + margin), at_most(sum_max + 2 * margin) - x);
            for (std::int32_t y = first_y; y <= last_y; ++y) visit_if_owned(x, y);
        }
    }

  private:
    static constexpr double kMargin = 1e-3; // cells; far above the rounding of these lines

    std::int32_t at_least(double value) const {
        return truncated_to<std::int32_t>(std::clamp(std::ceil(value), 0.0, n_ + 1.0));
    }
    std::int32_t at_most(double value) const {
        return truncated_to<std::int32_t>(std::clamp(std::floor(value), -1.0, double(n_)));
    }

    /// Maps into the octant of positive coordinates.
    Vec3d folded(const LatticePoint& p) const {
        return {static_cast<double>(negative_x_ ? -p.x : p.x), static_cast<double>(negative_y_ ? -p.y : p.y),
                static_cast<double>(negative_z_ ? -p.z : p.z)};
    }

    void visit_all() const {
        for (std::int32_t x = 0; x <= n_; ++x)
            for (std::int32_t y = 0; y <= n_ - x; ++y) visit_if_owned(x, y);
    }
    /// The sample n (|x|, |y|) of this octant's side.
    void visit_if_owned(std::int32_t x, std::int32_t y) const {
        if (negative_z_) { // folded outwards
            if (x + y >= n_) return;
            visit(n_ - y, n_ - x);
        } else if (x + y <= n_ && !(negative_x_ && x == 0) && !(negative_y_ && y == 0)) {
            visit(x, y);
        }
    }
    void visit(std::int32_t across, std::int32_t up) const {
        visit_(grid_.index(static_cast<std::uint32_t>(negative_x_ ? n_ - across : n_ + across),
                           static_cast<std::uint32_t>(negative_y_ ? n_ - up : n_ + up)));
    }

    const OctahedralGrid& grid_;
    std::int32_t n_;
    bool negative_x_, negative_y_, negative_z_;
    const Visit& visit_;
};

/// Calls `visit(index)` for a superset of the samples that lie inside a face's cone or at most `reach` cells
/// outside it. Each at most once.
template <typename Visit>
void for_each_sample_near(const OctahedralGrid& grid, const std::array<LatticePoint, 3>& face, double reach,
                          const Visit& visit) {
    for (std::uint32_t octant = 0; octant < 8; ++octant)
        OctantSamples(grid, octant, visit).visit_near(face, reach);
}

} // namespace echinus
