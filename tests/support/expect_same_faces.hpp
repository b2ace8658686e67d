#pragma once

#include <echinus/mesh.hpp>

#include <gtest/gtest.h>

#include <cstddef>

namespace echinus::test {

/// Expects the corners at the same positions in the file's frame, face by face and up to a distance, whatever
/// the order of the vertices.
inline void expect_same_faces(const TriangleMesh& mesh, const TriangleMesh& expected, double tolerance = 0) {
    ASSERT_EQ(mesh.faces.size(), expected.faces.size());
    for (std::size_t face = 0; face < mesh.faces.size(); ++face)
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const Vec3d found = mesh.origin + Vec3d(mesh.vertices[mesh.faces[face][corner]]);
            const Vec3d sought = expected.origin + Vec3d(expected.vertices[expected.faces[face][corner]]);
            ASSERT_LE(length(found - sought), tolerance) << "corner " << corner << " of face " << face;
        }
}

} // namespace echinus::test
