#pragma once

#include <echinus/mesh.hpp>

#include <cstdint>
#include <initializer_list>
#include <utility>

/// Meshes made from other meshes.
namespace echinus::test {

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

inline TriangleMesh turned_inside_out(TriangleMesh mesh) {
    for (Triangle& face : mesh.faces) std::swap(face[1], face[2]);
    return mesh;
}

} // namespace echinus::test
