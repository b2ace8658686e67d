#include "simulation/frame_parts.hpp"

#include "simulation/surfaces/edge_lengths.hpp"
#include "simulation/surfaces/elements.hpp"

#include <algorithm>
#include <cmath>

namespace echinus {

namespace {

/// In mean edges.
constexpr double kMostWay = 1;

/// A model that moves takes along what goes farther than is listed beside it, half a mean edge; and what it
/// pushes against another model is caught between both from half as far on.
constexpr double kBesideWhatMoves = 4;

/// However fast they are.
constexpr double kMostParts = 32;

} // namespace

FrameParts::FrameParts(const Deformable& deformable, const SimulationOptions& options)
    : options_(options),
      edge_length_(double{mean_edge_length(elements_of(deformable), deformable.positions)}),
      clearances_(deformable.particle_count()) {
    places_.reserve(deformable.particle_count());
    ways_.reserve(deformable.particle_count());
    contacts_.reserve(deformable.particle_count());
}

std::uint32_t FrameParts::count(const std::vector<Collider>& colliders, const Collisions& collisions,
                                const Particles& particles) {
    const double most = kMostWay * edge_length_;
    if (!(most > 0)) return 1;
    const double longest_of_all = longest_less({}, particles);
    double longest = longest_less(mean_way(particles), particles);
    for (std::size_t c = 0; c < colliders.size(); ++c) {
        if (collisions.is_away(c) || (!colliders[c].moves() && longest_of_all <= most)) continue;
        collisions.known_clearances(c, particles, clearances_);
        const double weight = colliders[c].moves() ? kBesideWhatMoves : 1;
        longest = std::max(longest, weight * longest_beside(colliders[c], most / weight, particles));
    }
    if (longest <= most) return 1;
    auto count = static_cast<std::uint32_t>(std::ceil(std::min(longest / most, kMostParts)));
    if (options_.solver == SolverKind::Verlet) return count;
    // The stiffness of springs counts on the length of a substep: parts have whole ones.
    count = std::min(count, options_.substep_count);
    while (options_.substep_count % count != 0) ++count;
    return count;
}

SimulationOptions FrameParts::options_of_part(std::uint32_t count) const {
    SimulationOptions part = options_;
    part.time_step /= count;
    if (part.solver != SolverKind::Verlet) part.substep_count /= count;
    return part;
}

/// Of a substep.
Vec3f FrameParts::mean_way(const Particles& particles) const {
    Vec3d sum;
    for (std::size_t i = 0; i < particles.count(); ++i) sum += Vec3d(particles.step(i));
    return Vec3f(sum * (1 / static_cast<double>(particles.count())));
}

/// The longest way of a frame, less one in each substep that all have in common.
double FrameParts::longest_less(const Vec3f& common, const Particles& particles) const {
    float longest_sq = 0;
    for (std::size_t i = 0; i < particles.count(); ++i) {
        const Vec3f way = particles.step(i) - common;
        longest_sq = std::max(longest_sq, dot(way, way));
    }
    return std::sqrt(double{longest_sq}) * options_.substep_count;
}

/// The longest of the ways that reach the model, or bring an element between vertices there, relative to it,
/// or 0 if it is not longer than most. The known clearances tell of most vertices that they do not.
double FrameParts::longest_beside(const Collider& collider, double most, const Particles& particles) {
    places_.clear();
    ways_.clear();
    for (std::size_t i = 0; i < particles.count(); ++i) {
        const Vec3d place(particles.positions[i]);
        const Vec3d speed =
            collider.linear_velocity + cross(collider.angular_velocity, place - collider.pose.translation);
        const double way =
            length(Vec3d(particles.step(i)) * options_.substep_count - speed * options_.time_step);
        if (!(way > std::max(most, double{clearances_[i]} - edge_length_))) continue;
        places_.push_back(particles.positions[i]);
        ways_.push_back(static_cast<float>(way));
    }
    if (places_.empty()) return 0;
    contacts_.resize(places_.size());
    const auto edge = static_cast<float>(edge_length_);
    contacts_batch(collider, places_, *std::max_element(ways_.begin(), ways_.end()) + edge, contacts_);
    float longest = 0;
    for (std::size_t n = 0; n < places_.size(); ++n)
        if (contacts_[n].found() && std::fabs(contacts_[n].depth) < ways_[n] + edge)
            longest = std::max(longest, ways_[n]);
    return double{longest};
}

} // namespace echinus
