// What belongs to the state of a simulation: all that a frame reads before it writes it.

#include "simulation/relaxation_solver.hpp"

#include <variant>

namespace echinus {

StateFingerprint Solver::fingerprint() const {
    StateFingerprint result{hash_of(options), hash_of(deformable, start_hash_), {}};
    for (std::size_t c = 0; c < colliders.size(); ++c) {
        const ColliderMap map = deforming_[c] ? deforming_[c]->first_map() : colliders[c].map;
        result.colliders.push_back(hash_of(map, colliders[c].scale, start_poses_[c]));
    }
    return result;
}

void Solver::archive_counts(StateArchive& state) {
    state.value(frame);
    state.flag(has_blown);
    state.value(largest_speed);
    for (std::uint64_t* count :
         {&profile.query_count, &profile.contact_count, &profile.map_query_count, &profile.rescued_count,
          &profile.lost_count, &profile.truncated_count, &profile.searched_face_count,
          &profile.measured_pair_count, &profile.squeezed_count})
        state.value(*count);
}

/// Their maps before all else that asks them.
void Solver::archive_colliders(StateArchive& state) {
    motions.archive(state);
    for (std::size_t c = 0; c < colliders.size(); ++c) {
        Collider& collider = colliders[c];
        state.pose(collider.pose);
        state.value(collider.linear_velocity);
        state.value(collider.angular_velocity);
        state.require(is_finite(collider.linear_velocity) && is_finite(collider.angular_velocity));
        bool deforms = deforming_[c].has_value();
        state.flag(deforms);
        if (deforms && !deforming_[c]) {
            const auto* exact = std::get_if<ExactMap>(&collider.map.kind);
            state.require(exact != nullptr && options.surface_collision);
            deforming_[c].emplace(*exact, name_of_collider(c));
        }
        if (!deforms && deforming_[c]) {
            collider.map = deforming_[c]->first_map();
            deforming_[c].reset();
        }
        if (deforms) deforming_[c]->archive(state, collider);
    }
}

void RelaxationSolver::archive(StateArchive& state) {
    archive_counts(state);
    state.points(particles_.positions);
    state.points(particles_.previous);
    state.points(particles_.remainders);
    state.points(particles_.previous_remainders);
    rest_.archive(state);
    if (stretched_part_) stretched_part_->archive(state, sticks_.count());
    if (gentle_sticks_) gentle_sticks_->archive(state);
    if (meter_) meter_->archive(state);
    if (energy_limit_) energy_limit_->archive(state);
    archive_colliders(state);
    attachments_.archive(state, deforming_);
    collisions_.archive(state, colliders);
    if (surfaces_) surfaces_->archive(state);
    if (state.reads()) publish();
}

} // namespace echinus
