#pragma once

#include "mesh_io/readers.hpp"
#include "support/require_sentence.hpp"

#include <echinus/error.hpp>
#include <echinus/mesh.hpp>

#include <string>
#include <string_view>

namespace echinus::test {

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

} // namespace echinus::test
