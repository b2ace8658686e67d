#include "rivals/common/closed_mesh.hpp"

#include <echinus/error.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

namespace echinus::rivals {

namespace {

bool is_finite_and_in_range(const TriangleMesh& mesh) {
    return !mesh.faces.empty() && std::ranges::all_of(mesh.faces, [&](const Triangle& face) {
        return std::ranges::all_of(
            face, [&](std::uint32_t v) { return v < mesh.vertices.size() && is_finite(mesh.vertices[v]); });
    });
}

/// As distinct for two edges as their vertices are, up to chance (the mixer of SplitMix64).
std::uint64_t hash_of(std::uint32_t lower, std::uint32_t higher) {
    std::uint64_t x = (std::uint64_t{lower} << 32U | higher) + 0x9e3779b97f4a7c15U;
    x = (x ^ x >> 30U) * 0xbf58476d1ce4e5b9U;
    x = (x ^ x >> 27U) * 0x94d049bb133111ebU;
    return x ^ x >> 31U;
}

/// Do equally many faces run along every edge in both directions, if vertices are distinguished by their
/// numbers? Then all hashes cancel.
bool is_balanced(const TriangleMesh& mesh) {
    std::uint64_t sum = 0;
    for (const Triangle& face : mesh.faces)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t from = face[k], to = face[(k + 1) % 3];
            if (from < to) sum += hash_of(from, to);
            if (to < from) sum -= hash_of(to, from);
        }
    return sum == 0;
}

} // namespace

void require_closed(const TriangleMesh& mesh, std::string_view system) {
    if (is_finite_and_in_range(mesh) && is_balanced(mesh)) {
        const double side = box_of(mesh).longest_side();
        if (side >= 2e-15 && side <= 1e15) return; // most meshes, in a fraction of the time
    }
    const MeshReport report = inspect(mesh);
    const float radius = report.bounding_sphere.radius;
    if (!(radius >= 1e-15F && radius <= 1e15F))
        throw Error(ErrorCode::InvalidMesh, "the mesh has the bounding radius " + std::to_string(radius) +
                                                ": it lies in one point, or outside of [1e-15, 1e15]");
    if (!report.closed)
        throw Error(ErrorCode::InvalidMesh,
                    "the mesh is open; " + std::string(system) + " needs a closed one");
}

double Box::longest_side() const {
    const Vec3d s = size();
    return std::max({s.x, s.y, s.z});
}

Box box_of(const TriangleMesh& mesh) {
    const Vec3f& first = mesh.vertices[mesh.faces.front()[0]];
    Box box{first, first};
    for (const Triangle& face : mesh.faces)
        for (const std::uint32_t v : face) {
            const Vec3f& p = mesh.vertices[v];
            box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
            box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
        }
    return box;
}

std::array<double, 3> nodes_over(const Box& box, double spacing) {
    // A quotient that should be whole may come out a rounding too large, and need not cost a layer of nodes.
    constexpr double kRounding = 1e-9;
    const auto along = [&](double side) {
        return std::max(2.0, std::ceil(side / spacing * (1 - kRounding)) + 1);
    };
    const Vec3d size = box.size();
    return {along(size.x), along(size.y), along(size.z)};
}

double spacing_of_samples(const Box& box, std::uint32_t sample_count, std::uint32_t most) {
    if (sample_count < 2 || sample_count > most)
        throw Error(ErrorCode::InvalidOptions, "there are to be " + std::to_string(sample_count) +
                                                   " samples along the longest side; possible are 2 to " +
                                                   std::to_string(most));
    return box.longest_side() / (sample_count - 1);
}

} // namespace echinus::rivals
