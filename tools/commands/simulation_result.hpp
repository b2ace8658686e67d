#pragma once

#include "commands/verdict.hpp"
#include "console/json.hpp"

#include <echinus/mesh.hpp>
#include <echinus/simulation.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// The pose of a collider in a saved frame.
struct SavedPose {
    std::uint32_t frame;
    echinus::RigidTransform pose;
};

/// The mean load on a collider over the frames since the previous saved frame.
struct SavedLoad {
    std::uint32_t frame;
    echinus::Load load;
};

/// The part of a report about a collider.
struct ColliderResult {
    std::string mesh_name;  ///< the name of the file in the folder
    std::string cache_name; ///< the name of the file with its vertices over time; empty if it does not deform
    echinus::MeshReport model;    ///< as read
    double radius;                ///< R in the world
    std::vector<SavedPose> poses; ///< only one if it is at rest
    std::vector<SavedLoad> loads; ///< for each saved frame; empty for a solver that measures none
};

/// The frame with the most intersecting pairs of faces, among those that were judged.
struct WorstFrame {
    std::size_t pair_count = 0;
    std::uint32_t frame = 0; ///< the first with this count
};

/// The frames with the most intersecting pairs during the simulation.
struct WorstFrames {
    std::size_t judged_count = 0;
    WorstFrame with_models, own;

    void judge(std::uint32_t frame, const PairCounts& pairs) {
        const auto keep_worse = [frame](WorstFrame& worst, std::size_t pair_count) {
            if (pair_count > worst.pair_count) worst = {pair_count, frame};
        };
        ++judged_count;
        keep_worse(with_models, pairs.with_models);
        keep_worse(own, pairs.own);
    }
};

/// The data that `simulate` reports at the end.
struct SimulationResult {
    const std::string& scene_name;
    const echinus::Simulation& simulation;
    std::vector<ColliderResult> colliders; ///< at least one
    Verdict verdict;
    std::uint64_t most_truncated = 0; ///< the most vertices truncated in one frame
    std::optional<WorstFrames> worst; ///< none if only the end was judged
};

/// The object of report.json.
Json to_json(const SimulationResult& result);

/// A table for people.
std::string to_text(const SimulationResult& result);
