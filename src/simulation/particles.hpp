#pragma once

#include <echinus/geometry.hpp>
#include <echinus/simulation.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace echinus {

/// Points as a structure of arrays, so that one instruction can work on many of them.
struct PointArrays {
    std::vector<float> x, y, z; ///< [count]

    void resize(std::size_t count) {
        for (std::vector<float>* c : {&x, &y, &z}) c->resize(count);
    }
    void fill(float value) {
        for (std::vector<float>* c : {&x, &y, &z}) std::fill(c->begin(), c->end(), value);
    }
    bool operator==(const PointArrays&) const = default;
    Vec3f operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
    void set(std::size_t i, const Vec3f& p) {
        x[i] = p.x;
        y[i] = p.y;
        z[i] = p.z;
    }
    void load(std::span<const Vec3f> points) {
        resize(points.size());
        for (std::size_t i = 0; i < points.size(); ++i) set(i, points[i]);
    }
    void store(std::span<Vec3f> points) const {
        for (std::size_t i = 0; i < points.size(); ++i) points[i] = (*this)[i];
    }
};

inline float largest_coordinate(const PointArrays& points, std::size_t count) {
    float largest = 0;
    for (std::size_t i = 0; i < count; ++i)
        largest = std::max({largest, std::fabs(points.x[i]), std::fabs(points.y[i]), std::fabs(points.z[i])});
    return largest;
}

/// The position in which a particle is put, and its displacement in this frame, which is its velocity.
struct Placement {
    Vec3f position, step;
};

/// The particles of a deformable while a frame of the jakobsen solver is computed.
struct Particles {
    PointArrays positions;
    PointArrays previous;        ///< the positions one frame ago
    PointArrays frame_start;     ///< the positions at the beginning of the frame
    std::vector<float> mobility; ///< [particle] 1, or 0 for a pinned particle

    Particles() = default;
    /// @param time_step  seconds per frame
    Particles(const Deformable& deformable, double time_step) {
        for (const float inverse_mass : deformable.inverse_masses)
            mobility.push_back(inverse_mass == 0 ? 0.0F : 1.0F);
        positions.load(deformable.positions);
        frame_start = previous = positions;
        for (std::size_t i = 0; i < deformable.velocities.size(); ++i)
            set_velocity(i, Vec3d(deformable.velocities[i]) * time_step);
    }
    std::size_t count() const { return mobility.size(); }
    bool pinned(std::size_t i) const { return mobility[i] == 0; }
    /// The displacement of the particle in this frame.
    Vec3f step(std::size_t i) const { return positions[i] - previous[i]; }
    /// Changes a particle's velocity, but not its position. @param step  its displacement in this frame
    void set_velocity(std::size_t i, const Vec3d& step) {
        previous.set(i, Vec3f(Vec3d(positions[i]) - step));
    }
    void put(std::size_t i, const Placement& place) {
        positions.set(i, place.position);
        set_velocity(i, Vec3d(place.step));
    }
    void move_previous(std::size_t i, const Vec3f& way) { previous.set(i, previous[i] + way); }
    /// Moves a particle so that its displacement in this frame is `step`.
    void set_step(std::size_t i, const Vec3f& step) { positions.set(i, previous[i] + step); }
};

} // namespace echinus
