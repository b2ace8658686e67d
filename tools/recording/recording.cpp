#include "recording/recording.hpp"

#include <echinus/collider.hpp>
#include <echinus/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

using namespace echinus;

namespace {

/// The most positions of particles in a page. For each, a browser needs 6 bytes, and a share of a text of at
/// most 2^29 characters, which is the longest in Chromium: 8 characters if nothing compresses.
constexpr std::uint64_t kMostPositions = 64'000'000;

/// An open model has no inside.
/// @param passes  particles that the collider lets through, as returned by let_through()
std::size_t count_inside(const ExactMap& model, const Collider& collider, std::span<const Vec3f> positions,
                         std::span<const std::uint8_t> passes) {
    if (!model.view().border.empty()) return 0;
    const Collider judge{.map = model, .pose = collider.pose, .scale = collider.scale};
    std::vector<std::uint8_t> inside(positions.size());
    contains_batch(judge, positions, inside);
    for (std::size_t i = 0; i < passes.size(); ++i)
        if (passes[i] != 0) inside[i] = 0;
    return static_cast<std::size_t>(std::count(inside.begin(), inside.end(), 1));
}

/// The number of frames that are due, and the last frame.
std::uint64_t most_recorded(std::uint32_t frame_limit, std::uint64_t stride) {
    return frame_limit / stride + 2;
}

} // namespace

void Recording::watch(const Simulation& simulation) {
    if (simulation.frame() % stride_ == 0) add(simulation);
}

void Recording::finish(const Simulation& simulation) {
    if (frames_.empty() || frames_.back().number != simulation.frame()) add(simulation);
}

void Recording::add_pairs(std::uint32_t frame, const PairCounts& pairs) {
    if (!frames_.empty() && frames_.back().number == frame) frames_.back().pairs = pairs;
}

void Recording::add(const Simulation& simulation) {
    const std::span<const Vec3f> positions = simulation.positions();
    RecordedFrame& frame = frames_.emplace_back(
        RecordedFrame{simulation.frame(), {positions.begin(), positions.end()}, {}, 0, {}});
    for (std::size_t c = 0; c < models_.size(); ++c) {
        const Collider& collider = simulation.colliders()[c];
        frame.poses.push_back(collider.pose);
        frame.inside_count +=
            count_inside(models_[c], collider, positions, let_through(simulation.deformable(), c));
    }
}

std::uint32_t stride_for_display(double time_step) {
    constexpr double kRate = 60, kRounding = 1e-6, kMost = 1e6;
    return static_cast<std::uint32_t>(std::clamp(std::ceil(1 / (kRate * time_step) - kRounding), 1.0, kMost));
}

void require_playable(std::size_t particle_count, std::uint32_t frame_limit, std::uint32_t stride) {
    const auto holds = [&](std::uint64_t candidate) {
        return particle_count * most_recorded(frame_limit, candidate) <= kMostPositions;
    };
    if (holds(stride)) return;
    std::uint64_t remedy = std::uint64_t{2} * stride;
    while (!holds(remedy) && remedy < frame_limit) remedy *= 2;
    throw Error(ErrorCode::InvalidOptions,
                fmt::format("a page of {} particles in up to {} frames is more than a browser can hold; {}",
                            particle_count, most_recorded(frame_limit, stride),
                            holds(remedy) ? fmt::format("record fewer with --every {}, or end earlier with "
                                                        "--frames",
                                                        remedy)
                                          : "use a smaller cloth"));
}
