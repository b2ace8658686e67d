#include "exact_map/cell_cover.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace echinus {

namespace {

constexpr std::int32_t kPartsPerSide = OctahedralCells::kPartsPerSide;
constexpr std::uint16_t kAllParts = 0xFFFF;

/// Widening of a polygon, in widths of a part.
constexpr double kSlack = 1e-3;

double sum_of(const Vec3d& p) {
    return p.x + p.y + p.z;
}

/// The corners of a face cut by at most four planes, each of which adds one.
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
    std::array<Vec3d, 8> corners_;
    std::size_t size_ = 0;
};

/// along_x x + along_y y + at_origin over the octant's triangle, with coordinates in widths of a part.
struct Affine {
    double along_x, along_y, at_origin;

    double operator()(double x, double y) const { return along_x * x + along_y * y + at_origin; }
    /// Least and most over a triangle (0, 0), (side, 0), (0, side), less the value at its origin.
    double least_over(double side) const { return side * std::min({0.0, along_x, along_y}); }
    double most_over(double side) const { return side * std::max({0.0, along_x, along_y}); }
    /// The same function seen from a cell: with the origin at the cell's corner, for a cell that is turned by
    /// half a turn with both axes turned too.
    Affine seen_from(std::int32_t i, std::int32_t j, bool down) const {
        const double x = kPartsPerSide * (down ? i + 1 : i), y = kPartsPerSide * (down ? j + 1 : j);
        return down ? Affine{-along_x, -along_y, (*this)(x, y)} : Affine{along_x, along_y, (*this)(x, y)};
    }
};

/// Calls visit(part, value at the part's origin, is the part turned) for the 16 parts of a cell.
template <typename Visit>
void for_each_part(const Affine& in_cell, const Visit& visit) {
    std::uint32_t part = 0;
    for (std::int32_t i = 0; i < kPartsPerSide; ++i)
        for (std::int32_t j = 0; j < kPartsPerSide - i; ++j) {
            visit(part++, in_cell(i, j), false);
            if (i + j < kPartsPerSide - 1) visit(part++, in_cell(i + 1, j + 1), true);
        }
}

/// Parts of a cell in which a function is somewhere not negative.
std::uint32_t parts_reached(const Affine& in_cell) {
    const double up_most = in_cell.most_over(1), down_most = -in_cell.least_over(1);
    std::uint32_t parts = 0;
    for_each_part(in_cell, [&](std::uint32_t part, double value, bool down) {
        parts |= static_cast<std::uint32_t>(value + (down ? down_most : up_most) >= 0) << part;
    });
    return parts;
}

struct Range {
    double low, high;

    void add(double value) {
        low = std::min(low, value);
        high = std::max(high, value);
    }
};

constexpr Range kEmptyRange{std::numeric_limits<double>::infinity(),
                            -std::numeric_limits<double>::infinity()};

/// Extremes of a function over some parts of a cell.
Range range_over(const Affine& in_cell, std::uint32_t parts) {
    const double least = in_cell.least_over(1), most = in_cell.most_over(1);
    Range range = kEmptyRange;
    for_each_part(in_cell, [&](std::uint32_t part, double value, bool down) {
        if ((parts >> part & 1U) == 0) return;
        range.add(value + (down ? -most : least));
        range.add(value + (down ? -least : most));
    });
    return range;
}

/// A face's plane, normal . p = height; exact.
struct Plane {
    Vec3d normal;
    double height;
};

/// A face's directions in one octant, mirrored to where all coordinates are positive.
class OctantCover {
  public:
    OctantCover(const OctahedralCells& cells, std::uint32_t octant, const Polygon& polygon,
                const Plane& plane)
        : cells_(cells), octant_(octant) {
        const double fine_n = kPartsPerSide * cells.divisions();
        for (const Vec3d& p : polygon) {
            const double sum = sum_of(p);
            corners_[size_++] = {p.x / sum * fine_n, p.y / sum * fine_n};
            l1_.add(sum);
        }
        add_ranges();
        add_sides();
        set_reciprocal(plane, fine_n);
    }

    void add_cells(std::vector<CellCover>& covers) const {
        const std::int32_t n = cells_.divisions();
        const std::int32_t last_i = cell_of(x_.high + kSlack);
        for (std::int32_t i = cell_of(x_.low - kSlack); i <= last_i; ++i) {
            const std::int32_t last_j = std::min(cell_of(y_.high + kSlack), n - 1 - i);
            for (std::int32_t j = cell_of(y_.low - kSlack); j <= last_j; ++j) {
                add_cell(i, j, false, covers);
                if (i + j < n - 1) add_cell(i, j, true, covers);
            }
        }
    }

  private:
    struct Point {
        double x, y;
    };

    std::int32_t cell_of(double coordinate) const {
        return std::clamp(static_cast<std::int32_t>(std::floor(coordinate / kPartsPerSide)), 0,
                          cells_.divisions() - 1);
    }

    /// Keeps what lies on the positive side.
    void add_half_plane(const Affine& f) { half_planes_[half_plane_count_++] = f; }

    /// Sides of cells and parts as separating lines.
    void add_ranges() {
        Range diagonal = kEmptyRange;
        for (std::size_t k = 0; k < size_; ++k) {
            x_.add(corners_[k].x);
            y_.add(corners_[k].y);
            diagonal.add(corners_[k].x + corners_[k].y);
        }
        add_half_plane({1, 0, kSlack - x_.low});
        add_half_plane({-1, 0, kSlack + x_.high});
        add_half_plane({0, 1, kSlack - y_.low});
        add_half_plane({0, -1, kSlack + y_.high});
        add_half_plane({1, 1, 2 * kSlack - diagonal.low});
        add_half_plane({-1, -1, 2 * kSlack + diagonal.high});
    }

    /// The polygon's own sides as separating lines.
    void add_sides() {
        double doubled_area = 0;
        for (std::size_t k = 0; k < size_; ++k) {
            const Point &a = corners_[k], &b = corners_[k + 1 < size_ ? k + 1 : 0];
            doubled_area += a.x * b.y - a.y * b.x;
        }
        // Where the polygon is so thin that rounding decides this, both signs keep what is within the slack.
        const double sign = doubled_area < 0 ? -1 : 1;
        for (std::size_t k = 0; k < size_; ++k) {
            const Point &a = corners_[k], &b = corners_[k + 1 < size_ ? k + 1 : 0];
            const double along_x = sign * (a.y - b.y), along_y = sign * (b.x - a.x);
            const double side_length = std::fabs(along_x) + std::fabs(along_y);
            if (side_length < kSlack) continue; // its direction is lost in rounding
            add_half_plane({along_x, along_y, kSlack * side_length - along_x * a.x - along_y * a.y});
        }
    }

    /// 1 / L1 norm over the face's plane: (normal . u) / height for a direction u with |u|_1 = 1.
    void set_reciprocal(const Plane& plane, double fine_n) {
        const auto& [normal, height] = plane;
        const double scale = 1 / (fine_n * height);
        reciprocal_ = {(normal.x - normal.z) * scale, (normal.y - normal.z) * scale,
                       normal.z * fine_n * scale};
        const double size = std::fabs(normal.x) + std::fabs(normal.y) + std::fabs(normal.z);
        reciprocal_error_ = size / std::fabs(height) * 0x1p-46;
    }

    void add_cell(std::int32_t i, std::int32_t j, bool down, std::vector<CellCover>& covers) const {
        std::uint32_t parts = kAllParts;
        for (std::size_t k = 0; k < half_plane_count_ && parts != 0; ++k) {
            const Affine in_cell = half_planes_[k].seen_from(i, j, down);
            if (in_cell.at_origin + in_cell.least_over(kPartsPerSide) >= 0) continue;
            parts &= parts_reached(in_cell);
        }
        if (parts == 0) return;
        const Range l1 = l1_range(reciprocal_.seen_from(i, j, down), parts);
        covers.push_back(
            {cells_.index(octant_, i, j, down), static_cast<std::uint16_t>(parts), l1.low, l1.high});
    }

    /// What the plane has over the parts, where that is better than what the polygon has as a whole.
    Range l1_range(const Affine& reciprocal, std::uint32_t parts) const {
        if (!std::isfinite(reciprocal_error_)) return l1_; // edge-on
        const Range range = range_over(reciprocal, parts);
        const double low = range.low - reciprocal_error_, high = range.high + reciprocal_error_;
        // A plane that is steep against the rays goes through infinity; only where it is in front does it
        // count.
        return {high > 0 ? std::max(l1_.low, 1 / high) : l1_.low,
                low > 0 ? std::min(l1_.high, 1 / low) : l1_.high};
    }

    const OctahedralCells& cells_;
    std::uint32_t octant_;
    std::array<Point, 8> corners_;
    std::size_t size_ = 0;
    Range x_ = kEmptyRange, y_ = kEmptyRange, l1_ = kEmptyRange;
    std::array<Affine, 6 + 8> half_planes_;
    std::size_t half_plane_count_ = 0;
    Affine reciprocal_{};
    double reciprocal_error_ = 0;
};

/// Nearer to the origin than this many lattice steps, directions of cut corners cannot be told apart in
/// double. What a face has there is put into every part of every cell of the octant; the centre of a map is
/// seldom that close to a surface.
constexpr double kNear = 8;

void cover_octant(const OctahedralCells& cells, std::uint32_t octant, const Polygon& polygon,
                  const Plane& plane, std::vector<CellCover>& covers) {
    const bool comes_near =
        std::any_of(polygon.begin(), polygon.end(), [](const Vec3d& p) { return sum_of(p) < kNear; });
    if (!comes_near) {
        OctantCover(cells, octant, polygon, plane).add_cells(covers);
        return;
    }
    const std::size_t first = covers.size();
    const Polygon rest = polygon.clipped([](const Vec3d& p) { return sum_of(p) - kNear / 2; });
    if (!rest.empty()) OctantCover(cells, octant, rest, plane).add_cells(covers);
    // A cell may list a face but once, or its crossings would count twice.
    const auto cells_per_octant = static_cast<std::uint32_t>(cells.divisions() * cells.divisions());
    std::vector<bool> covered(cells_per_octant);
    for (std::size_t i = first; i < covers.size(); ++i) {
        covered[covers[i].cell - octant * cells_per_octant] = true;
        covers[i].parts = kAllParts;
        covers[i].nearest = 0;
    }
    for (std::uint32_t cell = 0; cell < cells_per_octant; ++cell)
        if (!covered[cell]) covers.push_back({octant * cells_per_octant + cell, kAllParts, 0, kNear});
}

/// Does the face reach where a coordinate has the sign of `mirror`? A face that only touches the wall does.
bool reaches(const std::array<Vec3d, 3>& corners, double Vec3d::*c, double mirror) {
    return std::any_of(corners.begin(), corners.end(), [&](const Vec3d& p) { return p.*c * mirror >= 0; });
}

} // namespace

void cover_cells(const OctahedralCells& cells, const std::array<LatticePoint, 3>& face,
                 std::vector<CellCover>& covers) {
    const std::array<Vec3d, 3> corners{Vec3d(face[0]), Vec3d(face[1]), Vec3d(face[2])};
    const LatticePoint normal = cross(face[1] - face[0], face[2] - face[0]);
    const auto height = static_cast<double>(dot(normal, face[0]));
    const auto mirrored = [](const Vec3d& v, const Vec3d& mirror) {
        return Vec3d{v.x * mirror.x, v.y * mirror.y, v.z * mirror.z};
    };
    for (std::uint32_t octant = 0; octant < 8; ++octant) {
        const Vec3d mirror{octant & 1U ? -1.0 : 1.0, octant & 2U ? -1.0 : 1.0, octant & 4U ? -1.0 : 1.0};
        if (!reaches(corners, &Vec3d::x, mirror.x) || !reaches(corners, &Vec3d::y, mirror.y) ||
            !reaches(corners, &Vec3d::z, mirror.z))
            continue;
        Polygon polygon;
        for (const Vec3d& corner : corners) polygon.add(mirrored(corner, mirror));
        for (double Vec3d::*c : {&Vec3d::x, &Vec3d::y, &Vec3d::z})
            if (reaches(corners, c, -(mirror.*c)))
                polygon = polygon.clipped([&](const Vec3d& p) { return p.*c; });
        if (!polygon.empty())
            cover_octant(cells, octant, polygon, {mirrored(Vec3d(normal), mirror), height}, covers);
    }
}

} // namespace echinus
