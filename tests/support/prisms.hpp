#pragma once

#include "support/mesh_assembly.hpp"

#include <echinus/mesh.hpp>

#include <cstdint>
#include <vector>

/// Shapes with faces in planes through their centre, such as machine parts have.
namespace echinus::test {

struct OutlinePoint {
    float x, y;
};

/// A prism of height 2 around z = 0.
/// @param outline  counter-clockwise, and seen whole from its first point
inline TriangleMesh make_prism(const std::vector<OutlinePoint>& outline) {
    const auto count = static_cast<std::uint32_t>(outline.size());
    TriangleMesh prism;
    for (float z : {-1.0F, 1.0F})
        for (const auto& [x, y] : outline) prism.vertices.push_back({x, y, z});
    for (std::uint32_t a = 0; a < count; ++a) {
        const std::uint32_t b = (a + 1) % count;
        prism.faces.push_back({a, b, b + count});
        prism.faces.push_back({a, b + count, a + count});
    }
    for (std::uint32_t a = 1; a + 1 < count; ++a) {
        prism.faces.push_back({0, a + 1, a});
        prism.faces.push_back({count, count + a, count + a + 1});
    }
    return prism;
}

/// A cube of side 2, cut by a plane through its centre into parts that touch.
inline TriangleMesh make_two_wedges() {
    return joined({make_prism({{-1, -1}, {1, -1}, {1, 1}}), make_prism({{-1, -1}, {1, 1}, {-1, 1}})});
}

/// The same by two planes.
inline TriangleMesh make_four_wedges() {
    return joined({make_prism({{0, 0}, {-1, -1}, {1, -1}}), make_prism({{0, 0}, {1, -1}, {1, 1}}),
                   make_prism({{0, 0}, {1, 1}, {-1, 1}}), make_prism({{0, 0}, {-1, 1}, {-1, -1}})});
}

/// A plate from which an eighth is cut, one part.
inline TriangleMesh make_open_mouth() {
    return make_prism({{0, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}, {1, 0}});
}

} // namespace echinus::test
