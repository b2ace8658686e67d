#include "mesh_io/import_scene.hpp"
#include "mesh_io/readers.hpp"

namespace echinus {

PolygonMesh read_scene(const MeshSource& source) {
    return SceneFile(source).join();
}

} // namespace echinus
