#include "tetrahedra/tetrahedron_faces.hpp"

#include <algorithm>
#include <tuple>

namespace echinus {

TriangleMesh boundary(const TetrahedralMesh& mesh) {
    std::vector<FaceUse> outer;
    const std::vector<FaceUse> uses = sorted_face_uses(mesh);
    for (std::size_t i = 0; i < uses.size(); ++i)
        if (i + 1 < uses.size() && uses[i + 1].vertices == uses[i].vertices)
            ++i; // the face of two tetrahedra
        else
            outer.push_back(uses[i]);
    std::sort(outer.begin(), outer.end(), [](const FaceUse& a, const FaceUse& b) {
        return std::tie(a.tetrahedron, a.corner) < std::tie(b.tetrahedron, b.corner);
    });

    TriangleMesh result{mesh.vertices, {}, mesh.origin};
    result.faces.reserve(outer.size());
    for (const FaceUse& use : outer)
        result.faces.push_back(face_opposite(mesh.tetrahedra[use.tetrahedron], use.corner));
    return result;
}

} // namespace echinus
