#pragma once

#include "commands/verdict.hpp"
#include "json.hpp"

#include <echinus/mesh.hpp>
#include <echinus/simulation.hpp>

#include <cstdint>
#include <string>
#include <vector>

/// Where a collider stood in a frame that was saved.
struct SavedPose {
    std::uint32_t frame;
    echinus::RigidTransform pose;
};

/// What is said about a collider.
struct ColliderResult {
    std::string mesh_name;        ///< of the file in the folder
    std::string cache_name;       ///< of that with its vertices over time; empty where it does not deform
    echinus::MeshReport model;    ///< as read
    double radius;                ///< R in the world
    std::vector<SavedPose> poses; ///< one when it stands still
};

/// What `simulate` reports when it is done.
struct SimulationResult {
    const std::string& scene_name;
    const echinus::Simulation& simulation;
    std::vector<ColliderResult> colliders; ///< at least one
    Verdict verdict;
    std::uint64_t most_truncated = 0; ///< vertices in one frame
};

/// The object of report.json.
Json to_json(const SimulationResult& result);

/// A table for people.
std::string to_text(const SimulationResult& result);
