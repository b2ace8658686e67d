#include "geometry/orientation.hpp"
#include "tetrahedra/tetrahedron_faces.hpp"

#include <echinus/error.hpp>

#include <string>

namespace echinus {

void require_valid_tetrahedra(const TetrahedralMesh& mesh) {
    if (mesh.tetrahedra.empty()) throw Error(ErrorCode::InvalidMesh, "the body has no tetrahedra");
    require_indices(mesh);
    for (std::size_t number = 0; number < mesh.tetrahedra.size(); ++number) {
        const Tetrahedron& corners = mesh.tetrahedra[number];
        for (const std::uint32_t vertex : corners)
            if (!is_finite(mesh.vertices[vertex]))
                throw Error(ErrorCode::InvalidMesh, "vertex " + std::to_string(vertex) + " of tetrahedron " +
                                                        std::to_string(number) + " is not finite");
        const auto corner = [&](int i) { return mesh.vertices[corners[i]]; };
        // Clockwise seen from the last corner is 1.
        const int side = orientation(corner(0), corner(1), corner(2), corner(3));
        if (side == 0)
            throw Error(ErrorCode::InvalidMesh,
                        "tetrahedron " + std::to_string(number) + " is flat; leave it out");
        if (side > 0)
            throw Error(ErrorCode::InvalidMesh, "tetrahedron " + std::to_string(number) +
                                                    " has a negative volume; exchange two of its corners");
    }
    sorted_face_uses(mesh); // throws where two overlap at a face
}

} // namespace echinus
