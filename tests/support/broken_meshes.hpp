#pragma once

#include <echinus/mesh.hpp>

namespace echinus::test {

/// Both meshes as one, the second one's faces after the first one's.
inline TriangleMesh together(TriangleMesh first, const TriangleMesh& second) {
    const auto offset = static_cast<std::uint32_t>(first.vertices.size());
    first.vertices.insert(first.vertices.end(), second.vertices.begin(), second.vertices.end());
    for (const Triangle& face : second.faces)
        first.faces.push_back({face[0] + offset, face[1] + offset, face[2] + offset});
    return first;
}

inline TriangleMesh moved(TriangleMesh mesh, const Vec3f& by) {
    for (Vec3f& p : mesh.vertices) p += by;
    return mesh;
}

inline TriangleMesh inside_out(TriangleMesh mesh) {
    for (Triangle& face : mesh.faces) std::swap(face[1], face[2]);
    return mesh;
}

/// A cube whose top exists twice: faces 0 to 11 are the cube's, 12 and 13 fill the top again along the other
/// diagonal.
inline TriangleMesh cube_with_doubled_top() {
    return {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}},
            {{0, 2, 1},
             {0, 3, 2}, // bottom
             {0, 1, 5},
             {0, 5, 4}, // front
             {1, 2, 6},
             {1, 6, 5}, // right
             {2, 3, 7},
             {2, 7, 6}, // back
             {3, 0, 4},
             {3, 4, 7}, // left
             {4, 5, 6},
             {4, 6, 7}, // top
             {5, 6, 7},
             {5, 7, 4}}}; // top again
}

} // namespace echinus::test
