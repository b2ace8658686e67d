#include "geometry/parallel.hpp"
#include "tetrahedra/tetrahedron_tree.hpp"

#include <echinus/error.hpp>
#include <echinus/tetrahedra.hpp>

#include <string>

namespace echinus {

Embedding embed(const TetrahedralMesh& mesh, StridedSpan<const Vec3f> points, unsigned thread_count) {
    require_valid_tetrahedra(mesh);
    for (std::size_t i = 0; i < points.size(); ++i)
        if (!is_finite(points[i]))
            throw Error(ErrorCode::InvalidMesh,
                        "point " + std::to_string(i) + " of those to be embedded is not finite");
    const TetrahedronTree tree(mesh);
    Embedding embedding(points.size());
    parallel_for(points.size(), thread_count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            EmbeddedPoint& result = embedding[i];
            result.tetrahedron = tree.nearest(Vec3d(points[i]));
            result.vertices = mesh.tetrahedra[result.tetrahedron];
            const auto weights = weights_of(mesh, result.vertices, Vec3d(points[i]));
            for (std::size_t k = 0; k < 4; ++k) result.weights[k] = static_cast<float>(weights[k]);
        }
    });
    return embedding;
}

void carry(const Embedding& embedding, StridedSpan<const Vec3f> positions, StridedSpan<Vec3f> points,
           unsigned thread_count) noexcept {
    for_each_piece(embedding.size(), thread_count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Tetrahedron& corners = embedding[i].vertices;
            // From the first corner, so that a translation is not scaled by a sum that rounding keeps from 1.
            const Vec3d first(positions[corners[0]]);
            Vec3d point = first;
            for (std::size_t k = 1; k < 4; ++k)
                point += (Vec3d(positions[corners[k]]) - first) * double{embedding[i].weights[k]};
            points[i] = Vec3f(point);
        }
    });
}

} // namespace echinus
