#pragma once

#include "json.hpp"

#include <echinus/collider.hpp>
#include <echinus/mesh.hpp>
#include <echinus/simulation.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

/// Where particles are, judged by the mesh itself.
struct Verdict {
    std::size_t inside_count = 0;
    double deepest = 0; ///< distance of the deepest of them from the surface, units
};

/// A mesh stretched along its axes. Where that mirrors it, its faces are turned round, so that what was
/// inside stays inside.
echinus::TriangleMesh scaled(echinus::TriangleMesh mesh, const echinus::Vec3d& scale);

/// Judges every particle by its winding number and its distance from the surface, both brute force over all
/// faces; of the collider only pose and scale enter, not the map.
/// @param thread_count  0: all cores
Verdict judge(std::span<const echinus::Vec3f> positions_world, const echinus::TriangleMesh& mesh,
              const echinus::Collider& collider, unsigned thread_count);

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
    std::vector<SavedPose> poses; ///< one when the collider stands still
};

/// The object of report.json.
Json to_json(const SimulationResult& result);

/// A table for people.
std::string to_text(const SimulationResult& result);
