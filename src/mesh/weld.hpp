#pragma once

#include <echinus/export.hpp>
#include <echinus/mesh.hpp>

#include <cstdint>
#include <vector>

ECHINUS_EXPORT_BEGIN

namespace echinus {

struct WeldedMesh {
    TriangleMesh mesh;
    /// [vertex_count] for each vertex the first one of the input that stands there.
    std::vector<std::uint32_t> sources;
};

/// weld(), for those who have more to say about the vertices than where they stand.
/// @throws Error InvalidMesh as weld() does
WeldedMesh weld_with_sources(const TriangleMesh& mesh);

} // namespace echinus

ECHINUS_EXPORT_END
