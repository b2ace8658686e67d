#pragma once

#include "contestants.hpp"
#include "pushes.hpp"

#include <echinus/scene.hpp>

#include <functional>

/// What became of a cloth on one system.
struct Outcome {
    std::uint32_t frames = 0;
    bool rested = false;
    double frame_ms = 0; ///< median of processor time, in the frames that all are timed in
    std::size_t inside_at_end = 0;
    double deepest_at_end = 0, deepest = 0; ///< of particles inside: in the last frame, and in any; R
    PushCounts pushes;
    std::vector<echinus::Vec3f> positions; ///< at the end
};

/// Frames in which all are timed, and every how manieth frame has its pushes judged.
struct RaceOptions {
    std::uint32_t frame_limit = 4000; ///< 17 seconds
    std::uint32_t first_timed = 180, timed_count = 100;
    std::uint32_t judged_step = 20;
    /// Called every hundred frames with what has come of it so far, and at the end.
    std::function<void(const std::vector<Outcome>& outcomes)> report;
};

/// Runs the scene with each until it rests, or to the limit, and tells what came of it. They take turns of a
/// few frames, so that what else the machine does slows all alike. The judge is an exact map with default
/// settings.
void race(const echinus::Scene& scene, const echinus::TriangleMesh& mesh,
          const std::vector<Contestant>& contestants, const RaceOptions& options);
