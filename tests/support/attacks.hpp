#pragma once

#include "mesh_io/readers.hpp"

#include <echinus/error.hpp>
#include <echinus/mesh.hpp>
#include <echinus/tetrahedra.hpp>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

namespace echinus::test {

/// Ends the program, as a finding of a fuzzer, unless an error is one line that begins with the file's name.
inline void require_sentence(std::string_view sentence, std::string_view name) {
    if (sentence.starts_with(name) && sentence.find('\n') == std::string_view::npos) return;
    std::fprintf(stderr, "not a sentence: %.*s\n", static_cast<int>(sentence.size()), sentence.data());
    std::abort();
}

/// A reader of hostile bytes either refuses them with an Error or gives a mesh that all functions accept.
/// @param name  its ending determines the format
/// @returns whether it gave one
inline bool attack_mesh(const std::string& name, std::string_view bytes) {
    MeshAndEdges drawn;
    try {
        drawn = read_mesh_and_edges(MeshSource{name, bytes});
    } catch (const Error& error) {
        require_sentence(error.what(), name + ": ");
        return false;
    }
    if (!drawn.mesh.faces.empty()) inspect(drawn.mesh); // outside of the try: what it throws is a finding
    return true;
}

/// Reads bytes as the kind of file that they seem to be: Gmsh's, VTK's, or else TetGen's two files with a
/// zero between them.
inline TetrahedraFile read_any_tetrahedra(std::string_view bytes) {
    if (bytes.starts_with("$")) return read_tetrahedra(MeshSource{"attack.msh", bytes});
    if (bytes.starts_with("# vtk")) return read_tetrahedra(MeshSource{"attack.vtk", bytes});
    const std::size_t middle = bytes.find('\0');
    if (middle == std::string_view::npos) throw Error(ErrorCode::Damaged, "attack: one file");
    const MeshSource elements{"attack.ele", bytes.substr(middle + 1)};
    return finish_tetrahedra(read_tetgen({"attack.node", bytes.substr(0, middle)}, elements), elements);
}

/// A reader of hostile bytes either refuses them with an Error or gives a body that all functions accept.
/// @returns whether it gave one
inline bool attack_tetrahedra(std::string_view bytes) {
    TetrahedraFile file;
    try {
        file = read_any_tetrahedra(bytes);
    } catch (const Error& error) {
        require_sentence(error.what(), "attack");
        return false;
    }
    require_valid_tetrahedra(file.mesh); // outside of the try: what it throws is a finding
    inspect_tetrahedra(file.mesh);
    return true;
}

} // namespace echinus::test
