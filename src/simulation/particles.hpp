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
    /// Floats after the last one, which a kernel may read and write back unchanged.
    static constexpr std::size_t kPadding = 64;

    std::vector<float> x, y, z; ///< [count + kPadding]

    void resize(std::size_t count) {
        for (std::vector<float>* c : {&x, &y, &z}) c->resize(count + kPadding);
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

/// Where a particle is put, and what it has moved in the last substep: its velocity.
struct Placement {
    Vec3f position, step;
};

/// The particles of a deformable while a frame is computed.
struct Particles {
    PointArrays positions;
    PointArrays previous;    ///< one substep ago
    PointArrays frame_start; ///< where they were when the frame began
    /// What rounding took off positions and previous ones: a place is the sum of both. For small steps and
    /// places far from the origin, where gravity and constraints move a particle by little more than a
    /// position's last digit.
    PointArrays remainders, previous_remainders;
    bool keeps_remainders;       ///< else they are 0
    std::vector<float> mobility; ///< 1, or 0 for a particle that is pinned

    explicit Particles(const Deformable& deformable, bool keeps_remainders_in = false)
        : keeps_remainders(keeps_remainders_in) {
        for (const float inverse_mass : deformable.inverse_masses)
            mobility.push_back(inverse_mass == 0 ? 0.0F : 1.0F);
        positions.load(deformable.positions);
        previous.load(deformable.previous_positions);
        frame_start = positions;
        for (PointArrays* points : {&remainders, &previous_remainders}) points->resize(count());
    }
    std::size_t count() const { return mobility.size(); }
    /// Or null: they are 0.
    PointArrays* kept_remainders() { return keeps_remainders ? &remainders : nullptr; }
    void keep_remainders(bool keeps) {
        if (!keeps && keeps_remainders)
            for (PointArrays* points : {&remainders, &previous_remainders}) points->fill(0);
        keeps_remainders = keeps;
    }
    bool pinned(std::size_t i) const { return mobility[i] == 0; }
    /// What the particle has moved in this substep.
    Vec3f step(std::size_t i) const {
        return (positions[i] - previous[i]) + (remainders[i] - previous_remainders[i]);
    }
    /// Gives a particle, where it is, another velocity: what it has moved in this substep.
    void set_velocity(std::size_t i, const Vec3d& step) {
        const Vec3d before = Vec3d(positions[i]) + Vec3d(remainders[i]) - step;
        previous.set(i, Vec3f(before));
        if (keeps_remainders) previous_remainders.set(i, Vec3f(before - Vec3d(previous[i])));
    }
    /// For substeps that are so many times as long as they were.
    void scale_velocities(double factor) {
        if (factor == 1) return;
        for (std::size_t i = 0; i < count(); ++i) set_velocity(i, Vec3d(step(i)) * factor);
    }
    void put(std::size_t i, const Placement& place) {
        positions.set(i, place.position);
        remainders.set(i, {});
        set_velocity(i, Vec3d(place.step));
    }
    void move(std::size_t i, const Vec3f& way) {
        put(positions, remainders, i, positions[i], way + remainders[i]);
    }
    void move_previous(std::size_t i, const Vec3f& way) {
        put(previous, previous_remainders, i, previous[i], way + previous_remainders[i]);
    }
    /// Puts a particle where it has moved by so much in this substep.
    void set_step(std::size_t i, const Vec3f& step) {
        put(positions, remainders, i, previous[i], step + previous_remainders[i]);
    }

  private:
    /// At so far from a place, and notes what rounding takes off that (Kahan 1965).
    void put(PointArrays& places, PointArrays& lost, std::size_t i, const Vec3f& from,
             const Vec3f& way) const {
        const Vec3f next = from + way;
        places.set(i, next);
        if (keeps_remainders) lost.set(i, way - (next - from));
    }
};

} // namespace echinus
