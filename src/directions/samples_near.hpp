#pragma once

#include "directions/cube_grid.hpp"
#include "directions/lattice.hpp"
#include "directions/octahedral_grid.hpp"
#include "directions/spherical_grid.hpp"
#include "geometry/whole_numbers.hpp"

#include <echinus/geometry.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <utility>

namespace echinus {

/// A range of colatitudes and longitudes (grid frame, radians) that contains every direction in which a face
/// is seen from the origin: the range of a cap around the face's three corners. It only has to be large
/// enough, so the functions of the C library suffice; which of its directions meet the face is decided
/// exactly afterwards.
struct DirectionCap {
    double theta_min, theta_max;
    double phi_middle, phi_half_width; ///< a half width of pi or more means the whole circle

    /// Far more than the rounding here and that of snapping a direction (2e-6 rad), but far less than a cell.
    static constexpr double kMargin = 1e-5;

    /// @param margin  must be larger if the frame is scaled and directions were snapped before
    explicit DirectionCap(const std::array<Vec3d, 3>& corners, double margin = kMargin) {
        constexpr double kPiDouble = std::numbers::pi;

        std::array<Vec3d, 3> units;
        for (int i = 0; i < 3; ++i) units[i] = corners[i] * (1 / length(corners[i]));
        const Vec3d sum = units[0] + units[1] + units[2];
        const Vec3d axis = sum * (1 / std::max(length(sum), 1e-300));
        double cosine = 1;
        for (const Vec3d& unit : units) cosine = std::min(cosine, dot(axis, unit));
        // A cap of a quarter turn or more need not contain the great circles between its points, so it is
        // widened to all directions.
        const double radius = cosine > 0.01 ? std::acos(std::min(cosine, 1.0)) + margin : kPiDouble;

        const double theta = std::atan2(std::hypot(axis.x, axis.y), axis.z);
        theta_min = theta - radius;
        theta_max = theta + radius;
        const bool holds_a_pole = theta_min <= 0 || theta_max >= kPiDouble;
        phi_middle = std::atan2(axis.y, axis.x);
        phi_half_width =
            holds_a_pole ? kPiDouble : std::asin(std::min(1.0, std::sin(radius) / std::sin(theta))) + margin;
    }
};

/// Calls `visit(index)` for the samples of a grid that are inside a cap or at most `reach` cells outside it
/// along phi and theta.
template <typename Visit>
void for_each_sample_in(const SphericalGrid& grid, const DirectionCap& cap, double reach,
                        const Visit& visit) {
    const auto count_of_rows = static_cast<std::int64_t>(grid.colatitude_count());
    const auto count_of_columns = static_cast<std::int64_t>(grid.longitude_count());
    const double rows_per_radian = static_cast<double>(count_of_rows) / std::numbers::pi;
    const double columns_per_radian = static_cast<double>(count_of_columns) / (2 * std::numbers::pi);
    const auto at_or_above = [reach](double s) { return truncated_to<std::int64_t>(std::ceil(s - reach)); };
    const auto at_or_below = [reach](double s) { return truncated_to<std::int64_t>(std::floor(s + reach)); };

    const std::int64_t first_row =
        std::max<std::int64_t>(at_or_above(cap.theta_min * rows_per_radian - 0.5), 0);
    const std::int64_t last_row =
        std::min(at_or_below(cap.theta_max * rows_per_radian - 0.5), count_of_rows - 1);
    std::int64_t first_column = at_or_above((cap.phi_middle - cap.phi_half_width) * columns_per_radian);
    std::int64_t last_column = at_or_below((cap.phi_middle + cap.phi_half_width) * columns_per_radian);
    if (last_column - first_column + 1 >= count_of_columns) {
        first_column = 0;
        last_column = count_of_columns - 1;
    }
    for (std::int64_t row = first_row; row <= last_row; ++row)
        for (std::int64_t column = first_column; column <= last_column; ++column) {
            const std::int64_t wrapped = column < 0                   ? column + count_of_columns
                                         : column >= count_of_columns ? column - count_of_columns
                                                                      : column;
            visit(grid.index(static_cast<std::uint32_t>(wrapped), static_cast<std::uint32_t>(row)));
        }
}

/// Calls `visit(index)` for a superset of the samples that are inside a face's cone or at most `reach` cells
/// outside it.
template <typename Visit>
void for_each_sample_near(const SphericalGrid& grid, const std::array<LatticePoint, 3>& face, double reach,
                          const Visit& visit) {
    const DirectionCap cap(
        {Vec3d(grid.to_grid(face[0])), Vec3d(grid.to_grid(face[1])), Vec3d(grid.to_grid(face[2]))});
    for_each_sample_in(grid, cap, reach, visit);
}

/// The same for an ellipsoidal grid. In its scaled frame the samples are those of a sphere, so the face is
/// scaled, too. Angles there may be larger than in the mesh's frame, by up to the inverse of the smallest
/// scale; hence the margin.
template <typename Visit>
void for_each_sample_near(const EllipsoidalGrid& grid, const std::array<LatticePoint, 3>& face, double reach,
                          const Visit& visit) {
    const Vec3d scale(grid.scale_in_grid());
    std::array<Vec3d, 3> corners;
    for (std::size_t c = 0; c < 3; ++c) corners[c] = product(Vec3d(grid.to_grid(face[c])), scale);
    const DirectionCap cap(corners, DirectionCap::kMargin / static_cast<double>(grid.smallest_scale()));
    for_each_sample_in(grid, cap, reach, visit);
}

/// A convex polygon with few corners, in lattice steps, to be cut by planes through the origin. Near the
/// origin its directions are lost in rounding: a face that avoids the origin may still be nearer to it than
/// the rounding error of a corner.
class ClippedFace {
  public:
    explicit ClippedFace(const std::array<Vec3d, 3>& corners) : size_(3) {
        std::copy(corners.begin(), corners.end(), corners_.begin());
    }

    /// Keeps the part with n.p >= 0, and anything that rounding may have moved beyond it.
    /// @param n  of approximately unit length
    void cut(const Vec3d& n) {
        std::array<Vec3d, kMost> kept;
        std::size_t kept_size = 0;
        for (std::size_t i = 0; i < size_; ++i) {
            const Vec3d& a = corners_[i];
            const Vec3d& b = corners_[i + 1 == size_ ? 0 : i + 1];
            const double height_a = dot(n, a) + kRounding, height_b = dot(n, b) + kRounding;
            if (height_a >= 0) kept[kept_size++] = a;
            if ((height_a >= 0) != (height_b >= 0))
                kept[kept_size++] = a + (b - a) * (height_a / (height_a - height_b));
        }
        corners_ = kept;
        size_ = kept_size;
    }

    bool empty() const { return size_ == 0; }
    /// Is it so near the origin that its corners do not determine in which directions it lies?
    bool is_all_around() const {
        return std::any_of(begin(), end(), [](const Vec3d& p) { return dot(p, p) < kNear * kNear; });
    }
    const Vec3d* begin() const { return corners_.data(); }
    const Vec3d* end() const { return corners_.data() + size_; }

  private:
    /// In lattice steps. A lattice has 2^20 of them on each axis, so doubles are rounded by 2^-34, and each
    /// cut adds a few times that.
    static constexpr double kRounding = 0x1p-28;
    /// In lattice steps. At this distance kRounding corresponds to 2^-28 radians, far below all margins of
    /// samples.
    static constexpr double kNear = 1;

    static constexpr std::size_t kMost = 3 + 4 + 1; // each of up to four planes adds at most one corner
    std::array<Vec3d, kMost> corners_;
    std::size_t size_;
};

/// Calls `visit(index)`, at most once each, for a superset of the samples of one side of the cube that are
/// inside a face's cone or at most `reach` cells outside it. Which samples meet the face is decided exactly
/// afterwards, so the functions of the C library suffice here.
template <typename Visit>
void for_each_sample_of_side_near(const CubeGrid& grid, std::uint32_t side,
                                  const std::array<LatticePoint, 3>& face, double reach, const Visit& visit) {
    constexpr double kMargin = 1e-5; // radians; far more than the rounding errors here and of the lattice
    const double cells_per_radian = 2 * grid.divisions() / std::numbers::pi;
    std::array<Vec3d, 3> corners;
    for (std::size_t c = 0; c < 3; ++c) {
        corners[c] = CubeGrid::to_side(side, Vec3d(face[c]));
        if (CubeGrid::is_negative(side)) corners[c].z = -corners[c].z;
    }
    // The part that is visible from this side, and slightly more.
    ClippedFace part(corners);
    const double half_opening = std::numbers::pi / 4 + reach / cells_per_radian + kMargin;
    const double across = std::cos(half_opening), along = std::sin(half_opening);
    part.cut({across, 0, along});
    part.cut({-across, 0, along});
    part.cut({0, across, along});
    part.cut({0, -across, along});
    if (part.empty()) return;

    double u_min = std::numbers::pi, u_max = -u_min, v_min = u_min, v_max = -u_min;
    if (part.is_all_around()) std::swap(u_min, u_max), std::swap(v_min, v_max);
    for (const Vec3d& p : part) {
        const double u = std::atan2(p.x, p.z), v = std::atan2(p.y, p.z);
        u_min = std::min(u_min, u), u_max = std::max(u_max, u);
        v_min = std::min(v_min, v), v_max = std::max(v_max, v);
    }
    const auto n = static_cast<double>(grid.divisions());
    const auto first = [&](double angle) {
        const double place = std::ceil((angle - kMargin) * cells_per_radian + n / 2 - reach);
        return truncated_to<std::int64_t>(std::clamp(place, 0.0, n + 1));
    };
    const auto last = [&](double angle) {
        const double place = std::floor((angle + kMargin) * cells_per_radian + n / 2 + reach);
        return truncated_to<std::int64_t>(std::clamp(place, -1.0, n));
    };
    for (std::int64_t j = first(v_min); j <= last(v_max); ++j)
        for (std::int64_t i = first(u_min); i <= last(u_max); ++i)
            visit(grid.index(side, static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j)));
}

/// The same for all sides.
template <typename Visit>
void for_each_sample_near(const CubeGrid& grid, const std::array<LatticePoint, 3>& face, double reach,
                          const Visit& visit) {
    for (std::uint32_t side = 0; side < 6; ++side)
        for_each_sample_of_side_near(grid, side, face, reach, visit);
}

/// Visits the samples of one octant near a face. Each sample belongs to one octant: those on a coordinate
/// plane belong to its positive side.
template <typename Visit>
class OctantSamples {
  public:
    OctantSamples(const OctahedralGrid& grid, std::uint32_t octant, const Visit& visit)
        : grid_(grid), n_(static_cast<std::int32_t>(grid.divisions())), negative_x_((octant & 1U) != 0),
          negative_y_((octant & 2U) != 0), negative_z_((octant & 4U) != 0), visit_(visit) {}

    void visit_near(const std::array<LatticePoint, 3>& face, double reach) const {
        ClippedFace part({folded(face[0]), folded(face[1]), folded(face[2])});
        // Cuts slightly outside the octant, so that a face that touches it from outside is not lost.
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
    static constexpr double kMargin = 1e-3; // cells; far more than the rounding errors here

    std::int32_t at_least(double value) const {
        return truncated_to<std::int32_t>(std::clamp(std::ceil(value), 0.0, n_ + 1.0));
    }
    std::int32_t at_most(double value) const {
        return truncated_to<std::int32_t>(std::clamp(std::floor(value), -1.0, double(n_)));
    }

    /// Mirrors a point into the octant of positive coordinates.
    Vec3d folded(const LatticePoint& p) const {
        return {static_cast<double>(negative_x_ ? -p.x : p.x), static_cast<double>(negative_y_ ? -p.y : p.y),
                static_cast<double>(negative_z_ ? -p.z : p.z)};
    }

    void visit_all() const {
        for (std::int32_t x = 0; x <= n_; ++x)
            for (std::int32_t y = 0; y <= n_ - x; ++y) visit_if_owned(x, y);
    }
    /// Visits the sample n (|x|, |y|) of this octant's side.
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

/// Calls `visit(index)`, at most once each, for a superset of the samples that are inside a face's cone or at
/// most `reach` cells outside it.
template <typename Visit>
void for_each_sample_near(const OctahedralGrid& grid, const std::array<LatticePoint, 3>& face, double reach,
                          const Visit& visit) {
    for (std::uint32_t octant = 0; octant < 8; ++octant)
        OctantSamples(grid, octant, visit).visit_near(face, reach);
}

} // namespace echinus
