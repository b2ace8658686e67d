#pragma once

#include <echinus/geometry.hpp>
#include <echinus/simulation.hpp>

#include <algorithm>
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

/// Where a particle is put, and where it was one substep before: its velocity.
struct Placement {
    Vec3f position, previous;
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
    bool pinned(std::size_t i) const { return mobility[i] == 0; }
    /// What the particle has moved in this substep.
    Vec3f step(std::size_t i) const {
        return (positions[i] - previous[i]) + (remainders[i] - previous_remainders[i]);
    }
    /// For substeps that are so many times as long as they were.
    void scale_velocities(double factor) {
        if (factor == 1) return;
        for (std::size_t i = 0; i < count(); ++i) {
            const Vec3d place = Vec3d(positions[i]) + Vec3d(remainders[i]);
            const Vec3d before = place - Vec3d(step(i)) * factor;
            previous.set(i, Vec3f(before));
            if (keeps_remainders) previous_remainders.set(i, Vec3f(before - Vec3d(previous[i])));
        }
    }
    void put(std::size_t i, const Placement& place) {
        positions.set(i, place.position);
        previous.set(i, place.previous);
        remainders.set(i, {});
        previous_remainders.set(i, {});
    }
    void move(std::size_t i, const Vec3f& way) { move(positions, remainders, i, way); }
    void move_previous(std::size_t i, const Vec3f& way) { move(previous, previous_remainders, i, way); }

  private:
    void move(PointArrays& places, PointArrays& lost, std::size_t i, const Vec3f& way) const {
        const Vec3f place = places[i], whole = way + lost[i], next = place + whole;
        places.set(i, next);
        if (keeps_remainders) lost.set(i, whole - (next - place));
    }
};

} // namespace echinus
