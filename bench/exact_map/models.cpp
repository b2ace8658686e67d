#include "models.hpp"

#include <echinus/error.hpp>
#include <echinus/mesh_io.hpp>

#include <algorithm>
#include <utility>

using namespace echinus;
namespace fs = std::filesystem;

namespace {

Model model(std::string name, TriangleMesh mesh) {
    const MeshReport report = inspect(mesh);
    const bool z_is_up = name == "horse_6k" || name == "human_mannequin";
    return {std::move(name), std::move(mesh), z_is_up ? comparison::Axis::Z : comparison::Axis::Y,
            report.bounding_sphere.radius, report.closed};
}

bool is_mesh(const fs::path& path) {
    return path.extension() == ".obj" || path.extension() == ".off";
}

} // namespace

std::vector<Model> read_models(const fs::path& folder, const fs::path& debian_horse) {
    const TriangleMesh horse = read_mesh(debian_horse);
    std::vector<Model> models{model("horse", repair(horse, RepairOptions::all()).mesh),
                              model("horse, unrepaired", horse)};
    if (fs::exists(folder))
        for (const fs::directory_entry& entry : fs::directory_iterator(folder))
            if (is_mesh(entry.path()) && entry.path().stem() != "horse_glmark2_raw") // Debian's again
                models.push_back(model(entry.path().stem().string(), read_mesh(entry.path())));
    std::ranges::sort(models, {}, &Model::name);
    return models;
}

const Model& first_of(const std::vector<Model>& models, std::initializer_list<const char*> names) {
    for (const char* name : names) {
        const auto found = std::ranges::find(models, name, &Model::name);
        if (found != models.end()) return *found;
    }
    throw Error(ErrorCode::Unreadable, std::string(*(names.end() - 1)) + ": no such model");
}
