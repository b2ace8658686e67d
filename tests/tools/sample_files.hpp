#pragma once

#include <echinus/mesh.hpp>

#include <cstddef>
#include <sstream>
#include <string>

namespace echinus::test {

/// A mesh as the text of an OBJ file, written without the program's own writer.
inline std::string obj_text(const TriangleMesh& mesh) {
    std::ostringstream text;
    text.precision(9);
    for (const Vec3f& v : mesh.vertices) text << "v " << v.x << ' ' << v.y << ' ' << v.z << '\n';
    for (const Triangle& f : mesh.faces) {
        text << "f " << f[0] + 1 << ' ' << f[1] + 1 << ' ' << f[2] + 1 << '\n';
    }
    return text.str();
}

inline std::string box_text() {
    return obj_text(make_box({2, 3, 4}));
}

/// The same box without its last face.
inline std::string open_box_text() {
    TriangleMesh mesh = make_box({2, 3, 4});
    mesh.faces.pop_back();
    return obj_text(mesh);
}

/// The same box with its first face twice.
inline std::string doubled_face_text() {
    TriangleMesh mesh = make_box({2, 3, 4});
    mesh.faces.push_back(mesh.faces.front());
    return obj_text(mesh);
}

} // namespace echinus::test
