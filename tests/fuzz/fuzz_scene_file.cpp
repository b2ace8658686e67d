#include "mesh_io/readers.hpp"
#include "mesh_io/scenes/scene_file.hpp"
#include "support/attacks.hpp"

#include <echinus/error.hpp>
#include <echinus/mesh.hpp>

#include <cstdint>
#include <cstdlib>
#include <string_view>

using namespace echinus;

namespace {

/// The kind of file that the bytes seem to be.
const char* name_of(std::string_view bytes) {
    return bytes.starts_with("glTF") ? "attack.glb" : bytes.starts_with("MM") ? "attack.3ds" : "attack.gltf";
}

void play(const SceneFile& file, const MeshSource& source) {
    std::size_t vertex_count = 0;
    for (const SceneInstance& instance : file.instances)
        vertex_count += file.shapes[instance.shape].vertices.size();
    for (const SceneAnimation& animation : file.animations) {
        const NodeAnimation nodes(file, animation, source);
        for (const double share : {0.0, 0.3, 1.0})
            if (vertices_in(file, nodes.pose_at(share * nodes.seconds()), source).size() != vertex_count)
                std::abort();
    }
}

} // namespace

/// A reader of hostile bytes either refuses them with an Error or gives a mesh that other functions accept,
/// and all of its vertices at any time of its animations.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    const MeshSource source{name_of(bytes), bytes};
    TriangleMesh mesh;
    try {
        mesh = read_mesh(source);
        play(read_scene_file(source, Wanted::Animation), source);
    } catch (const Error& error) {
        test::require_sentence(error.what(), "attack");
    }
    if (!mesh.faces.empty()) inspect(mesh);
    return 0;
}
