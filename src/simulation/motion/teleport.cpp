// Moves colliders and the deformable to other positions between two frames.

#include "simulation/solver.hpp"
#include "simulation/start/start_state.hpp"
#include "simulation/start/validation.hpp"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace echinus {

void Solver::teleport(const Teleport& teleport) {
    require_valid(teleport.motion, "a teleport");
    require_option(!std::isnan(teleport.time), "a teleport has a time that is not a number");
    require_option(options.kind() == SolverKind::Newton, "a teleport needs the newton solver");
    for (const std::uint32_t collider : teleport.colliders)
        require_option(collider < colliders.size(), "a teleport names collider " + std::to_string(collider) +
                                                        " of " + std::to_string(colliders.size()) +
                                                        ", numbered from 0");
    if (is_due(teleport.time, frame * options.time_step))
        carry_out(teleport);
    else
        teleports_.push_back(teleport);
}

void Solver::carry_out_teleports() {
    for (std::size_t t = 0; t < teleports_.size();) {
        if (!is_due(teleports_[t].time, frame * options.time_step)) {
            ++t;
            continue;
        }
        const Teleport teleport = teleports_[t];
        teleports_.erase(teleports_.begin() + static_cast<std::ptrdiff_t>(t));
        carry_out(teleport);
    }
}

void Solver::carry_out(const Teleport& teleport) {
    RigidTransform motion = teleport.motion;
    motion.rotation = motion.rotation.normalised();
    std::vector<std::uint8_t> goes(colliders.size());
    for (const std::uint32_t collider : teleport.colliders) goes[collider] = 1;
    for (const Attachment& attachment : deformable.attachments)
        require_option((goes[attachment.collider] != 0) == teleport.deformable,
                       "a teleport must move particle " + std::to_string(attachment.particle) + " and " +
                           name_of_collider(attachment.collider) + ", to which it is attached, together");
    // Things that are moved together keep their relative positions.
    std::vector<Vec3f> places = deformable.positions;
    if (teleport.deformable)
        for (Vec3f& place : places) place = Vec3f(motion.to_world(Vec3d(place)));
    std::vector<Collider> moved = colliders;
    for (std::size_t c = 0; c < colliders.size(); ++c) {
        Collider& collider = moved[c];
        if (goes[c] != 0) {
            collider.pose = after(motion, collider.pose);
            collider.linear_velocity = motion.rotation.apply(collider.linear_velocity);
            collider.angular_velocity = motion.rotation.apply(collider.angular_velocity);
        }
        if (options.surfaces_collide() && (goes[c] != 0) != teleport.deformable)
            require_no_meeting(deformable, places, let_through(deformable, c), collider, name_of_collider(c));
    }
    colliders = std::move(moved);
    for (std::size_t c = 0; c < colliders.size(); ++c)
        if (goes[c] != 0) motions.move(c, motion);
    if (!teleport.deformable) return;
    handles_.move(motion);
    move_particles(motion);
}

} // namespace echinus
