#include "tetrahedra/mend.hpp"

#include "geometry/orientation.hpp"
#include "mesh/local_frame.hpp"

#include <cstdint>
#include <utility>
#include <vector>

namespace echinus {

std::size_t turn_negative(TetrahedralMesh& mesh) {
    std::size_t count = 0;
    for (Tetrahedron& corners : mesh.tetrahedra) {
        const auto corner = [&](std::size_t i) -> const Vec3f& { return mesh.vertices[corners[i]]; };
        // 1 where the first three turn clockwise seen from the last.
        if (orientation(corner(0), corner(1), corner(2), corner(3)) <= 0) continue;
        std::swap(corners[2], corners[3]);
        ++count;
    }
    return count;
}

std::size_t drop_unused_vertices(TetrahedralMesh& mesh) {
    std::vector<std::uint32_t> numbers(mesh.vertices.size());
    for (const Tetrahedron& corners : mesh.tetrahedra)
        for (const std::uint32_t vertex : corners) numbers[vertex] = 1;
    std::uint32_t count = 0;
    for (std::size_t vertex = 0; vertex < numbers.size(); ++vertex) {
        if (numbers[vertex] == 0) continue;
        mesh.vertices[count] = mesh.vertices[vertex];
        numbers[vertex] = count++;
    }
    const std::size_t dropped = mesh.vertices.size() - count;
    mesh.vertices.resize(count);
    for (Tetrahedron& corners : mesh.tetrahedra)
        for (std::uint32_t& vertex : corners) vertex = numbers[vertex];
    return dropped;
}

TetrahedralMesh local_body(std::span<const Vec3d> positions, std::vector<Tetrahedron> tetrahedra) {
    const std::span<const std::uint32_t> corners(tetrahedra.empty() ? nullptr : tetrahedra[0].data(),
                                                 4 * tetrahedra.size());
    LocalPositions local = to_local_frame(positions, corners);
    return {std::move(local.positions), std::move(tetrahedra), local.origin};
}

} // namespace echinus
