#pragma once

#include "comparison/compare.hpp"

#include <echinus/mesh.hpp>

#include <filesystem>
#include <string>
#include <vector>

/// A mesh of the comparison, and what was measured on it.
struct Model {
    std::string name;
    std::string what; ///< in a few words
    echinus::comparison::Axis up;
    echinus::TriangleMesh mesh;
    echinus::comparison::Comparison result{};
};

/// horse_6k, torus, armadillo, liver, mannequin and scorpion; without the folder of development meshes the
/// torus and Debian's horse, with a message on standard error.
std::vector<Model> read_models(const std::filesystem::path& meshes,
                               const std::filesystem::path& debian_horse);
