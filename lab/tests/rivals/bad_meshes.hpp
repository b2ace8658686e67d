#pragma once

#include "support/expectations.hpp"

#include <echinus/mesh.hpp>

#include <limits>

namespace echinus::test {

/// Every system must refuse meshes around which none can be built, with a sentence that gives the reason.
template <typename Build>
void expect_bad_meshes_are_refused(const Build& build) {
    const auto refuses = [&](const TriangleMesh& mesh, const char* words) {
        expect_error(ErrorCode::InvalidMesh, words, [&] { build(mesh); });
    };
    refuses({}, "no faces");
    refuses({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}, "open");
    TriangleMesh open = make_box({1, 1, 1});
    open.faces.pop_back();
    refuses(open, "open");
    for (const float bad :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        TriangleMesh mesh = make_box({1, 1, 1});
        mesh.vertices[3].y = bad;
        refuses(mesh, "finite");
    }
    TriangleMesh stray = make_box({1, 1, 1});
    stray.faces[5][1] = 1000;
    refuses(stray, "1000");
    TriangleMesh dot = make_box({1, 1, 1});
    for (Vec3f& vertex : dot.vertices) vertex = {1, 2, 3};
    refuses(dot, "one point");
    TriangleMesh huge = make_box({1, 1, 1});
    for (Vec3f& vertex : huge.vertices) vertex *= 1e16F;
    refuses(huge, "radius");
}

/// Closed, and without an inside: two faces back to back.
inline TriangleMesh flat_mesh() {
    return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}};
}

} // namespace echinus::test
