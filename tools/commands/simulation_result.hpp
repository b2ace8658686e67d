#pragma once

#include "commands/verdict.hpp"
#include "console/json.hpp"

#include <echinus/mesh.hpp>
#include <echinus/simulation.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// Where a collider stood in a frame that was saved.
struct SavedPose {
    std::uint32_t frame;
    echinus::RigidTransform pose;
};

/// The load on a collider in the frames since the one before that was saved, as their mean.
struct SavedLoad {
    std::uint32_t frame;
    echinus::Load load;
};

/// The part of a report about a collider.
struct ColliderResult {
    std::string mesh_name;        ///< of the file in the folder
    std::string cache_name;       ///< of that with its vertices over time; empty where it does not deform
    echinus::MeshReport model;    ///< as read
    double radius;                ///< R in the world
    std::vector<SavedPose> poses; ///< one when it stands still
    std::vector<SavedLoad> loads; ///< of each saved frame; none under a solver that measures none
};

/// Of the frames that were judged, the one with the most pairs of faces that intersect.
struct WorstFrame {
    std::size_t pair_count = 0;
    std::uint32_t frame = 0; ///< the first with so many
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
    std::uint64_t most_truncated = 0; ///< vertices in one frame
    std::optional<WorstFrames> worst; ///< none where only the end was judged
};

/// The object of report.json.
Json to_json(const SimulationResult& result);

/// A table for people.
std::string to_text(const SimulationResult& result);
