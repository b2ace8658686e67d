#include "simulation/load_meter.hpp"

#include <algorithm>

namespace echinus {

namespace {

/// The collider to which all pinned particles are attached, if there is one.
std::optional<std::size_t> holder_of(const Deformable& deformable) {
    const auto pinned = std::count(deformable.inverse_masses.begin(), deformable.inverse_masses.end(), 0.0F);
    if (pinned == 0 || static_cast<std::size_t>(pinned) != deformable.attachments.size()) return std::nullopt;
    const std::uint32_t first = deformable.attachments.front().collider;
    const bool is_one = std::all_of(deformable.attachments.begin(), deformable.attachments.end(),
                                    [&](const Attachment& a) { return a.collider == first; });
    return is_one ? std::optional<std::size_t>(first) : std::nullopt;
}

} // namespace

LoadMeter::LoadMeter(const Deformable& deformable, std::size_t collider_count)
    : holder_(holder_of(deformable)), centres_(collider_count), sums_(collider_count) {
    for (const float inverse_mass : deformable.inverse_masses)
        masses_.push_back(inverse_mass > 0 ? 1 / double{inverse_mass} : 0);
    noted_.resize(masses_.size());
}

void LoadMeter::begin_frame(const std::vector<Collider>& colliders) {
    for (std::size_t c = 0; c < colliders.size(); ++c) centres_[c] = colliders[c].pose.translation;
    std::fill(sums_.begin(), sums_.end(), Sum{});
}

void LoadMeter::note(const Particles& particles) {
    for (std::size_t i = 0; i < masses_.size(); ++i) noted_.set(i, particles.step(i));
}

void LoadMeter::charge(std::size_t collider, const Particles& particles) {
    for (std::uint32_t i = 0; i < masses_.size(); ++i) charge(collider, i, particles);
}

void LoadMeter::charge(std::size_t collider, std::uint32_t i, const Particles& particles) {
    const Vec3f change = particles.step(i) - noted_[i];
    if (change == Vec3f{} || masses_[i] == 0) return;
    const Vec3d given = Vec3d(change) * masses_[i];
    sums_[collider].motion += given;
    sums_[collider].moment += cross(Vec3d(particles.positions[i]) - centres_[collider], given);
}

void LoadMeter::archive(StateArchive& state) {
    for (Sum& sum : sums_) {
        state.value(sum.motion);
        state.value(sum.moment);
    }
}

Load LoadMeter::load_on(std::size_t collider, double time_step, double substep_seconds) const {
    const double scale = -1 / (time_step * substep_seconds);
    return {sums_[collider].motion * scale, sums_[collider].moment * scale};
}

} // namespace echinus
