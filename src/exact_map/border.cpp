#include "exact_map/border.hpp"

#include "directions/crossing.hpp"

#include <algorithm>
#include <numbers>
#include <numeric>
#include <tuple>

namespace echinus {

namespace {

/// An edge seen from its lower vertex: how many more faces run away from it than towards it.
struct HalfEdge {
    std::uint32_t higher;
    std::int32_t count;
};

/// Adds up the half edges of one vertex by their other end, and appends what does not cancel.
void append_unbalanced(std::uint32_t lower, std::span<HalfEdge> half_edges, std::vector<BorderEdge>& border) {
    std::sort(half_edges.begin(), half_edges.end(),
              [](const HalfEdge& a, const HalfEdge& b) { return a.higher < b.higher; });
    for (std::size_t i = 0; i < half_edges.size();) {
        const std::uint32_t higher = half_edges[i].higher;
        std::int32_t sum = 0;
        for (; i < half_edges.size() && half_edges[i].higher == higher; ++i) sum += half_edges[i].count;
        if (sum != 0) border.push_back({lower, higher, sum});
    }
}

/// [vertex_count] the first vertex on the same lattice point.
std::vector<std::uint32_t> first_vertices_at(const std::vector<LatticePoint>& vertices) {
    const auto key = [&](std::uint32_t v) {
        return std::tuple(vertices[v].x, vertices[v].y, vertices[v].z, v);
    };
    std::vector<std::uint32_t> order(vertices.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    std::vector<std::uint32_t> first(vertices.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        const bool repeated = i > 0 && vertices[order[i]] == vertices[order[i - 1]];
        first[order[i]] = repeated ? first[order[i - 1]] : order[i];
    }
    return first;
}

/// @param number  [vertex_count] of each vertex; vertices on one place have one number
std::vector<BorderEdge> unbalanced_edges(const LatticeMesh& lattice,
                                         const std::vector<std::uint32_t>& number) {
    const auto for_each_half_edge = [&](const auto& visit) {
        for (std::uint32_t face = 0; face < lattice.faces.size(); ++face) {
            if (is_collapsed(lattice.corners(face))) continue;
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t a = number[lattice.faces[face][k]];
                const std::uint32_t b = number[lattice.faces[face][(k + 1) % 3]];
                visit(std::min(a, b), HalfEdge{std::max(a, b), a < b ? 1 : -1});
            }
        }
    };
    std::vector<std::uint32_t> next(lattice.vertices.size() + 1);
    for_each_half_edge([&](std::uint32_t lower, HalfEdge) { ++next[lower + 1]; });
    std::partial_sum(next.begin(), next.end(), next.begin());
    std::vector<HalfEdge> half_edges(next.back());
    for_each_half_edge(
        [&](std::uint32_t lower, HalfEdge half_edge) { half_edges[next[lower]++] = half_edge; });
    // Now next[v] is where the half edges of v end.
    std::vector<BorderEdge> border;
    std::size_t first = 0;
    for (std::uint32_t lower = 0; lower < lattice.vertices.size(); ++lower) {
        append_unbalanced(lower, std::span(half_edges).subspan(first, next[lower] - first), border);
        first = next[lower];
    }
    return border;
}

/// A hair's breadth in the direction in which the perturbation (e, e^2, e^3) leads away from a ray first.
Vec3d nudge_from_ray(const LatticePoint& d) {
    constexpr double kHair =
        0x1p-22; // lattice steps: less than what parts lattice points from rays, more than rounding
    const bool along_x = d.x != 0 && d.y == 0 && d.z == 0;
    return along_x ? Vec3d{0, kHair, 0} : Vec3d{kHair, 0, 0};
}

/// Solid angle of the cone triangle (origin, a, b) seen from share * d. On which side of it that lies, where
/// the angle jumps by a full turn, is decided exactly, and so is whether it lies in the triangle's plane.
/// There, and above all on its sides through the origin, where rays through border vertices run, the place is
/// nudged: what two triangles have on both sides of such a ray then adds up. Van Oosterom and Strackee 1983,
/// as in mesh/winding_number.cpp.
double cone_solid_angle(const LatticePoint& a, const LatticePoint& b, const LatticePoint& d, double share) {
    const LatticePoint normal = cross(a, b);
    const std::int64_t volume = -dot(d, normal);
    const Vec3d nudge = volume == 0 ? nudge_from_ray(d) : Vec3d{};
    const Vec3d p = Vec3d(d) * share + nudge;
    const Vec3d pa = Vec3d(a) - p, pb = Vec3d(b) - p, po = p * -1.0;
    const double la = length(pa), lb = length(pb), lo = length(po);
    const double numerator =
        volume == 0 ? std::fabs(dot(nudge, Vec3d(normal))) : share * std::fabs(static_cast<double>(volume));
    const double denominator = la * lb * lo + dot(pa, pb) * lo + dot(pb, po) * la + dot(po, pa) * lb;
    const double angle = 2 * std::atan2(numerator, denominator);
    const bool positive = volume != 0 ? volume > 0 : sign_of_perturbation(normal) < 0;
    return positive ? angle : -angle;
}

} // namespace

std::vector<BorderEdge> find_border(const LatticeMesh& lattice) {
    return unbalanced_edges(lattice, first_vertices_at(lattice.vertices));
}

double border_part(std::span<const BorderEdge> border, std::span<const Vec3<std::int32_t>> vertices,
                   const LatticePoint& d, double share) {
    double sum = 0;
    for (const BorderEdge& edge : border)
        sum += edge.multiplicity *
               cone_solid_angle(LatticePoint(vertices[edge.a]), LatticePoint(vertices[edge.b]), d, share);
    return sum / (4 * std::numbers::pi);
}

} // namespace echinus
