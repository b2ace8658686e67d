#pragma once

#include <echinus/custom_map.hpp>
#include <echinus/exact_map.hpp>
#include <echinus/simulation.hpp>

#include <cstdint>
#include <memory>

/// Of all particles that a system found inside, in every relaxation.
struct PushCounts {
    std::uint64_t inside = 0;     ///< found so
    std::uint64_t too_far = 0;    ///< of them, pushed by more than twice the true depth
    std::uint64_t no_way_out = 0; ///< of them, those for whom it had none
};

/// Computes the next frame of a copy of the simulation, on which the system is asked for contacts alone, and
/// judges each push that leads out: the way from the particle to the contact's point, thickness not included.
/// The true depth of a particle that is outside is 0. A push counts as too far only when it is also longer
/// than a ten thousandth of the judge's radius, which is far more than what anybody rounds.
/// @pre the simulation has one collider, which stands still
void judge_next_pushes(const echinus::Simulation& simulation,
                       const std::shared_ptr<const echinus::CustomMap>& asked, const echinus::ExactMap& judge,
                       PushCounts& counts);
