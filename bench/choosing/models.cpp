#include "models.hpp"

#include <echinus/mesh_io.hpp>

using namespace echinus;
using comparison::Axis;
namespace fs = std::filesystem;

std::vector<Model> read_models(const fs::path& meshes) {
    struct File {
        const char *name, *what, *file;
        Axis up;
    };
    constexpr File kFiles[] = {
        {"horse_6k", "four thin legs", "horse_6k.obj", Axis::Z},
        {"armadillo", "a scan with fingers and ears", "armadillo_52k.off", Axis::Y},
        {"liver", "one smooth lump", "liver.off", Axis::Z},
        {"mannequin", "a standing body, long and thin", "human_mannequin.obj", Axis::Z},
        {"scorpion", "thin legs, claws and tail", "scorpion.obj", Axis::Y},
    };
    std::vector<Model> models;
    for (const File& file : kFiles)
        models.push_back({file.name, file.what, file.up, read_mesh(meshes / file.file)});
    models.insert(models.begin() + 1, {"torus", "round, with a hole", Axis::Z, make_torus(1, 0.4, 60, 24)});
    return models;
}
