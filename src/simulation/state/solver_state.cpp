// The state of a simulation: everything that a frame reads before it writes it.

#include "simulation/solver.hpp"

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
    for (std::uint64_t* count : {&profile.query_count, &profile.contact_count, &profile.map_query_count,
                                 &profile.rescued_count, &profile.lost_count, &profile.truncated_count,
                                 &profile.measured_pair_count, &profile.unresolved_count})
        state.value(*count);
}

/// Colliders get their maps before anything that queries these is read.
void Solver::archive_colliders(StateArchive& state) {
    motions.archive(state);
    handles_.archive(state, [&](std::uint32_t particle, bool is_held) { set_held(particle, is_held); });
    state.items(teleports_, [&](Teleport& teleport) {
        state.pose(teleport.motion);
        state.indices(teleport.colliders, colliders.size(), colliders.size());
        state.flag(teleport.deformable);
        state.value(teleport.time);
    });
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
            state.require(exact != nullptr && options.surfaces_collide());
            deforming_[c].emplace(*exact, name_of_collider(c));
        }
        if (!deforms && deforming_[c]) {
            collider.map = deforming_[c]->first_map();
            deforming_[c].reset();
        }
        if (deforms) deforming_[c]->archive(state, collider);
    }
}

} // namespace echinus
