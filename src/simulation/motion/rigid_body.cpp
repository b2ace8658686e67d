#include "simulation/motion/rigid_body.hpp"

#include "mechanics/thresholds.hpp"
#include "simulation/start/validation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

namespace echinus {

namespace {

constexpr double kLeastMass = 1e-9, kMostMass = 1e15; // kg

/// The integrals over a solid of density 1.
struct Solid {
    double volume = 0;
    Vec3d moment;       ///< the integral of the positions
    Matrix3 products{}; ///< the integral of their outer products

    void add_outer(const Vec3d& v, double weight) {
        products[0] += v * (v.x * weight);
        products[1] += v * (v.y * weight);
        products[2] += v * (v.z * weight);
    }
    /// Adds the tetrahedron between the origin and a face.
    void add(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
        const double share = dot(a, cross(b, c)) / 6;
        volume += share;
        moment += (a + b + c) * (share / 4);
        for (const Vec3d& v : {a + b + c, a, b, c}) add_outer(v, share / 20);
    }
};

} // namespace

RigidBody::RigidBody(const TriangleMesh& surface, double mass, const Collider& collider,
                     const std::string& name)
    : mass_(mass) {
    std::array<char, 32> mass_text{};
    std::snprintf(mass_text.data(), mass_text.size(), "%g", mass);
    require_option(mass >= kLeastMass && mass <= kMostMass,
                   name + " has a mass of " + mass_text.data() + "; it must be from 1e-9 to 1e15 kg");
    Solid solid;
    const Vec3d origin(surface.vertices.front());
    for (const Triangle& face : surface.faces)
        solid.add(Vec3d(surface.vertices[face[0]]) - origin, Vec3d(surface.vertices[face[1]]) - origin,
                  Vec3d(surface.vertices[face[2]]) - origin);
    require_option(solid.volume != 0, name + " encloses nothing, so it has no centre of mass");
    const Vec3d centre = solid.moment * (1 / solid.volume);
    solid.add_outer(centre, -solid.volume);
    const double density = mass / solid.volume; // negative, like the integrals, if faces look inwards
    const double trace = solid.products[0].x + solid.products[1].y + solid.products[2].z;
    for (std::size_t k = 0; k < 3; ++k) inertia_[k] = solid.products[k] * -density;
    inertia_[0].x += trace * density;
    inertia_[1].y += trace * density;
    inertia_[2].z += trace * density;
    centre_ = centre + origin;
    require_option(has_inertia(),
                   name + " has faces that contradict each other, so it has no inertia; repair the mesh");
    const Rotation& rotation = collider.pose.rotation;
    velocity_ = collider.linear_velocity + cross(collider.angular_velocity, rotation.apply(centre_));
    angular_velocity_ = collider.angular_velocity;
    angular_momentum_ = rotation.apply(times(inertia_, rotation.inverse().apply(collider.angular_velocity)));
}

Vec3d RigidBody::angular_velocity(const Rotation& rotation) const {
    const Eigensystem principal = principal_moments();
    const Vec3d momentum = rotation.inverse().apply(angular_momentum_);
    Vec3d velocity;
    for (std::size_t k = 0; k < 3; ++k)
        velocity += principal.vectors[k] * (dot(principal.vectors[k], momentum) / principal.values[k]);
    return rotation.apply(velocity);
}

void RigidBody::push(const RigidTransform& pose, const Load& load, const Vec3d& gravity, double seconds) {
    const Vec3d arm = pose.rotation.apply(centre_);
    gained_ = gravity + load.force * (1 / mass_);
    velocity_ += gained_ * seconds;
    angular_momentum_ += (load.torque - cross(arm, load.force)) * seconds;
    angular_velocity_ = angular_velocity(pose.rotation);
}

RigidTransform RigidBody::after(const RigidTransform& pose, const Vec3d& gravity, double seconds) const {
    RigidBody pushed = *this;
    pushed.push(pose, {}, gravity, seconds);
    return pushed.after(pose, seconds);
}

double RigidBody::left_of(const Vec3d& gravity) const {
    const double size_sq = dot(gravity, gravity);
    return size_sq > 0 ? std::clamp(dot(gained_, gravity) / size_sq, 0.0, 1.0) : 0;
}

/// Turns a free body according to its angular momentum, by rotations about its principal axes in turn and in
/// reverse order (Strang). Each of them keeps the momentum exactly, so that the energy neither grows nor
/// falls in the long run (McLachlan 1993; Reich 1994).
Rotation RigidBody::turned(Rotation rotation, double seconds) const {
    const Eigensystem principal = principal_moments();
    const double least = *std::min_element(principal.values.begin(), principal.values.end());
    const double most_turn = length(angular_momentum_) / least * seconds;
    const double count =
        std::clamp(std::ceil(most_turn / threshold::kLongestTurn), 1.0, threshold::kMostTurns);
    const auto turn_about = [&](std::size_t axis, double share) {
        const double momentum = dot(principal.vectors[axis], rotation.inverse().apply(angular_momentum_));
        const double angle = momentum / principal.values[axis] * (seconds * share / count);
        rotation = rotation * Rotation::about(principal.vectors[axis], angle);
    };
    for (double turn = 0; turn < count; ++turn) {
        turn_about(0, 0.5);
        turn_about(1, 0.5);
        turn_about(2, 1);
        turn_about(1, 0.5);
        turn_about(0, 0.5);
        rotation = rotation.normalised();
    }
    return rotation;
}

RigidTransform RigidBody::after(const RigidTransform& pose, double seconds) const {
    const Vec3d arm = pose.rotation.apply(centre_);
    RigidTransform end;
    end.rotation = angular_momentum_ != Vec3d{} ? turned(pose.rotation, seconds) : pose.rotation;
    end.translation = pose.translation + arm + velocity_ * seconds - end.rotation.apply(centre_);
    return end;
}

void RigidBody::give_velocities(Collider& collider) const {
    collider.angular_velocity = angular_velocity_;
    collider.linear_velocity = velocity_ - cross(angular_velocity_, collider.pose.rotation.apply(centre_));
}

Eigensystem RigidBody::second_moments() const {
    const double half_trace = (inertia_[0].x + inertia_[1].y + inertia_[2].z) / 2;
    Eigensystem moments = principal_moments();
    for (double& value : moments.values) value = (half_trace - value) / mass_;
    return moments;
}

Eigensystem RigidBody::principal_moments() const {
    std::array<std::array<double, 3>, 3> inertia{};
    for (std::size_t k = 0; k < 3; ++k) inertia[k] = {inertia_[k].x, inertia_[k].y, inertia_[k].z};
    return eigensystem(inertia);
}

bool RigidBody::has_inertia() const {
    const Eigensystem moments = second_moments();
    return std::all_of(moments.values.begin(), moments.values.end(), [](double value) { return value > 0; });
}

bool RigidBody::is_slower_than(double speed) const {
    return length(velocity_) <= speed && length(angular_velocity_) <= speed;
}

void RigidBody::turn(const Rotation& rotation) {
    velocity_ = rotation.apply(velocity_);
    angular_momentum_ = rotation.apply(angular_momentum_);
    angular_velocity_ = rotation.apply(angular_velocity_);
    gained_ = rotation.apply(gained_);
}

void RigidBody::archive(StateArchive& state) {
    state.value(mass_);
    for (Vec3d* v : {&centre_, &inertia_[0], &inertia_[1], &inertia_[2], &velocity_, &angular_momentum_,
                     &angular_velocity_, &gained_}) {
        state.value(*v);
        state.require(is_finite(*v));
    }
    state.require(mass_ >= kLeastMass && mass_ <= kMostMass && has_inertia());
}

} // namespace echinus
