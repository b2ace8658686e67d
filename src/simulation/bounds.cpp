#include "simulation/bounds.hpp"

#include <echinus/error.hpp>

#include <algorithm>
#include <span>

namespace echinus {

namespace {

Sphere box_sphere(std::span<const Vec3f> points) {
    Vec3d low(points.front());
    Vec3d high = low;
    for (const Vec3f& p : points) {
        low = {std::min(low.x, double{p.x}), std::min(low.y, double{p.y}), std::min(low.z, double{p.z})};
        high = {std::max(high.x, double{p.x}), std::max(high.y, double{p.y}), std::max(high.z, double{p.z})};
    }
    return {(low + high) * 0.5, length(high - low) / 2};
}

/// The largest length whose square is still a float.
constexpr double kLongestWay = 1e18;

/// Nothing brings back a particle that moves this many times the bound in a frame.
constexpr double kFartherOnTheWay = 100;

/// Written so that it is false for NaN.
bool is_within(const Vec3d& length, double most) {
    return dot(length, length) <= most * most;
}

} // namespace

Bounds::Bounds(const SimulationOptions& options, const Deformable& start) {
    const Sphere sphere = box_sphere(start.positions);
    centre_ = sphere.centre;
    // A single particle has no extent; its bound is then in the caller's unit.
    farthest_ = options.bound > 0 ? options.bound : 1e4 * (sphere.radius > 0 ? 2 * sphere.radius : 1);
}

void Bounds::require_sound() const {
    if (!diverged_.empty()) throw Error(ErrorCode::Diverged, diverged_);
}

template <typename Points>
void Bounds::require_within(const Points& points, std::size_t count, double most, std::uint32_t frame) {
    for (std::size_t i = 0; i < count; ++i)
        if (!is_within(Vec3d(points[i]) - centre_, most))
            diverge(frame, "particle " + std::to_string(i) +
                               " left all bounds; try a smaller time step or stiffness");
}

double Bounds::most_on_the_way() const {
    return std::min(kLongestWay, kFartherOnTheWay * farthest_);
}

void Bounds::require_ways(const Particles& particles, std::uint32_t frame) {
    require_within(particles.positions, particles.count(), most_on_the_way(), frame);
    require_within(particles.previous, particles.count(), most_on_the_way(), frame);
}

void Bounds::require_ways(std::span<const Vec3d> ends, std::uint32_t frame) {
    require_within(ends, ends.size(), most_on_the_way(), frame);
}

bool Bounds::contain_way(const Collider& collider, double seconds) {
    return is_within(collider.pose.translation, kLongestWay) &&
           is_within(collider.linear_velocity * seconds, kLongestWay) &&
           is_within(collider.angular_velocity * seconds, kLongestWay);
}

void Bounds::require_ends(const PointArrays& positions, std::size_t count, std::uint32_t frame) {
    require_within(positions, count, farthest_, frame);
}

void Bounds::diverge(std::uint32_t frame, const std::string& what) {
    diverged_ = "the simulation diverged in frame " + std::to_string(frame + 1) + ": " + what;
    throw Error(ErrorCode::Diverged, diverged_);
}

} // namespace echinus
