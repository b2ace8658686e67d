#pragma once

#include <echinus/mesh.hpp>

#include <initializer_list>
#include <string>
#include <vector>

/// Meshes that the oracle tests run on.
namespace echinus::test {

struct NamedMesh {
    std::string name;
    TriangleMesh mesh;
};

inline TriangleMesh translated(TriangleMesh mesh, const Vec3f& offset) {
    for (Vec3f& vertex : mesh.vertices) vertex += offset;
    return mesh;
}

inline TriangleMesh joined(std::initializer_list<TriangleMesh> parts) {
    TriangleMesh whole;
    for (const TriangleMesh& part : parts) {
        const auto offset = static_cast<std::uint32_t>(whole.vertices.size());
        whole.vertices.insert(whole.vertices.end(), part.vertices.begin(), part.vertices.end());
        for (const auto& [a, b, c] : part.faces) whole.faces.push_back({a + offset, b + offset, c + offset});
    }
    return whole;
}

/// Turned by an angle that fits no grid.
inline TriangleMesh turned(TriangleMesh mesh) {
    const Rotation rotation = Rotation::about({1, 2, 3}, 0.7);
    for (Vec3f& vertex : mesh.vertices) vertex = Vec3f(rotation.apply(Vec3d(vertex)));
    return mesh;
}

inline TriangleMesh turned_inside_out(TriangleMesh mesh) {
    for (Triangle& face : mesh.faces) std::swap(face[1], face[2]);
    return mesh;
}

/// Closed meshes with the centre inside and outside, of one part and of several. Those that are not turned
/// share planes of symmetry with every grid of directions, so that many rays meet edges and vertices.
inline std::vector<NamedMesh> generated_meshes() {
    const TriangleMesh box = make_box({2, 2, 2}, 3);
    const TriangleMesh torus = make_torus(1, 0.4, 40, 16);
    return {
        {"box", box},
        {"turned box", turned(box)},
        {"sphere", make_sphere(1, 24, 12)},
        {"torus", torus},
        {"turned torus", turned(torus)},
        {"needle", make_box({1, 1e-3, 2e-3}, 4)},
        {"hollow box", joined({make_box({4, 4, 4}, 2), turned_inside_out(make_box({1, 1, 1}, 2))})},
        {"pair of boxes", joined({translated(make_box({1, 1, 1}, 2), {2, 0, 0}),
                                  translated(make_box({1, 1, 1}, 2), {-2, 0, 0})})},
    };
}

} // namespace echinus::test
