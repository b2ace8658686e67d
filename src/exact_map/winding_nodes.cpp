#include "exact_map/winding_nodes.hpp"

#include "geometry/box.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace echinus {

namespace {

/// Moments of some faces about the centre of their area.
struct Moments {
    Vec3d centre;
    Vec3d area;                    ///< vector
    std::array<Vec3d, 3> first{};  ///< integral of the area vector times the offset along each axis
    std::array<Vec3d, 6> second{}; ///< times products of two offsets: xx, yy, zz, xy, xz, yz
    double total_area = 0, spread = 0, radius = 0;
    AlignedBox<double> box;
};

constexpr std::size_t kAxes[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};

std::array<double, 3> coordinates(const Vec3d& v) {
    return {v.x, v.y, v.z};
}

Moments moments_of_leaf(const WindingTree& tree, std::span<const Vec3<std::int32_t>> vertices,
                        std::size_t first) {
    const std::size_t last = std::min(first + TreeNode::kWidth, tree.triangle_count());
    Moments result;
    Vec3d weighted;
    const auto for_each = [&](const auto& visit) {
        for (std::size_t triangle = first; triangle < last; ++triangle) {
            const auto corner = [&](std::size_t k) {
                return Vec3d(vertices[tree.corners[3 * triangle + k]]);
            };
            const Vec3d a = corner(0), b = corner(1), c = corner(2);
            visit(a, b, c, cross(b - a, c - a) * 0.5);
        }
    };
    for_each([&](const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& area) {
        for (const Vec3d& corner : {a, b, c}) result.box.add(corner);
        result.area += area;
        result.total_area += length(area);
        weighted += (a + b + c) * (length(area) / 3);
    });
    result.centre = result.total_area > 0 ? weighted * (1 / result.total_area) : result.box.low;
    for_each([&](const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& area) {
        const Vec3d from_a = a - result.centre, from_b = b - result.centre, from_c = c - result.centre;
        const Vec3d sum = from_a + from_b + from_c;
        const auto at_a = coordinates(from_a), at_b = coordinates(from_b), at_c = coordinates(from_c),
                   at_sum = coordinates(sum);
        for (std::size_t i = 0; i < 3; ++i) result.first[i] += area * (at_sum[i] / 3);
        for (std::size_t n = 0; n < 6; ++n) {
            const auto [i, j] = kAxes[n];
            const double products =
                at_a[i] * at_a[j] + at_b[i] * at_b[j] + at_c[i] * at_c[j] + at_sum[i] * at_sum[j];
            result.second[n] += area * (products / 12);
        }
        const double squares =
            dot(from_a, from_a) + dot(from_b, from_b) + dot(from_c, from_c) + dot(sum, sum);
        result.spread += length(area) * squares / 12;
        result.radius = std::max({result.radius, length(from_a), length(from_b), length(from_c)});
    });
    return result;
}

/// All of some parts. The spread of each about its own centre grows by the squared distance, since that is
/// the centre of its area.
Moments joined(const std::array<Moments, TreeNode::kWidth>& parts, std::size_t count) {
    Moments result;
    Vec3d weighted;
    for (std::size_t k = 0; k < count; ++k) {
        result.box.add(parts[k].box);
        result.area += parts[k].area;
        result.total_area += parts[k].total_area;
        weighted += parts[k].centre * parts[k].total_area;
    }
    result.centre = result.total_area > 0 ? weighted * (1 / result.total_area) : result.box.low;
    double radius = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const Moments& part = parts[k];
        const Vec3d offset = part.centre - result.centre;
        const auto by = coordinates(offset);
        for (std::size_t i = 0; i < 3; ++i) result.first[i] += part.first[i] + part.area * by[i];
        for (std::size_t n = 0; n < 6; ++n) {
            const auto [i, j] = kAxes[n];
            result.second[n] +=
                part.second[n] + part.first[i] * by[j] + part.first[j] * by[i] + part.area * (by[i] * by[j]);
        }
        result.spread += part.spread + dot(offset, offset) * part.total_area;
        radius = std::max(radius, length(offset) + part.radius);
    }
    result.radius = std::min(radius, result.box.farthest_distance(result.centre));
    return result;
}

/// The terms of order 1 and 2 are polynomials in r = (x, y, z), divided by r^5 and r^7:
///
///     -3 sum of F_ij r_i r_j + trace r^2,   15/2 sum of S_ijk r_i r_j r_k - 3/2 r^2 (2 F' + F'') r,
///
/// with the moments F_ij of area i times offset j, and S_ijk with two offsets. Both are harmonic, so they are
/// known without what their traces add: x^2, y^2, z^2 with coefficients that sum to 0, and of third degree
/// the seven polynomials
///
///     x (x^2 - 3 z^2), y (y^2 - 3 z^2), z (z^2 - 3 x^2), x (y^2 - z^2), y (x^2 - z^2), z (y^2 - x^2), xyz,
///
/// found by taking away multiples of x r^2, y r^2 and z r^2, which are not harmonic.
void store(const Moments& moments, std::size_t k, WindingNode& node) {
    constexpr double kUnit = 1 / (4 * std::numbers::pi);
    const auto set = [&](double(&rows)[3][WindingNode::kWidth], const Vec3d& v) {
        rows[0][k] = v.x;
        rows[1][k] = v.y;
        rows[2][k] = v.z;
    };
    set(node.centre, moments.centre);
    set(node.area, moments.area * kUnit);

    const auto& [x, y, z] = moments.first;
    const double third_of_trace = (x.x + y.y + z.z) / 3;
    const double quadratic[6] = {
        x.x - third_of_trace, y.y - third_of_trace, z.z - third_of_trace, x.y + y.x, x.z + z.x, y.z + z.y};
    for (std::size_t i = 0; i < 6; ++i) node.first[i][k] = -3 * kUnit * quadratic[i];

    // Coefficients of the cubic form: x^3, y^3, z^3, then x y^2, x z^2, y x^2, y z^2, z x^2, z y^2, then xyz.
    const auto& [xx, yy, zz, xy, xz, yz] = moments.second;
    const double xxx = xx.x, yyy = yy.y, zzz = zz.z;
    const double xyy = yy.x + 2 * xy.y, xzz = zz.x + 2 * xz.z, yxx = xx.y + 2 * xy.x, yzz = zz.y + 2 * yz.z,
                 zxx = xx.z + 2 * xz.x, zyy = yy.z + 2 * yz.y, xyz = 2 * (yz.x + xz.y + xy.z);
    // Less l r^2 with the linear form l that leaves a harmonic form: that is a tenth of its Laplacian.
    const double lx = (3 * xxx + xyy + xzz) / 5, ly = (3 * yyy + yxx + yzz) / 5,
                 lz = (3 * zzz + zxx + zyy) / 5;
    const double cubic[7] = {xxx - lx, yyy - ly, zzz - lz, xyy - lx, yxx - ly, zyy - lz, xyz};
    for (std::size_t i = 0; i < 7; ++i) node.second[i][k] = 7.5 * kUnit * cubic[i];

    // Rounded up by more than all of the above is rounded.
    constexpr double kUp = 1 + 0x1p-30;
    node.radius[k] = moments.radius * kUp;
    node.spread[k] = moments.spread * (kUnit * kUp);
    node.total_area[k] = moments.total_area * (kUnit * kUp);
}

} // namespace

std::vector<WindingNode> find_winding_nodes(const WindingTree& tree,
                                            std::span<const Vec3<std::int32_t>> vertices) {
    std::vector<WindingNode> result(tree.nodes.size());
    std::vector<Moments> of_node(tree.nodes.size());
    for (std::size_t i = tree.nodes.size(); i-- > 0;) {
        const TreeNode& node = tree.nodes[i];
        std::array<Moments, TreeNode::kWidth> parts;
        std::size_t count = 0;
        for (std::size_t k = 0; k < TreeNode::kWidth; ++k) {
            if (node.low[0][k] > node.high[0][k]) { // there is none: nothing, and far from everywhere
                result[i].centre[0][k] = 1e30;
                continue;
            }
            const std::uint32_t child = node.children[k];
            const bool is_leaf = (child & TreeNode::kLeaf) != 0;
            parts[count] = is_leaf
                               ? moments_of_leaf(tree, vertices, (child - TreeNode::kLeaf) * TreeNode::kWidth)
                               : of_node[child];
            store(parts[count], k, result[i]);
            ++count;
        }
        of_node[i] = joined(parts, count);
    }
    return result;
}

} // namespace echinus
