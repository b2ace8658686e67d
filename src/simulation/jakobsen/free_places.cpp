#include "simulation/jakobsen/free_places.hpp"

namespace echinus {

FreePlaces::FreePlaces(const ColliderNow& collider, const Particles& particles,
                       std::span<const std::uint8_t> passes)
    : frame_start_(collider.local), states_(particles.count(), State::FrameStart), stored_(particles.count()),
      lost_(particles.count(), 0) {
    exceptions_.reserve(particles.count());
    for (std::uint32_t i = 0; i < particles.count(); ++i) {
        const bool is_let_through = !passes.empty() && passes[i] != 0;
        if (is_let_through || collider.outside(particles.positions[i])) continue;
        states_[i] = State::Never;
        exceptions_.push_back(i);
    }
}

void FreePlaces::restart(std::span<const std::uint32_t> restarted, const ColliderNow& collider,
                         const Particles& particles) {
    if (restarted.empty()) return;
    for (const std::uint32_t i : restarted)
        states_[i] = collider.outside(particles.frame_start[i]) ? State::FrameStart : State::Never;
    exceptions_.clear();
    for (std::uint32_t i = 0; i < states_.size(); ++i)
        if (states_[i] != State::FrameStart) exceptions_.push_back(i);
}

bool FreePlaces::mark_lost(std::size_t i) {
    if (lost_[i] != 0) return false;
    lost_[i] = 1;
    if (states_[i] == State::FrameStart) exceptions_.push_back(static_cast<std::uint32_t>(i));
    return true;
}

bool FreePlaces::is_free_now(std::uint32_t i, const ColliderNow& collider, const Particles& particles,
                             bool wanted_back) const {
    const bool lost = lost_[i] != 0;
    if (has(i) && !lost) return true;
    if (lost && wanted_back) return false;
    return collider.outside(particles.positions[i]);
}

void FreePlaces::end_frame(const ColliderNow& collider, const Particles& particles, bool wanted_back) {
    std::erase_if(exceptions_, [&](std::uint32_t i) {
        const bool free = is_free_now(i, collider, particles, wanted_back);
        if (!free && has(i)) {
            stored_[i] = local(i, particles);
            states_[i] = State::Stored;
        }
        if (free) states_[i] = State::FrameStart;
        lost_[i] = 0;
        return free;
    });
}

void FreePlaces::archive(StateArchive& state) {
    for (State& of_particle : states_) state.choice(of_particle, State::Never);
    for (Vec3f& place : stored_) {
        state.value(place);
        state.require(is_finite(place));
    }
    state.array(lost_);
    state.indices(exceptions_, states_.size(), states_.size());
}

} // namespace echinus
