#pragma once

#include "rivals/compare/compare.hpp"

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

/// horse_6k, torus, armadillo, liver, mannequin and scorpion.
/// @param meshes  the folder of development meshes; the page is about all of them
/// @throws echinus::Error Unreadable when one is not there
std::vector<Model> read_models(const std::filesystem::path& meshes);
