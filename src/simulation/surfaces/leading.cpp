#include "simulation/surfaces/leading.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace echinus {

namespace {

/// A model that is nearer than this share of its reach takes a vertex along as if it were so far.
constexpr float kLeastDistance = 1.0F / 1024;
/// Models pull at what is within so many of their reaches.
constexpr float kPullReach = 4;

constexpr std::uint32_t kAlone = SelfSurface::Bases::kAlone;

/// How much a model takes along what is so far from it. Where pulls are the inverse of the distance, two
/// plates lead all that lies between them by one affine map, under which nothing meets. From half the reach
/// on the pull goes on along the tangent, until it ends.
float pull_at(float distance, float reach) {
    return distance < reach / 2 ? 1 / distance : std::max(4 * (reach - distance) / (reach * reach), 0.0F);
}

} // namespace

Leading::Leading(const Deformable& deformable, std::span<const float> carry_reaches)
    : attached_(deformable.particle_count(), kAlone), groups_(deformable.particle_count()),
      pull_reach_(carry_reaches.empty()
                      ? 0
                      : kPullReach * *std::max_element(carry_reaches.begin(), carry_reaches.end())) {
    bases_.places.resize(deformable.particle_count());
    bases_.bodies.assign(deformable.particle_count(), kAlone);
    for (const auto& [particle, collider] : deformable.attachments) attached_[particle] = collider;
}

void Leading::begin_frame(NearModels& models, const std::vector<Collider>& colliders,
                          std::span<const std::vector<float>> clearances, const Particles& particles) {
    has_pulls_ = false;
    if (!models.any_moves() || models.near_count() < 2) return;
    begin_pulls(models.count(), particles.count());
    models.for_each_near(
        [&](std::size_t c, ModelSurface&) { find_pulls(c, colliders[c], clearances[c], particles); });
}

void Leading::meet_late(std::size_t model, const Collider& at_start, const NearModels& models,
                        const Particles& particles) {
    if (!has_pulls_ && models.moves[model] == 0) return;
    if (!has_pulls_) begin_pulls(models.count(), particles.count());
    find_pulls(model, at_start, {}, particles);
}

void Leading::begin_pulls(std::size_t model_count, std::size_t particle_count) {
    has_pulls_ = true;
    pulls_.resize(model_count);
    for (std::vector<float>& pulls : pulls_) pulls.assign(particle_count, 0.0F);
}

/// @param collider    as the frame begins
/// @param clearances  by vertex, or none
void Leading::find_pulls(std::size_t model, const Collider& collider, std::span<const float> clearances,
                         const Particles& particles) {
    beside_.clear();
    places_.clear();
    for (std::uint32_t v = 0; v < particles.count(); ++v) {
        if (!clearances.empty() && clearances[v] > pull_reach_) continue;
        beside_.push_back(v);
        places_.push_back(particles.frame_start[v]);
    }
    contacts_.resize(beside_.size());
    contacts_batch(collider, places_, pull_reach_, contacts_);
    for (std::size_t n = 0; n < beside_.size(); ++n) {
        if (!contacts_[n].found()) continue;
        const float distance = std::max(std::fabs(contacts_[n].depth), kLeastDistance * pull_reach_);
        pulls_[model][beside_[n]] = pull_at(distance, pull_reach_);
    }
}

float Leading::most_pull(std::uint32_t vertex) const {
    float most = 0;
    for (const std::vector<float>& pulls : pulls_)
        if (has_pulls_) most = std::max(most, pulls[vertex]);
    return most;
}

/// On which models take along one vertex, or several as one that is as near to each model as any of them.
Vec3f Leading::mean_way(std::span<const Member> members, const NearModels& models,
                        const Particles& particles) const {
    float sum = 0;
    Vec3f way;
    for (std::size_t c = 0; c < models.count(); ++c) {
        if (models.is_near[c] == 0) continue;
        const auto& pulls = pulls_[c];
        const auto pulls_less = [&](const Member& a, const Member& b) {
            return pulls[a.second] < pulls[b.second];
        };
        const std::uint32_t nearest = std::max_element(members.begin(), members.end(), pulls_less)->second;
        if (!(pulls[nearest] > 0)) continue;
        sum += pulls[nearest];
        if (models.moves[c] != 0)
            way += (models.all[c].carried(nearest) - particles.frame_start[nearest]) * pulls[nearest];
    }
    return way * (1 / std::max(sum, pull_at(pull_reach_ / 2, pull_reach_)));
}

/// The mean of where the models take it. Beside one that it all but touches, a mean may be too coarse; then
/// where it was, or where one of them takes it.
Vec3f Leading::carried_between(std::uint32_t vertex, NearModels& models, const Particles& particles,
                               const Workers& workers) const {
    const Member alone{vertex, vertex};
    const Vec3f start = particles.frame_start[vertex];
    const Vec3f mean = start + mean_way({&alone, 1}, models, particles);
    if (models.permit_after_a_look(vertex, mean, false, workers)) return mean;
    if (models.permit_after_a_look(vertex, start, false, workers)) return start;
    for (std::size_t c = 0; c < models.count(); ++c) {
        if (models.is_near[c] == 0 || models.moves[c] == 0) continue;
        const Vec3f carried = models.all[c].carried(vertex);
        if (models.permit_after_a_look(vertex, carried, true, workers)) return carried;
    }
    return mean;
}

SelfSurface::Bases& Leading::begin(const NearModels& models) {
    has_groups_ = false;
    for (std::uint32_t v = 0; v < attached_.size(); ++v) bases_.bodies[v] = body_of(v, models);
    return bases_;
}

/// The model that takes an attached vertex along, if as one rigid body.
std::uint32_t Leading::body_of(std::uint32_t vertex, const NearModels& models) const {
    const std::uint32_t model = attached_[vertex];
    const bool is_rigid = model != kAlone && models.is_near[model] != 0 && models.motions[model] == nullptr;
    return is_rigid ? model : kAlone;
}

std::uint32_t Leading::group_of(std::uint32_t vertex) {
    while (groups_[vertex] != vertex) vertex = groups_[vertex] = groups_[groups_[vertex]];
    return vertex;
}

bool Leading::lead_together(std::span<const std::array<std::uint32_t, 4>> pairs, NearModels& models,
                            const Particles& particles, const Workers& workers) {
    if (!std::exchange(has_groups_, true)) std::iota(groups_.begin(), groups_.end(), 0U);
    for (const std::array<std::uint32_t, 4>& points : pairs)
        for (const std::uint32_t v : points) groups_[group_of(v)] = group_of(points[0]);
    std::vector<Member> members; // by group
    for (std::uint32_t v = 0; v < particles.count(); ++v) members.emplace_back(group_of(v), v);
    std::sort(members.begin(), members.end());
    std::vector<std::uint32_t> barred; // groups
    bool is_led = false;
    for (std::size_t first = 0, end = 0; first < members.size(); first = end) {
        while (end < members.size() && members[end].first == members[first].first) ++end;
        if (end - first == 1) continue;
        if (lead_group(std::span(members).subspan(first, end - first), models, particles, workers))
            is_led = true;
        else
            barred.push_back(members[first].first);
    }
    // What no way leads as a whole may be led pair by pair.
    for (const std::array<std::uint32_t, 4>& points : pairs) {
        if (!std::binary_search(barred.begin(), barred.end(), group_of(points[0]))) continue;
        std::array<Member, 4> alone;
        for (std::size_t k = 0; k < 4; ++k) alone[k] = {points[0], points[k]};
        is_led = lead_group(alone, models, particles, workers) || is_led;
    }
    return is_led;
}

/// On the way of one that is pinned and goes it anyway; otherwise on the mean way of the models, on that of
/// one of those that models pull most, or on none.
bool Leading::lead_group(std::span<const Member> members, NearModels& models, const Particles& particles,
                         const Workers& workers) {
    constexpr std::size_t kMostTried = 8;
    // What is pinned first, then what is pulled most, then by number.
    std::vector<std::pair<float, std::uint32_t>> by_pull;
    std::vector<std::uint32_t> led;
    for (const auto& [group, v] : members) {
        const bool is_pinned = particles.pinned(v);
        by_pull.emplace_back(is_pinned ? -std::numeric_limits<float>::infinity() : -most_pull(v), v);
        if (!is_pinned) led.push_back(v);
    }
    std::sort(by_pull.begin(), by_pull.end());
    const bool has_pinned = led.size() < members.size();
    if (!has_pinned && has_pulls_ &&
        lead_on(led, mean_way(members, models, particles), kAlone, models, particles, workers))
        return true;
    for (std::size_t i = 0; i < std::min(by_pull.size(), kMostTried); ++i) {
        const std::uint32_t v = by_pull[i].second;
        const Vec3f way = bases_.places[v] - particles.frame_start[v];
        const std::uint32_t body = bases_.bodies[v] < models.count() ? bases_.bodies[v] : kAlone;
        if (lead_on(led, way, body, models, particles, workers)) return true;
    }
    return lead_on(led, {}, kAlone, models, particles, workers);
}

/// @param body  that leads them in place of the way: a model, which may turn, or none
/// @return whether all models permit it
bool Leading::lead_on(std::span<const std::uint32_t> vertices, const Vec3f& way, std::uint32_t body,
                      NearModels& models, const Particles& particles, const Workers& workers) {
    const auto place_of = [&](std::uint32_t v) {
        return body == kAlone ? particles.frame_start[v] + way : models.all[body].carried(v);
    };
    for (const std::uint32_t v : vertices)
        if (!models.permit_after_a_look(v, place_of(v), true, workers)) return false;
    for (const std::uint32_t v : vertices) {
        bases_.places.set(v, place_of(v));
        bases_.bodies[v] = body;
    }
    return true;
}

} // namespace echinus
