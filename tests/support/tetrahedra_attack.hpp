#pragma once

#include "mesh_io/tetrahedra_readers.hpp"
#include "support/require_sentence.hpp"

#include <echinus/error.hpp>
#include <echinus/tetrahedra.hpp>

#include <string_view>

namespace echinus::test {

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
