#pragma once

#include "commands/verdict.hpp"
#include "json.hpp"

#include <echinus/mesh.hpp>
#include <echinus/simulation.hpp>

#include <cstdint>
#include <string>
#include <vector>

/// Where the collider stood in a frame that was saved.
struct SavedPose {
    std::uint32_t frame;
    echinus::RigidTransform pose;
};

/// What `simulate` reports when it is done.
struct SimulationResult {
    const std::string& scene_name;
    const echinus::Simulation& simulation;
    const echinus::MeshReport& model;
    double collider_radius; ///< R of the collider in the world
    Verdict verdict;
    std::vector<SavedPose> poses;     ///< one when the collider stands still
    std::uint64_t most_truncated = 0; ///< vertices in one frame
};

/// The object of report.json.
Json to_json(const SimulationResult& result);

/// A table for people.
std::string to_text(const SimulationResult& result);
