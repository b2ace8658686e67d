#include <echinus/mesh.hpp>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

// An active-set method: a basis of at most four points determines the sphere. While some point is outside,
// the farthest one joins the basis, and the smallest sphere around these at most five points is found by
// trying every subset that could determine it. Each round enlarges the sphere, so the number of rounds is
// finite; a mesh takes ten to twenty.

namespace echinus {

namespace {

constexpr std::size_t kMaxBasisSize = 4;

struct Basis {
    std::array<Vec3d, kMaxBasisSize> points;
    std::size_t size = 0;

    void add(const Vec3d& p) { points[size++] = p; }
};

struct Candidate {
    Sphere sphere;
    Basis basis;
};

using Row = std::array<double, 4>; // a x + b y + c z = d
using Rows = std::array<Row, 3>;
using Columns = std::array<std::size_t, 3>; // the order in which the unknowns are eliminated

/// Brings the largest remaining coefficient to position (k, k).
void pivot(Rows& rows, Columns& columns, std::size_t k) {
    std::size_t row = k;
    std::size_t column = k;
    for (std::size_t i = k; i < 3; ++i)
        for (std::size_t j = k; j < 3; ++j)
            if (std::abs(rows[i][columns[j]]) > std::abs(rows[row][columns[column]])) {
                row = i;
                column = j;
            }
    std::swap(rows[k], rows[row]);
    std::swap(columns[k], columns[column]);
}

void eliminate(Rows& rows, const Columns& columns, std::size_t k) {
    for (std::size_t i = k + 1; i < 3; ++i) {
        const double factor = rows[i][columns[k]] / rows[k][columns[k]];
        for (std::size_t j = k; j < 3; ++j) rows[i][columns[j]] -= factor * rows[k][columns[j]];
        rows[i][3] -= factor * rows[k][3];
    }
}

/// Solves three linear equations by elimination with complete pivoting, which is backward stable: the centre
/// is equally far from all points up to rounding, even if they are nearly coplanar. Returns nothing if the
/// rows are dependent.
std::optional<Vec3d> solve(Rows rows) {
    Columns columns{0, 1, 2};
    for (std::size_t k = 0; k < 3; ++k) {
        pivot(rows, columns, k);
        if (rows[k][columns[k]] == 0) return std::nullopt;
        eliminate(rows, columns, k);
    }
    std::array<double, 3> x{};
    for (std::size_t k = 3; k-- > 0;) {
        double rest = rows[k][3];
        for (std::size_t j = k + 1; j < 3; ++j) rest -= rows[k][columns[j]] * x[columns[j]];
        x[columns[k]] = rest / rows[k][columns[k]];
    }
    return Vec3d{x[0], x[1], x[2]};
}

/// The plane of all points that are equally far from the origin and from p.
Row bisector(const Vec3d& p) {
    return {p.x, p.y, p.z, dot(p, p) / 2};
}

/// The plane through the origin perpendicular to `normal`.
Row plane_through_origin(const Vec3d& normal) {
    return {normal.x, normal.y, normal.z, 0};
}

/// Centre of the smallest sphere that has all points of the basis on it.
std::optional<Vec3d> circumcentre(const Basis& basis) {
    const Vec3d origin = basis.points[0];
    if (basis.size == 1) return origin;
    const Vec3d a = basis.points[1] - origin;
    if (basis.size == 2) return origin + a * 0.5;
    const Vec3d b = basis.points[2] - origin;
    const Row third =
        basis.size == 3 ? plane_through_origin(cross(a, b)) : bisector(basis.points[3] - origin);
    const std::optional<Vec3d> offset = solve({bisector(a), bisector(b), third});
    if (!offset) return std::nullopt;
    return origin + *offset;
}

double largest_distance(const Vec3d& centre, const Basis& basis) {
    double largest = 0;
    for (std::size_t i = 0; i < basis.size; ++i)
        largest = std::max(largest, length(basis.points[i] - centre));
    return largest;
}

/// The smallest sphere around the basis and one point outside its sphere, which is therefore on the new
/// sphere. The sphere of each subset is enlarged until it encloses all of these points; the smallest one is
/// the result, without any tolerance.
Candidate enlarge(const Basis& basis, const Vec3d& outside) {
    std::optional<Candidate> best;
    for (unsigned subset = 0; subset < 1U << basis.size; ++subset) {
        Basis support;
        support.add(outside);
        for (std::size_t i = 0; i < basis.size && support.size < kMaxBasisSize; ++i)
            if ((subset >> i & 1U) != 0) support.add(basis.points[i]);
        const std::optional<Vec3d> centre = circumcentre(support);
        if (!centre || !is_finite(*centre)) continue;
        const double radius = std::max(largest_distance(*centre, basis), length(outside - *centre));
        if (!best || radius < best->sphere.radius) best = Candidate{{*centre, radius}, support};
    }
    return *best; // the empty subset always has a centre
}

/// The first of the farthest points. The largest distance in each block is computed without its index, so
/// that the compiler vectorises the loop.
Vec3d farthest_from(const Vec3d& centre, std::span<const Vec3f> points) {
    constexpr std::size_t kBlock = 256;
    const auto distance_sq = [&](const Vec3f& p) {
        const Vec3d offset = Vec3d(p) - centre;
        return dot(offset, offset);
    };
    double farthest_sq = -1;
    std::span<const Vec3f> farthest;
    for (std::size_t begin = 0; begin < points.size(); begin += kBlock) {
        const std::span<const Vec3f> block = points.subspan(begin, std::min(kBlock, points.size() - begin));
        std::array<double, kBlock> distances;
        for (std::size_t i = 0; i < block.size(); ++i) distances[i] = distance_sq(block[i]);
        std::array<double, 4> largest{-1, -1, -1, -1};
        std::fill(distances.begin() + static_cast<std::ptrdiff_t>(block.size()), distances.end(), -1);
        for (std::size_t i = 0; i < kBlock; i += 4)
            for (std::size_t lane = 0; lane < 4; ++lane)
                largest[lane] = largest[lane] < distances[i + lane] ? distances[i + lane] : largest[lane];
        const double largest_sq =
            std::max(std::max(largest[0], largest[1]), std::max(largest[2], largest[3]));
        if (!(largest_sq > farthest_sq)) continue;
        farthest_sq = largest_sq;
        farthest = block;
    }
    return Vec3d(*std::find_if(farthest.begin(), farthest.end(),
                               [&](const Vec3f& p) { return distance_sq(p) == farthest_sq; }));
}

} // namespace

Sphere smallest_enclosing_sphere(std::span<const Vec3f> points) {
    if (points.empty()) return {};
    Candidate current;
    current.sphere.centre = Vec3d(points[0]);
    current.basis.add(current.sphere.centre);
    Vec3d farthest = farthest_from(current.sphere.centre, points);
    while (length(farthest - current.sphere.centre) > current.sphere.radius) {
        const Candidate next = enlarge(current.basis, farthest);
        // The sphere stops growing while a point is outside only if rounding has reached the last digits.
        if (!(next.sphere.radius > current.sphere.radius)) break;
        current = next;
        farthest = farthest_from(current.sphere.centre, points);
    }
    current.sphere.radius = length(farthest - current.sphere.centre);
    return current.sphere;
}

} // namespace echinus
