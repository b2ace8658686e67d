#pragma once

#include "rivals/compare/point_sets.hpp"

#include <echinus/exact_map.hpp>

#include <algorithm>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <vector>

/// A mesh to measure on.
struct Model {
    std::string name;
    echinus::TriangleMesh mesh;
    echinus::comparison::Axis up;
    double radius; ///< of the bounding sphere
    bool closed;
};

/// The meshes of a folder, by name, and Debian's horse, repaired (closed) and as it is (not). A folder that
/// does not exist is empty.
std::vector<Model> read_models(const std::filesystem::path& folder,
                               const std::filesystem::path& debian_horse);

/// The first of these models that there is; the last one listed must be.
const Model& first_of(const std::vector<Model>& models, std::initializer_list<const char*> names);

/// All that a measurement is made with.
struct Setting {
    std::vector<Model> models;
    std::filesystem::path images; ///< where plots go
    std::size_t point_count;      ///< per set
    int repetitions;              ///< of which the shortest counts
    std::size_t most_faces;       ///< of generated meshes

    /// The paper's class of model.
    const Model& horse() const { return first_of(models, {"horse_6k", "horse"}); }
    /// For what need not be as precise; a cloth of fewer would not be smoothed.
    std::size_t few_points() const { return std::max<std::size_t>(point_count / 5, 10'000); }
};

/// On one thread, as everything here.
inline echinus::ExactMapOptions one_thread() {
    echinus::ExactMapOptions options;
    options.thread_count = 1;
    return options;
}
