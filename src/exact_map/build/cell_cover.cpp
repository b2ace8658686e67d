#include "exact_map/build/cell_cover.hpp"

#include "exact_map/build/part_tables.hpp"
#include "geometry/whole_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace echinus {

namespace {

constexpr std::int32_t kPartsPerSide = OctahedralCells::kPartsPerSide;
constexpr std::uint16_t kAllParts = 0xFFFF;

/// How far a polygon is widened, in widths of a part.
constexpr double kSlack = 1e-3;

double sum_of(const Vec3d& p) {
    return p.x + p.y + p.z;
}

/// The corners of a face that was cut by at most four planes, each of which adds at most one corner.
class Polygon {
  public:
    void add(const Vec3d& corner) { corners_[size_++] = corner; }
    bool empty() const { return size_ == 0; }
    const Vec3d* begin() const { return corners_.data(); }
    const Vec3d* end() const { return corners_.data() + size_; }

    /// The part in which a linear function is not negative (Sutherland and Hodgman 1974).
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

/// The function along_x x + along_y y + at_origin on the octant's triangle, with coordinates in widths of a
/// part.
struct Affine {
    double along_x, along_y, at_origin;

    double operator()(double x, double y) const { return along_x * x + along_y * y + at_origin; }
    /// Minimum and maximum over a part that is not turned, relative to the value at its origin. A turned part
    /// is that part mirrored in its origin.
    double least_in_part() const { return 0.5 * (least_slope() - std::fabs(least_slope())); }
    double most_in_part() const { return 0.5 * (most_slope() + std::fabs(most_slope())); }

  private:
    // Clamped at 0 above without the branch that a compiler would generate for std::min.
    double least_slope() const { return std::min(along_x, along_y); }
    double most_slope() const { return std::max(along_x, along_y); }
};

struct Range {
    double low, high;

    void add(double value) {
        low = std::min(low, value);
        high = std::max(high, value);
    }
};

constexpr Range kEmptyRange{std::numeric_limits<double>::infinity(),
                            -std::numeric_limits<double>::infinity()};

/// A face's plane, normal . p = height.
struct Plane {
    Vec3d normal;  ///< exact
    double height; ///< 0 only if it is exactly 0
};

/// A word with bits first to last set, limited to the bits of a word.
std::uint64_t ones(std::int32_t first, std::int32_t last) {
    first = std::max(first, 0);
    last = std::min(last, 63);
    const std::uint64_t run = (~std::uint64_t{0} >> ((63 - last) & 63)) & (~std::uint64_t{0} << (first & 63));
    return first > last ? 0 : run;
}

/// A face's directions in one octant, mirrored to where all coordinates are positive.
///
/// Row i of the octant, where x is from i to i + 1 in widths of a part, is a strip of triangles: number 2 j
/// is the part of square j that is not turned and 2 j + 1 the one that is. A half-plane whose bounding line
/// crosses the row touches one triangle and all that follow it, or all that precede it. So the triangles of a
/// row that the polygon touches are consecutive.
class OctantCover {
  public:
    OctantCover(const OctahedralCells& cells, std::uint32_t octant, const Polygon& polygon,
                const Plane& plane)
        : cells_(cells), octant_(octant), fine_n_(kPartsPerSide * cells.divisions()) {
        for (const Vec3d& p : polygon) {
            const double sum = sum_of(p);
            const double scale = fine_n_ / sum;
            corners_[size_++] = {p.x * scale, p.y * scale};
            l1_.add(sum);
        }
        set_ranges();
        add_sides();
        set_reciprocal(plane);
    }

    void add_cells(std::vector<CellCover>& covers) const {
        for (std::int32_t i = rows_.first / kPartsPerSide; i <= rows_.last / kPartsPerSide; ++i)
            add_row_of_cells(i, covers);
    }

  private:
    struct Point {
        double x, y;
    };

    /// A closed range of integers; empty if first > last.
    struct Run {
        std::int32_t first, last;
    };

    /// A side of the polygon, as a half-plane.
    struct Side {
        Affine inner; ///< not negative on the polygon's side of the line and up to `slack` beyond it
        double slack;
    };

    /// Where a side's line crosses row i. The first or last triangle of the half-plane among those that are
    /// not turned is slope i + upright, rounded to the nearest even number; among the turned ones it is one
    /// more than slope i + turned, rounded likewise.
    struct Crossing {
        double slope, upright, turned;
    };

    using Row = std::array<double, kPartRows>; ///< one number for each row of parts in a row of cells

    /// The nearest even number; of two that are equally near, either. Uses only operations that every
    /// instruction set has for vectors.
    static double even(double value) {
        constexpr double kShift = 0x1.8p53; // doubles that large are even
        return (value + kShift) - kShift;
    }

    /// @pre -2 <= value < 2^30
    static std::int32_t floor_of(double value) { return truncated_to<std::int32_t>(value + 2) - 2; }

    /// Uses the sides of cells and parts as separating lines.
    void set_ranges() {
        Range x = kEmptyRange, y = kEmptyRange, diagonal = kEmptyRange;
        for (std::size_t k = 0; k < size_; ++k) {
            x.add(corners_[k].x);
            y.add(corners_[k].y);
            diagonal.add(corners_[k].x + corners_[k].y);
        }
        const std::int32_t end = fine_n_ - 1;
        rows_ = {std::max(floor_of(x.low - kSlack), 0), std::min(floor_of(x.high + kSlack), end)};
        squares_ = {std::max(floor_of(y.low - kSlack), 0), std::min(floor_of(y.high + kSlack), end)};
        diagonals_ = {floor_of(diagonal.low - 2 * kSlack),
                      std::min(floor_of(diagonal.high + 2 * kSlack), end)};
    }

    /// Uses the polygon's own sides as separating lines.
    void add_sides() {
        // A triangle has at most two sides of each kind. If it has only one, a line beyond all rows replaces
        // the other: a loop with a constant number of rounds is never mispredicted.
        const double beyond = 4.0 * fine_n_;
        firsts_[0] = firsts_[1] = {0, -beyond, -beyond};
        lasts_[0] = lasts_[1] = {0, beyond, beyond};
        double doubled_area = 0;
        for (std::size_t k = 0; k < size_; ++k) {
            const Point &a = corners_[k], &b = corners_[k + 1 < size_ ? k + 1 : 0];
            doubled_area += a.x * b.y - a.y * b.x;
        }
        // If the polygon is so thin that rounding decides the sign, either sign keeps all that lies within
        // the slack.
        const double sign = std::copysign(1.0, doubled_area);
        for (std::size_t k = 0; k < size_; ++k) {
            const Point &a = corners_[k], &b = corners_[k + 1 < size_ ? k + 1 : 0];
            const double along_x = sign * (a.y - b.y), along_y = sign * (b.x - a.x);
            const double length = std::fabs(along_x) + std::fabs(along_y);
            if (length < kSlack) {
                lacks_sides_ = true; // their direction is lost in rounding
                continue;
            }
            const double slack = kSlack * length;
            add_side({{along_x, along_y, slack - along_x * a.x - along_y * a.y}, slack});
        }
        first_count_ = std::max<std::size_t>(2, first_count_);
        last_count_ = std::max<std::size_t>(2, last_count_);
    }

    void add_side(const Side& side) {
        sides_[side_count_++] = side;
        const Affine& inner = side.inner;
        constexpr double kParallel = 1e-9; // parallel to the rows: the range of rows is then equivalent
        if (std::fabs(inner.along_y) < kParallel * std::fabs(inner.along_x)) return;
        const double scale = -2 / inner.along_y;
        const double slope = inner.along_x * scale;
        const double upright = (inner.at_origin + inner.most_in_part()) * scale;
        const double turned = slope - 2 + (inner.at_origin - inner.least_in_part()) * scale;
        // Rounded up if the half-plane begins here and down if it ends here. Which one it is cannot be
        // predicted, so both are written and one is kept.
        const bool begins = inner.along_y > 0;
        constexpr std::size_t kSpare = 8;
        firsts_[begins ? first_count_ : kSpare] = {slope, upright + 1, turned + 1};
        lasts_[begins ? kSpare : last_count_] = {slope, upright - 1, turned - 1};
        first_count_ += begins ? 1 : 0;
        last_count_ += begins ? 0 : 1;
    }

    /// 1 / L1 norm over the face's plane: (normal . u) / height for a direction u with |u|_1 = 1.
    void set_reciprocal(const Plane& plane) {
        const auto& [normal, height] = plane;
        const double scale = 1 / (fine_n_ * height);
        reciprocal_ = {(normal.x - normal.z) * scale, (normal.y - normal.z) * scale,
                       normal.z * fine_n_ * scale};
        const double size = std::fabs(normal.x) + std::fabs(normal.y) + std::fabs(normal.z);
        reciprocal_error_ = size / std::fabs(height) * 0x1p-46;
        const double least = reciprocal_.least_in_part(), most = reciprocal_.most_in_part();
        for (std::size_t part = 0; part < OctahedralCells::kPartCount; ++part) {
            const double at_origin =
                reciprocal_.along_x * kPartPlaces.x[part] + reciprocal_.along_y * kPartPlaces.y[part];
            const double upright = kPartPlaces.upright[part], turned = kPartPlaces.turned[part];
            part_lows_[part] = at_origin + upright * least - turned * most;
            part_highs_[part] = at_origin + upright * most - turned * least;
        }
        part_lows_[kNoPart] = kEmptyRange.low;
        part_highs_[kNoPart] = kEmptyRange.high;
    }

    /// The triangles that the polygon touches in each row of parts within a row of cells.
    std::array<Run, kPartRows> strips(std::int32_t i) const {
        Row first, last;
        for (std::size_t row = 0; row < kPartRows; ++row) {
            const double at = kPartsPerSide * i + static_cast<double>(row);
            first[row] = std::max(2.0 * squares_.first, 2 * (diagonals_.first - at) - 1);
            last[row] = std::min(2.0 * squares_.last + 1, 2 * (diagonals_.last - at));
        }
        for (std::size_t k = 0; k < first_count_; ++k)
            for (std::size_t row = 0; row < kPartRows; ++row) {
                const auto [upright, turned] = triangles_at(firsts_[k], i, row);
                first[row] = std::max(first[row], std::min(upright, turned));
            }
        for (std::size_t k = 0; k < last_count_; ++k)
            for (std::size_t row = 0; row < kPartRows; ++row) {
                const auto [upright, turned] = triangles_at(lasts_[k], i, row);
                last[row] = std::min(last[row], std::max(upright, turned));
            }
        std::array<Run, kPartRows> runs;
        const double end = 2 * fine_n_;
        for (std::int32_t row = 0; row < kPartsPerSide; ++row) {
            const auto r = static_cast<std::size_t>(row);
            const std::int32_t at = kPartsPerSide * i + row;
            const bool touched = (at >= rows_.first) & (at <= rows_.last);
            runs[r] = {truncated_to<std::int32_t>(std::min(first[r], end)),
                       truncated_to<std::int32_t>(std::max(last[r], -1.0))};
            runs[r].last = touched ? runs[r].last : -1;
        }
        return runs;
    }

    struct TrianglesAt {
        double upright, turned;
    };

    static TrianglesAt triangles_at(const Crossing& crossing, std::int32_t i, std::size_t row) {
        const double at = crossing.slope * (kPartsPerSide * i + static_cast<double>(row));
        return {even(at + crossing.upright), even(at + crossing.turned) + 1};
    }

    void add_row_of_cells(std::int32_t i, std::vector<CellCover>& covers) const {
        const std::array<Run, kPartRows> runs = strips(i);
        Run hull{std::numeric_limits<std::int32_t>::max(), -1};
        for (const Run& run : runs) {
            const bool empty = run.first > run.last;
            hull = {std::min(hull.first, empty ? hull.first : run.first),
                    std::max(hull.last, empty ? hull.last : run.last)};
        }
        if (hull.last < 0) return;
        const Run squares{std::max(hull.first, 0) / kStripLength, hull.last / kStripLength};
        for (std::int32_t j = squares.first; j <= squares.last; j += kSquaresPerWord)
            add_squares(i, {j, std::min(squares.last, j + kSquaresPerWord - 1)}, runs, covers);
    }

    /// Adds the cells of some squares in a row of cells; their strips are bytes of four words.
    void add_squares(std::int32_t i, const Run& squares, const std::array<Run, kPartRows>& strips,
                     std::vector<CellCover>& covers) const {
        std::array<std::uint64_t, kPartRows> words;
        const std::int32_t begin = squares.first * kStripLength;
        for (std::size_t row = 0; row < kPartRows; ++row)
            words[row] = ones(strips[row].first - begin, strips[row].last - begin);
        for (std::int32_t j = squares.first; j <= squares.last; ++j) {
            std::uint32_t parts = 0;
            for (std::size_t row = 0; row < kPartRows; ++row) {
                parts |= kPartsOfStrip[row][words[row] & 0xFF];
                words[row] >>= kStripLength;
            }
            if (const std::uint32_t up = parts & 0xFFFF; up != 0) add_cell<false>(i, j, up, covers);
            if (const std::uint32_t down = parts >> 16; down != 0) add_cell<true>(i, j, down, covers);
        }
    }

    template <bool down>
    void add_cell(std::int32_t i, std::int32_t j, std::uint32_t parts, std::vector<CellCover>& covers) const {
        const Range l1 = l1_range<down>(i, j, parts);
        const std::uint32_t at_middle = parts >> OctahedralCells::middle_part() & 1U;
        const auto middle =
            static_cast<MiddleRay>(at_middle * static_cast<std::uint32_t>(middle_ray(i, j, down)));
        covers.push_back(
            {cells_.index(octant_, i, j, down), static_cast<std::uint16_t>(parts), middle, l1.low, l1.high});
    }

    /// A range that contains every point of the polygon over the parts and lies within the polygon's own
    /// range: l1_.low <= low <= high <= l1_.high.
    ///
    /// Points over the parts lie in two ranges: the polygon's, since the L1 norm is linear and has its
    /// extremes at corners, and the plane's over the parts. Clamping the ends of the latter to the former
    /// gives their intersection and loses no point. The intersection is empty if the cover, within its slack,
    /// includes only parts that the polygon does not enter; a plane that is steep relative to the rays may
    /// then be anywhere, even at infinity. In this case there is no point to lose, and clamping yields the
    /// end of the polygon's range nearer to the plane; that end is on the lattice. As clamping keeps the
    /// order of two numbers, low never exceeds high.
    template <bool down>
    Range l1_range(std::int32_t i, std::int32_t j, std::uint32_t parts) const {
        if (!std::isfinite(reciprocal_error_)) return l1_; // edge-on
        const Range in_cell = range_over(parts);
        // A down cell has its axes reversed.
        const std::int32_t turn = down ? 1 : 0;
        const double at_origin = reciprocal_(kPartsPerSide * (i + turn), kPartsPerSide * (j + turn));
        const double low = at_origin + (down ? -in_cell.high : in_cell.low) - reciprocal_error_;
        const double high = at_origin + (down ? -in_cell.low : in_cell.high) + reciprocal_error_;
        // The plane is in front of the origin where the reciprocal is positive, and unbounded near where it
        // is 0.
        return {high > 0 ? std::clamp(1 / high, l1_.low, l1_.high) : l1_.low,
                low > 0 ? std::clamp(1 / low, l1_.low, l1_.high) : l1_.high};
    }

    /// Extremes of the reciprocal over parts of a cell, relative to its value at the cell's origin. It
    /// ascends or descends along every strip, so its extremes are at ends of rows.
    Range range_over(std::uint32_t parts) const {
        const std::size_t low_end = reciprocal_.along_y >= 0 ? 0 : 1;
        const auto lows = kRowEnds.of(parts, low_end), highs = kRowEnds.of(parts, 1 - low_end);
        return {std::min(std::min(part_lows_[lows[0]], part_lows_[lows[1]]),
                         std::min(part_lows_[lows[2]], part_lows_[lows[3]])),
                std::max(std::max(part_highs_[highs[0]], part_highs_[highs[1]]),
                         std::max(part_highs_[highs[2]], part_highs_[highs[3]]))};
    }

    /// Computed without a branch, since the outcome is unpredictable.
    MiddleRay middle_ray(std::int32_t i, std::int32_t j, bool down) const {
        constexpr double kThird = kPartsPerSide / 3.0;
        const double offset = down ? 2 * kThird : kThird;
        const double x = kPartsPerSide * i + offset, y = kPartsPerSide * j + offset;
        double least = kEmptyRange.low, least_sure = kEmptyRange.low;
        for (std::size_t k = 0; k < side_count_; ++k) {
            const double value = sides_[k].inner(x, y);
            least = std::min(least, value);
            least_sure = std::min(least_sure, value - 2 * sides_[k].slack);
        }
        static_assert(static_cast<int>(MiddleRay::Misses) == 0 && static_cast<int>(MiddleRay::Meets) == 1 &&
                      static_cast<int>(MiddleRay::Unsure) == 2);
        const int unsure = static_cast<int>(lacks_sides_) | static_cast<int>(!(least_sure > 0));
        return static_cast<MiddleRay>(static_cast<int>(least >= 0) * (1 + unsure));
    }

    static constexpr std::int32_t kSquaresPerWord = 64 / kStripLength;

    const OctahedralCells& cells_;
    std::uint32_t octant_;
    std::int32_t fine_n_; ///< rows of parts in the octant
    std::array<Point, 8> corners_;
    std::size_t size_ = 0;
    Run rows_, squares_, diagonals_; ///< ranges that the polygon touches; diagonals: x + y
    Range l1_ = kEmptyRange;
    std::array<Side, 8> sides_;
    std::size_t side_count_ = 0;
    bool lacks_sides_ = false;
    std::array<Crossing, 8 + 1> firsts_, lasts_; ///< where half-planes begin and end along the rows
    std::size_t first_count_ = 0, last_count_ = 0;
    Affine reciprocal_;
    double reciprocal_error_;
    std::array<double, kNoPart + 1> part_lows_, part_highs_; ///< extremes over parts, as in range_over()
};

/// Closer to the origin than this many lattice steps, the directions of cut corners cannot be distinguished
/// in double. A face there is listed in every part of every cell of the octant; the centre of a map is seldom
/// that close to a surface.
constexpr double kNear = 8;

void cover_near_octant(const OctahedralCells& cells, std::uint32_t octant, const Polygon& polygon,
                       const Plane& plane, std::vector<CellCover>& covers) {
    const std::size_t first = covers.size();
    const Polygon rest = polygon.clipped([](const Vec3d& p) { return sum_of(p) - kNear / 2; });
    if (!rest.empty()) OctantCover(cells, octant, rest, plane).add_cells(covers);
    // A cell must list a face only once, or its crossings would count twice.
    const auto cells_per_octant = static_cast<std::uint32_t>(cells.divisions() * cells.divisions());
    std::vector<bool> covered(cells_per_octant);
    for (std::size_t i = first; i < covers.size(); ++i) {
        covered[covers[i].cell - octant * cells_per_octant] = true;
        covers[i].parts = kAllParts;
        covers[i].middle = MiddleRay::Unsure;
        covers[i].nearest = 0;
        covers[i].farthest = std::max(covers[i].farthest, kNear);
    }
    for (std::uint32_t cell = 0; cell < cells_per_octant; ++cell)
        if (!covered[cell])
            covers.push_back({octant * cells_per_octant + cell, kAllParts, MiddleRay::Unsure, 0, kNear});
}

void cover_octant(const OctahedralCells& cells, std::uint32_t octant, const Polygon& polygon,
                  const Plane& plane, std::vector<CellCover>& covers) {
    if (std::any_of(polygon.begin(), polygon.end(), [](const Vec3d& p) { return sum_of(p) < kNear; }))
        cover_near_octant(cells, octant, polygon, plane, covers);
    else
        OctantCover(cells, octant, polygon, plane).add_cells(covers);
}

/// Bit k is set if some corner has a coordinate k that is not negative. A face that only touches a wall
/// counts.
std::uint32_t reached_sides(const std::array<LatticePoint, 3>& face) {
    const auto reaches = [&](std::int64_t LatticePoint::*c) {
        return std::uint32_t{std::max(std::max(face[0].*c, face[1].*c), face[2].*c) >= 0};
    };
    return reaches(&LatticePoint::x) | reaches(&LatticePoint::y) << 1 | reaches(&LatticePoint::z) << 2;
}

/// Mirrors a vector so that all coordinates of the octant become positive.
Vec3d mirrored(const Vec3d& v, std::uint32_t octant) {
    constexpr std::array<double, 2> kSign{1, -1};
    return {v.x * kSign[octant & 1U], v.y * kSign[octant >> 1 & 1U], v.z * kSign[octant >> 2 & 1U]};
}

} // namespace

std::uint32_t octants_met(const std::array<LatticePoint, 3>& face) {
    const std::uint32_t positive = reached_sides(face);
    const std::uint32_t negative = reached_sides({-face[0], -face[1], -face[2]});
    std::uint32_t met = 0;
    for (std::uint32_t octant = 0; octant < 8; ++octant)
        met |= ((octant ^ negative) & ~(positive & negative)) == 0 ? 1U << octant : 0U;
    return met;
}

void cover_cells(const OctahedralCells& cells, const Octants& octants,
                 const std::array<LatticePoint, 3>& face, std::vector<CellCover>& covers) {
    const std::uint32_t positive = reached_sides(face);
    const std::uint32_t negative = reached_sides({-face[0], -face[1], -face[2]});
    const std::uint32_t both = positive & negative;
    if (both == 0 && !octants.hold(negative)) return;
    const LatticePoint normal = cross(face[1] - face[0], face[2] - face[0]);
    const auto height = static_cast<double>(dot(normal, face[0]));
    if (both == 0) { // the usual case
        Polygon polygon;
        for (const LatticePoint& corner : face) polygon.add(mirrored(Vec3d(corner), negative));
        return cover_octant(cells, negative, polygon, {mirrored(Vec3d(normal), negative), height}, covers);
    }
    for (std::uint32_t octant = octants.first; octant < octants.last; ++octant) {
        if (((octant ^ negative) & ~both) != 0) continue;
        Polygon polygon;
        for (const LatticePoint& corner : face) polygon.add(mirrored(Vec3d(corner), octant));
        std::uint32_t axis = 1;
        for (double Vec3d::*c : {&Vec3d::x, &Vec3d::y, &Vec3d::z}) {
            if ((both & axis) != 0) polygon = polygon.clipped([&](const Vec3d& p) { return p.*c; });
            axis <<= 1;
        }
        if (!polygon.empty())
            cover_octant(cells, octant, polygon, {mirrored(Vec3d(normal), octant), height}, covers);
    }
}

} // namespace echinus
