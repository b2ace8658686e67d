#pragma once

#include "support/meshes.hpp"

#include <echinus/mesh.hpp>

#include <string>
#include <vector>

namespace echinus::test {

/// Names that make_nasty_mesh() knows: closed meshes that are hard for a map of directions.
std::vector<std::string> nasty_mesh_names();

/// @throws Error InvalidOptions for another name; the sentence lists them all
TriangleMesh make_nasty_mesh(const std::string& name);

// The meshes of the oracle tests.

struct NamedMesh {
    std::string name;
    TriangleMesh mesh;
};

/// Rotated by an angle that aligns with no grid.
inline TriangleMesh turned(TriangleMesh mesh) {
    const Rotation rotation = Rotation::about({1, 2, 3}, 0.7);
    for (Vec3f& vertex : mesh.vertices) vertex = Vec3f(rotation.apply(Vec3d(vertex)));
    return mesh;
}

/// Closed meshes with the centre inside and outside, of one part and of several. The unrotated ones share
/// planes of symmetry with every grid of directions, so that many rays meet edges and vertices.
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
