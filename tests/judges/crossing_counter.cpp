#include "judges/crossing_counter.hpp"

#include "judges/ray_grid.hpp"

#include <CGAL/Exact_integer.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Simple_cartesian.h>

#include <optional>
#include <stdexcept>

namespace echinus::test {

namespace {

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
