#include "judges/crossing_counter.hpp"

#include <echinus/geometry.hpp>

#include <CGAL/Exact_integer.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <vector>

namespace echinus::test {

namespace {

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

/// About twice the square root of the number of faces: most faces then fall into a few cells and most cells
/// list a few faces.
std::size_t cells_across(std::size_t face_count) {
    const auto wanted = static_cast<std::size_t>(2 * std::sqrt(static_cast<double>(face_count)));
    return std::clamp<std::size_t>(wanted, 16, 1024);
}

Vec3d unit_of(const Vec3d& v) {
    return v * (1 / length(v));
}

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

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Integer = CGAL::Exact_integer;
using IntegerPoint = CGAL::Simple_cartesian<Integer>::Point_3;

/// Avoids the corners, edges and planes that a modeller would draw, is long enough to leave every surface,
/// and consists of primes, so that rays between points of whole numbers seldom meet edges.
constexpr Vec3d kDirectionInUnits{1299709, 1999993, 2750159};
constexpr int kMaxAttempts = 16;
/// More than a ray's jitter plus rounding.
constexpr double kSlackInUnits = 64;

/// The end of the ray. Each attempt gives another ray; the ends lie on no common plane, since that could
/// contain a face.
Vec3d end_of_ray(const Vec3d& start, double unit, int attempt) {
    const auto scattered = [attempt](int factor, int modulus) {
        return static_cast<double>(factor * attempt % modulus);
    };
    const Vec3d jitter{scattered(7, 31), scattered(11, 29), scattered(13, 23)};
    return start + (kDirectionInUnits + jitter) * unit;
}

Point to_cgal(const Vec3d& p) {
    return {p.x, p.y, p.z};
}

/// Scaled by 2^180, so that displacements by 2^-60, 2^-120 and 2^-180 are whole numbers.
Integer scaled(double whole) {
    return Integer(whole) << 180;
}
IntegerPoint to_integers(const Point& p) {
    return {scaled(p.x()), scaled(p.y()), scaled(p.z())};
}

/// p + (e, e^2, e^3) with e = 2^-60. Determinants of whole numbers are whole numbers, and as functions of p
/// they are linear with whole coefficients below 2^48: so each power of e decides before the next one counts,
/// and none changes a nonzero sign. A smaller e gives the same answers.
IntegerPoint displaced(const Point& p) {
    return {scaled(p.x()) + (Integer(1) << 120), scaled(p.y()) + (Integer(1) << 60), scaled(p.z()) + 1};
}

/// Signs of determinants with one particle in them.
class Side {
  public:
    Side(const Point& particle, OnPlane on_plane) : particle_(particle), on_plane_(on_plane) {}

    /// On which side of the plane abc is the particle? 0: on it.
    int of_plane(const Point& a, const Point& b, const Point& c) const {
        const int sign = CGAL::orientation(a, b, c, particle_);
        if (sign != 0 || on_plane_ == OnPlane::Skip) return sign;
        return CGAL::orientation(to_integers(a), to_integers(b), to_integers(c), displaced(particle_));
    }

    /// On which side of the plane through the particle, the ray's end and a is b? 0: on it.
    int of_ray(const Point& end, const Point& a, const Point& b) const {
        const int sign = CGAL::orientation(particle_, end, a, b);
        if (sign != 0 || on_plane_ == OnPlane::Skip) return sign;
        return CGAL::orientation(displaced(particle_), to_integers(end), to_integers(a), to_integers(b));
    }

  private:
    Point particle_;
    OnPlane on_plane_;
};

/// +1 where the ray leaves the solid through the face, -1 where it enters, 0 where it misses the face;
/// nothing where it meets an edge or a vertex or ends on the plane.
std::optional<int> crossing(const std::array<Point, 3>& face, const Side& particle, const Point& end) {
    const auto& [a, b, c] = face;
    const int start_side = particle.of_plane(a, b, c);
    // A ray from a point of the plane meets the plane only there: either the point lies on the face itself,
    // or the ray misses the face. A face without area has no sides.
    if (start_side == 0) return 0;
    const int end_side = CGAL::orientation(a, b, c, end);
    if (end_side == 0) return std::nullopt;
    if (end_side == start_side) return 0;
    const int ab = particle.of_ray(end, a, b);
    const int bc = particle.of_ray(end, b, c);
    if (ab * bc < 0) return 0;
    const int ca = particle.of_ray(end, c, a);
    if (ab * ca < 0 || bc * ca < 0) return 0;
    if (ab == 0 || bc == 0 || ca == 0) return std::nullopt;
    return end_side;
}

} // namespace

struct CrossingCounter::Structure {
    Structure(const std::vector<Corners>& corners, double unit_, OnPlane on_plane_)
        : grid(corners, kDirectionInUnits, kSlackInUnits * unit_), unit(unit_), on_plane(on_plane_) {
        faces.reserve(corners.size());
        for (const auto& [a, b, c] : corners) faces.push_back({to_cgal(a), to_cgal(b), to_cgal(c)});
    }

    std::optional<int> winding_along(const Vec3d& point, int attempt) const {
        const Side particle(to_cgal(point), on_plane);
        const Point end = to_cgal(end_of_ray(point, unit, attempt));
        int winding = 0;
        bool generic = true;
        grid.for_each_near(point, [&](std::uint32_t face) {
            const std::optional<int> sign = crossing(faces[face], particle, end);
            winding += sign.value_or(0);
            generic = generic && sign;
        });
        return generic ? std::optional(winding) : std::nullopt;
    }

    RayGrid grid;
    std::vector<std::array<Point, 3>> faces;
    double unit;
    OnPlane on_plane;
};

CrossingCounter::CrossingCounter(std::vector<Corners> faces, double unit, OnPlane on_plane)
    : structure_(std::make_unique<const Structure>(faces, unit, on_plane)) {}
CrossingCounter::CrossingCounter(CrossingCounter&& other) noexcept = default;
CrossingCounter::~CrossingCounter() = default;

int CrossingCounter::winding(const Vec3d& point) const {
    for (int attempt = 0; attempt < kMaxAttempts; ++attempt)
        if (const auto winding = structure_->winding_along(point, attempt)) return *winding;
    throw std::runtime_error("the judge found no ray that misses all edges; give CrossingCounter another "
                             "direction");
}

} // namespace echinus::test
