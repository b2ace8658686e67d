#pragma once

#include <echinus/tetrahedra.hpp>

#include <cstdint>

namespace echinus::test {

/// A brick of count^3 unit cubes, each cut into six tetrahedra around its diagonal (Kuhn's).
inline TetrahedralMesh make_brick(std::uint32_t count) {
    const auto number = [&](const std::array<std::uint32_t, 3>& p) {
        return (p[2] * (count + 1) + p[1]) * (count + 1) + p[0];
    };
    TetrahedralMesh brick;
    for (std::uint32_t z = 0; z <= count; ++z)
        for (std::uint32_t y = 0; y <= count; ++y)
            for (std::uint32_t x = 0; x <= count; ++x)
                brick.vertices.emplace_back(static_cast<float>(x), static_cast<float>(y),
                                            static_cast<float>(z));
    const std::array<std::array<std::size_t, 3>, 6> orders{
        {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
    for (std::uint32_t cube = 0; cube < count * count * count; ++cube)
        for (std::size_t way = 0; way < 6; ++way) {
            std::array<std::uint32_t, 3> p{cube % count, cube / count % count, cube / count / count};
            Tetrahedron corners{number(p), 0, 0, 0};
            for (std::size_t step = 0; step < 3; ++step) {
                ++p[orders[way][step]];
                corners[step + 1] = number(p);
            }
            if (way >= 3) std::swap(corners[2], corners[3]); // an odd order of the axes
            brick.tetrahedra.push_back(corners);
        }
    return brick;
}

} // namespace echinus::test
