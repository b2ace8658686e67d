#include "simulation/free_places.hpp"

#include <utility>

namespace echinus {

FreePlaces::FreePlaces(const ColliderNow& collider, const Particles& particles)
    : frame_start_(collider.local), states_(particles.count(), State::FrameStart), stored_(particles.count()),
      lost_(particles.count(), 0) {
    exceptions_.reserve(particles.count());
    for (std::uint32_t i = 0; i < particles.count(); ++i) {
        if (collider.outside(particles.positions[i])) continue;
        states_[i] = State::Never;
        exceptions_.push_back(i);
    }
}

void FreePlaces::begin_frame(const Collider& collider) {
    frame_start_ = FrameChange(collider);
}

bool FreePlaces::mark_lost(std::size_t i) {
    if (lost_[i] != 0) return false;
    lost_[i] = 1;
    if (states_[i] == State::FrameStart) exceptions_.push_back(static_cast<std::uint32_t>(i));
    return true;
}

void FreePlaces::end_frame(const ColliderNow& collider, const Particles& particles, bool want_back) {
    const auto is_free_now = [&](std::uint32_t i) {
        const bool lost = std::exchange(lost_[i], std::uint8_t{0}) != 0;
        if (!lost && has(i)) return true;
        if ((!lost || !want_back) && collider.outside(particles.positions[i])) return true;
        if (!has(i)) return false;
        stored_[i] = local(i, particles);
        states_[i] = State::Stored;
        return false;
    };
    std::erase_if(exceptions_, [&](std::uint32_t i) {
        const bool free = is_free_now(i);
        if (free) states_[i] = State::FrameStart;
        return free;
    });
}

} // namespace echinus
