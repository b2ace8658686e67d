#include "exact_map/cell_cover.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace echinus {

namespace {

/// Widening of a cell, in cells. Clipped corners are off by some 1e-16 of the lattice's extent, hence by at
/// most 1e-10 of their own distance from the origin where that is a lattice step or more; nearer ones are
/// treated apart.
constexpr double kSlack = 1e-6;

/// Corners of a face clipped by at most nine planes, each of which adds one at most.
class Polygon {
  public:
    void add(const Vec3d& corner) { corners_[size_++] = corner; }
    bool empty() const { return size_ == 0; }
    const Vec3d* begin() const { return corners_.data(); }
    const Vec3d* end() const { return corners_.data() + size_; }

    /// The part where a linear function is not negative (Sutherland and Hodgman 1974).
    template <typename Linear>
    Polygon clipped(const Linear& value_at) const {
        Polygon result;
        if (empty()) return result;
        const Vec3d* previous = end() - 1;
        double previous_value = value_at(*previous);
        for (const Vec3d& corner : *this) {
            const double value = value_at(corner);
            if ((value < 0) != (previous_value < 0))
                result.add(*previous + (corner - *previous) * (previous_value / (previous_value - value)));
            if (value >= 0) result.add(corner);
            previous = &corner;
            previous_value = value;
        }
        return result;
    }

  private:
    std::array<Vec3d, 16> corners_;
    std::size_t size_ = 0;
};

double sum_of(const Vec3d& p) {
    return p.x + p.y + p.z;
}

struct Point2 {
    double x, y;
};

/// What a convex polygon touches of the 16 parts of a triangle that has its corners at (0, 0), (4, 0) and
/// (0, 4): what no edge of the polygon and no side of a part separates from it (the separating axis theorem).
class PartCover {
  public:
    void add(const Point2& corner) { corners_[size_++] = corner; }

    std::uint16_t parts() const {
        double doubled_area = 0;
        for (std::size_t k = 0; k < size_; ++k) doubled_area += cross_of(corner(k), corner(k + 1));
        std::uint32_t parts = parts_in_range(-1, 0) & parts_in_range(0, -1) & parts_in_range(1, 1);
        for (std::size_t k = 0; k < size_ && !std::has_single_bit(parts); ++k)
            parts &= parts_inside_of(corner(k), corner(k + 1), doubled_area < 0);
        return static_cast<std::uint16_t>(parts);
    }

  private:
    /// In parts' widths: far more than rounding, far less than would cost anything.
    static constexpr double kPartSlack = 1e-3;

    static double cross_of(const Point2& a, const Point2& b) { return a.x * b.y - a.y * b.x; }
    const Point2& corner(std::size_t k) const { return corners_[k < size_ ? k : 0]; }

    /// Where f = along_x x + along_y y + at_origin is not negative somewhere.
    static std::uint32_t parts_reached(double along_x, double along_y, double at_origin) {
        const double above_up = std::max({0.0, along_x, along_y});
        const double above_down = std::max({along_x, along_y, along_x + along_y});
        std::uint32_t parts = 0;
        std::uint32_t part = 0;
        constexpr std::int32_t n = OctahedralCells::kPartsPerSide;
        for (std::int32_t i = 0; i < n; ++i)
            for (std::int32_t j = 0; j < n - i; ++j) {
                const double f = along_x * i + along_y * j + at_origin;
                parts |= static_cast<std::uint32_t>(f + above_up >= 0) << part++;
                if (i + j < n - 1) parts |= static_cast<std::uint32_t>(f + above_down >= 0) << part++;
            }
        return parts;
    }

    /// Not beyond the polygon's extremes along a direction.
    std::uint32_t parts_in_range(double along_x, double along_y) const {
        double low = along_x * corners_[0].x + along_y * corners_[0].y;
        double high = low;
        for (std::size_t k = 1; k < size_; ++k) {
            const double value = along_x * corners_[k].x + along_y * corners_[k].y;
            low = std::min(low, value);
            high = std::max(high, value);
        }
        return parts_reached(along_x, along_y, kPartSlack - low) &
               parts_reached(-along_x, -along_y, kPartSlack + high);
    }

    std::uint32_t parts_inside_of(const Point2& a, const Point2& b, bool clockwise) const {
        const double sign = clockwise ? -1 : 1;
        const double along_x = sign * (a.y - b.y), along_y = sign * (b.x - a.x);
        const double edge_length = std::fabs(along_x) + std::fabs(along_y);
        if (edge_length < kPartSlack) return ~0U; // its direction is lost in rounding
        const double slack = kPartSlack * edge_length;
        return parts_reached(along_x, along_y, slack - along_x * a.x - along_y * a.y);
    }

    std::array<Point2, 16> corners_;
    std::size_t size_ = 0;
};

/// A range of cell numbers along one coordinate.
struct Range {
    std::int32_t first, last;
};

/// A face's part in one octant, mirrored to where all coordinates are positive.
class OctantCover {
  public:
    OctantCover(const OctahedralCells& cells, std::uint32_t octant, std::vector<CellCover>& covers)
        : cells_(cells), octant_(octant), n_(cells.divisions()), covers_(covers) {}

    void add(const Polygon& polygon) const {
        const Range rows = range_of(polygon, &Vec3d::x);
        for (std::int32_t i = rows.first; i <= rows.last; ++i)
            add_row(rows.first == rows.last ? polygon : between(polygon, &Vec3d::x, i), i);
    }

  private:
    /// Where n c / (x + y + z) >= bound, if sign is 1, or <= bound, if it is -1; both with the slack.
    Polygon side(const Polygon& polygon, double Vec3d::*c, double bound, double sign) const {
        return polygon.clipped(
            [&](const Vec3d& p) { return sign * (n_ * p.*c - bound * sum_of(p)) + kSlack * sum_of(p); });
    }
    Polygon between(const Polygon& polygon, double Vec3d::*c, std::int32_t cell) const {
        return side(side(polygon, c, cell, 1), c, cell + 1, -1);
    }

    /// The cells along a coordinate that a polygon spans. Being a ratio of linear functions, the coordinate
    /// has its extremes at corners.
    Range range_of(const Polygon& polygon, double Vec3d::*c) const {
        double low = n_;
        double high = 0;
        for (const Vec3d& p : polygon) {
            const double value = n_ * p.*c / sum_of(p);
            low = std::min(low, value);
            high = std::max(high, value);
        }
        const auto first = static_cast<std::int32_t>(std::floor(low - kSlack));
        const auto last = static_cast<std::int32_t>(std::floor(high + kSlack));
        return {std::max(first, 0), std::min(last, n_ - 1)};
    }

    void add_row(const Polygon& row, std::int32_t i) const {
        if (row.empty()) return;
        const Range squares = range_of(row, &Vec3d::y);
        for (std::int32_t j = squares.first; j <= std::min(squares.last, n_ - 1 - i); ++j) {
            const Polygon square = squares.first == squares.last ? row : between(row, &Vec3d::y, j);
            const std::int32_t diagonal = n_ - 1 - i - j;
            add_cell(side(square, &Vec3d::z, diagonal, 1), i, j, false);
            if (diagonal > 0) add_cell(side(square, &Vec3d::z, diagonal, -1), i, j, true);
        }
    }

    void add_cell(const Polygon& part, std::int32_t i, std::int32_t j, bool down) const {
        if (part.empty()) return;
        const auto [nearest, farthest] = std::minmax_element(
            part.begin(), part.end(), [](const Vec3d& a, const Vec3d& b) { return sum_of(a) < sum_of(b); });
        covers_.push_back({cells_.index(octant_, i, j, down), parts_of(part, i, j, down), sum_of(*nearest),
                           sum_of(*farthest)});
    }

    std::uint16_t parts_of(const Polygon& polygon, std::int32_t i, std::int32_t j, bool down) const {
        constexpr double kSide = OctahedralCells::kPartsPerSide;
        PartCover cover;
        for (const Vec3d& p : polygon) {
            const double cells_per_step = n_ / sum_of(p);
            const double x = p.x * cells_per_step - i, y = p.y * cells_per_step - j;
            cover.add(down ? Point2{kSide * (1 - x), kSide * (1 - y)} : Point2{kSide * x, kSide * y});
        }
        return cover.parts();
    }

    const OctahedralCells& cells_;
    std::uint32_t octant_;
    std::int32_t n_;
    std::vector<CellCover>& covers_;
};

/// Nearer to the origin than this many lattice steps, directions of clipped corners cannot be told apart in
/// double. What a face has there is put into every cell of the octant; the centre of a map is seldom that
/// close to a surface.
constexpr double kNear = 8;

constexpr std::uint16_t kAllParts = 0xFFFF;

void cover_octant(const OctahedralCells& cells, std::uint32_t octant, const Polygon& polygon,
                  std::vector<CellCover>& covers) {
    const bool comes_near =
        std::any_of(polygon.begin(), polygon.end(), [](const Vec3d& p) { return sum_of(p) < kNear; });
    if (!comes_near) {
        OctantCover(cells, octant, covers).add(polygon);
        return;
    }
    const auto cells_per_octant = static_cast<std::uint32_t>(cells.divisions() * cells.divisions());
    for (std::uint32_t cell = 0; cell < cells_per_octant; ++cell)
        covers.push_back({octant * cells_per_octant + cell, kAllParts, 0, kNear});
    const Polygon rest = polygon.clipped([](const Vec3d& p) { return sum_of(p) - kNear / 2; });
    if (!rest.empty()) OctantCover(cells, octant, covers).add(rest);
}

} // namespace

void cover_cells(const OctahedralCells& cells, const std::array<LatticePoint, 3>& face,
                 std::vector<CellCover>& covers) {
    for (std::uint32_t octant = 0; octant < 8; ++octant) {
        const Vec3d mirror{octant & 1U ? -1.0 : 1.0, octant & 2U ? -1.0 : 1.0, octant & 4U ? -1.0 : 1.0};
        Polygon polygon;
        for (const LatticePoint& corner : face) {
            const Vec3d p(corner);
            polygon.add({p.x * mirror.x, p.y * mirror.y, p.z * mirror.z});
        }
        for (double Vec3d::*c : {&Vec3d::x, &Vec3d::y, &Vec3d::z})
            polygon = polygon.clipped([&](const Vec3d& p) { return p.*c; });
        if (!polygon.empty()) cover_octant(cells, octant, polygon, covers);
    }
}

} // namespace echinus
