#include "scene_model.hpp"

#include "input_file.hpp"

#include <echinus/error.hpp>
#include <echinus/mesh_io.hpp>

#include <string>

using namespace echinus;
namespace fs = std::filesystem;

namespace {

struct MeshOfModel {
    const fs::path& scene_path;
    const std::vector<fs::path>& folders;

    TriangleMesh operator()(const ModelFile& file) const {
        return read_mesh(naming_file(scene_path.string(), ErrorCode::Unreadable,
                                     [&] { return find_model(file, folders); }));
    }
    TriangleMesh operator()(const auto& shape) const {
        try {
            return make_mesh(shape);
        } catch (const Error& error) {
            throw Error(ErrorCode::InvalidScene, scene_path.string() + ": \"model\": " + error.what());
        }
    }
};

/// The push-out needs an inside; a hole would let cloth through, and the judge could not tell.
void require_closed(const TriangleMesh& mesh, const fs::path& scene_path) {
    const MeshReport report = inspect(mesh);
    if (report.closed) return;
    throw Error(ErrorCode::InvalidMesh,
                scene_path.string() +
                    ": the model is not closed: " + std::to_string(report.border_edges.count) +
                    " border edges, " + std::to_string(report.nonmanifold_edges.count) +
                    " edges with more than two faces, " + std::to_string(report.misoriented_edges.count) +
                    " edges that faces run along the same way; name what to mend under \"repair\"");
}

} // namespace

RepairedMesh load_model(const Scene& scene, const fs::path& scene_path, std::vector<fs::path> folders) {
    folders.push_back(scene_path.parent_path().empty() ? "." : scene_path.parent_path());
    folders.push_back(scene_path.parent_path() / ".." / "models");
    folders.emplace_back("models");
    RepairedMesh model = repair(std::visit(MeshOfModel{scene_path, folders}, scene.model), scene.repair);
    require_closed(model.mesh, scene_path);
    return model;
}
