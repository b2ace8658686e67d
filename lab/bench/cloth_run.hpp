#pragma once

#include <echinus/collider.hpp>
#include <echinus/exact_map.hpp>
#include <echinus_scene/scene.hpp>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

/// A system as the collider of a simulation.
struct ClothSystem {
    std::string name, setting; ///< resolution and the like, in words
    std::size_t bytes = 0;
    echinus::ColliderMap map;
    bool only_timed = false; ///< its run ends once it is timed: too slow to complete
};

/// The systems of rivals/ around one mesh; those with several sizes have the paper's.
/// @param thickness  of the scene, in the mesh's unit
std::vector<ClothSystem> cloth_systems(const echinus::TriangleMesh& mesh, double thickness);

/// A scene and its repaired model.
struct ClothScene {
    echinus::Scene scene;
    echinus::TriangleMesh mesh;
};

struct ClothLimits {
    std::uint32_t frame_limit = 4000; ///< 17 seconds
    std::uint32_t first_timed = 180, timed_count = 100;
};

/// The result of one cloth's simulation.
struct ClothOutcome {
    std::uint32_t frames = 0;
    bool rested = false;
    double frame_ms = 0;                        ///< median of processor time, in the frames that are timed
    double constraint_ms = 0, collision_ms = 0; ///< of a frame, means by the simulation's own account
    std::size_t inside_at_end = 0;
    double deepest_at_end = 0, deepest = 0; ///< of particles inside: in the last frame, and in any; R
};

/// Runs the scene with each system until the cloth rests, or to the limit. They take turns of a few frames,
/// so that other load on the machine slows all alike. The judge is an exact map.
std::vector<ClothOutcome> run_cloths(const ClothScene& scene, const std::vector<ClothSystem>& systems,
                                     const ClothLimits& limits,
                                     const std::function<void(double)>& report_progress);

/// Simulations take turns of a few frames until all are done, so that other load on the machine slows all
/// alike.
/// @param runners  of a class with is_done(), run_frame() and progress()
template <typename Runner>
void run_in_turns(std::vector<Runner>& runners, const std::function<void(double)>& report_progress) {
    constexpr int kTurn = 10; // frames
    while (!std::ranges::all_of(runners, &Runner::is_done)) {
        double progress = 1;
        for (Runner& runner : runners) {
            for (int i = 0; i < kTurn && !runner.is_done(); ++i) runner.run_frame();
            progress = std::min(progress, runner.progress());
        }
        report_progress(progress);
    }
}
