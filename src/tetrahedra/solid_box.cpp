#include <echinus/error.hpp>
#include <echinus/tetrahedra.hpp>

#include <array>
#include <cmath>
#include <string>
#include <utility>

namespace echinus {

namespace {

void require_possible(const Vec3d& size, const std::array<std::uint32_t, 3>& segments) {
    constexpr std::uint32_t kMost = 512;
    for (const double length : {size.x, size.y, size.z})
        if (!(length > 0) || !std::isfinite(length))
            throw Error(ErrorCode::InvalidOptions,
                        "a solid box has a side of " + std::to_string(length) + "; it must be positive");
    for (const std::uint32_t count : segments)
        if (count < 1 || count > kMost)
            throw Error(ErrorCode::InvalidOptions, "a solid box has " + std::to_string(count) +
                                                       " segments along a side; it needs 1 to " +
                                                       std::to_string(kMost));
}

/// The corners of a cuboid, with bits 0, 1 and 2 of their numbers for x, y and z, form five tetrahedra: one
/// in the middle, and one at each corner that it does not contain.
constexpr std::array<std::array<std::uint8_t, 4>, 5> kCuboid{
    {{0, 3, 6, 5}, {1, 0, 5, 3}, {2, 0, 3, 6}, {4, 0, 6, 5}, {7, 3, 5, 6}}};

} // namespace

TetrahedralMesh make_solid_box(const Vec3d& size, const std::array<std::uint32_t, 3>& segments) {
    require_possible(size, segments);
    const std::array<std::uint32_t, 3> n = segments;
    const std::uint32_t nx = n[0], ny = n[1],
                        nz = n[2]; // copies that lambdas can capture in Clang, unlike structured bindings
    TetrahedralMesh box;
    for (std::uint32_t k = 0; k <= nz; ++k)
        for (std::uint32_t j = 0; j <= ny; ++j)
            for (std::uint32_t i = 0; i <= nx; ++i)
                box.vertices.emplace_back(Vec3d{size.x * (double(i) / nx - 0.5),
                                                size.y * (double(j) / ny - 0.5),
                                                size.z * (double(k) / nz - 0.5)});
    const auto index = [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
        return (k * (ny + 1) + j) * (nx + 1) + i;
    };
    // Mirrored from cuboid to cuboid, so that neighbours divide their common side along the same diagonal.
    for (std::uint32_t k = 0; k < nz; ++k)
        for (std::uint32_t j = 0; j < ny; ++j)
            for (std::uint32_t i = 0; i < nx; ++i) {
                const std::uint32_t mirror = (i + j + k) % 2;
                for (const auto& corners : kCuboid) {
                    Tetrahedron tetrahedron{};
                    for (std::size_t c = 0; c < 4; ++c) {
                        const std::uint32_t at = corners[c] ^ mirror;
                        tetrahedron[c] = index(i + (at & 1), j + (at >> 1 & 1), k + (at >> 2));
                    }
                    if (mirror == 1) std::swap(tetrahedron[2], tetrahedron[3]);
                    box.tetrahedra.push_back(tetrahedron);
                }
            }
    return box;
}

} // namespace echinus
