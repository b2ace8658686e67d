#include "simulation/surfaces/surface_collision.hpp"

#include "directions/lattice.hpp"
#include "geometry/number_text.hpp"
#include "simulation/collider_now.hpp"
#include "simulation/surfaces/edge_lengths.hpp"

#include <echinus/error.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace echinus {

namespace {

/// Edges and faces lie between vertices: over a model that bulges they are nearer to it than the thickness
/// that the vertices keep, and need not be pushed before they are much nearer.
constexpr float kSurfaceShare = 0.75F;

/// In mean edges. What lies between vertices that keep off farther keeps off as far: edges would never be
/// pushed, and to list what is so far away takes memory without end.
constexpr float kMostThickness = 2;

/// As far as neighbours of neighbours leave room: shares of the mean edge.
constexpr float kMostSelfThickness = 0.25F;
constexpr float kLeastSelfReach = 0.2F;
/// In thicknesses: pairs this near are listed, since a contact is kept ready before it pushes.
constexpr float kSelfReach = 1.3F;

/// A model that is nearer than this share of its reach takes a vertex along as if it were so far.
constexpr float kLeastDistance = 1.0F / 1024;
/// Models pull at what is within so many of their reaches.
constexpr float kPullReach = 4;

/// How much a model takes along what is so far from it. Where pulls are the inverse of the distance, two
/// plates lead all that lies between them by one affine map, under which nothing meets. From half the reach
/// on the pull goes on along the tangent, until it ends.
float pull_at(float distance, float reach) {
    return distance < reach / 2 ? 1 / distance : std::max(4 * (reach - distance) / (reach * reach), 0.0F);
}

/// A vertex that is too fast for what is listed goes its way in several passes.
constexpr int kMostPasses = 8;

/// Pairs that are led on one way may be stuck with others.
constexpr int kMostLeads = 16;

/// No model.
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// In lattice steps: a vertex of the mesh and of the map differ by less than one.
constexpr float kLeastGapSteps = 4;

float largest_coordinate(const PointArrays& positions) {
    float largest = 0;
    for (const std::vector<float>* c : {&positions.x, &positions.y, &positions.z})
        for (const float value : *c) largest = std::max(largest, std::fabs(value));
    return largest;
}

float extent_of(const ColliderNow& now) {
    return now.coordinate_sum + static_cast<float>(kLatticeExtent) * now.step;
}

/// More than what is lost in rounding: beside a model, and of the deformable's own pairs.
float least_gap(const ColliderNow& now, float extent) {
    return kLeastGapSteps * now.step + extent * (1.0F / (1 << 21));
}
float least_gap(float extent) {
    return extent * (1.0F / (1 << 17));
}

/// Layers that could come no nearer to each other than this would hold the deformable where it is.
void require_resolved(float extent, float edge_length) {
    if (!(least_gap(extent) > edge_length / 4)) return;
    throw Error(ErrorCode::InvalidOptions,
                "the deformable begins " + number_text(double{extent}) +
                    " from the origin, where floats tell its layers apart only from " +
                    number_text(double{least_gap(extent)}) + " on, and its mean edge is " +
                    number_text(double{edge_length}) +
                    "; move the scene nearer to the origin, or switch self_collision off");
}

PairReach reach_of(float thickness, float edge_length, float least_gap) {
    const float slack = std::max(edge_length / 8, thickness / 4);
    return {.listed = thickness + edge_length / 4 + 2 * slack, .slack = slack, .least_gap = least_gap};
}

} // namespace

SurfaceCollision::SurfaceCollision(const Deformable& deformable, const std::vector<Collider>& colliders,
                                   const Particles& particles, const SimulationOptions& options)
    : options_(options), elements_(std::make_shared<Elements>(elements_of(deformable))),
      inverse_masses_(deformable.inverse_masses), expected_(particles.positions), goals_(particles.positions),
      is_leaving_(particles.count()), is_truncated_(particles.count()) {
    const float edge_length = mean_edge_length(*elements_, particles.positions);
    for (const Collider& collider : colliders) {
        const std::vector<std::uint8_t> passes = let_through(deformable, models_.size());
        const auto own =
            passes.empty() ? elements_ : std::make_shared<const Elements>(elements_of(deformable, passes));
        const ColliderNow now(collider, collider.pose, options);
        const float most = edge_length > 0 ? kMostThickness * edge_length : now.thickness;
        const float thickness = std::min(kSurfaceShare * now.thickness, most);
        extents_.push_back(extent_of(now));
        const PairReach reach = reach_of(thickness, edge_length, least_gap(now, extents_.back()));
        // A face that is near has a vertex no farther than its edges are long.
        carry_reaches_.push_back(reach.listed + 2 * edge_length);
        models_.emplace_back(collider, own, reach, thickness, now.friction);
    }
    if (options.self_collision) {
        const float thickness =
            std::min(static_cast<float>(options.self_thickness.value_or(*options.thickness)),
                     kMostSelfThickness * edge_length);
        const float near = std::max(kSelfReach * thickness, kLeastSelfReach * edge_length);
        extents_.push_back(largest_coordinate(particles.positions));
        require_resolved(extents_.back(), edge_length);
        self_.emplace(elements_, deformable.tetrahedra, particles,
                      SelfSurface::Reach{near, near / 4, least_gap(extents_.back())}, thickness,
                      static_cast<float>(options.friction));
    }
    leaving_.reserve(particles.count());
    stopped_by_.assign(particles.count(), kNone);
    poses_.resize(models_.size());
    start_poses_.resize(models_.size());
    motions_.resize(models_.size());
    moves_.resize(models_.size());
    is_near_.assign(models_.size(), 1);
    bases_.places.resize(particles.count());
    bases_.bodies.assign(particles.count(), SelfSurface::Bases::kAlone);
    attached_.assign(particles.count(), kNone);
    for (const auto& [particle, collider] : deformable.attachments) attached_[particle] = collider;
    groups_.resize(particles.count());
    clearances_.assign(models_.size(), std::vector<float>(particles.count()));
}

void SurfaceCollision::archive(StateArchive& state) {
    state.array(extents_);
    state.array(is_near_);
    for (ModelSurface& model : models_) model.archive(state);
    if (self_) self_->archive(state);
}

/// What travels far from where it began is rounded more. Least gaps grow in large steps, since all is
/// measured anew then.
void SurfaceCollision::keep_gaps(const std::vector<Collider>& colliders, const Particles& particles) {
    for (std::size_t c = 0; c < models_.size(); ++c) {
        const ColliderNow now(colliders[c], colliders[c].pose, options_);
        if (extent_of(now) <= extents_[c]) continue;
        extents_[c] = 2 * extent_of(now);
        models_[c].keep_gap(least_gap(now, extents_[c]));
    }
    if (!self_) return;
    const float extent = largest_coordinate(particles.positions);
    if (extent <= extents_.back()) return;
    extents_.back() = 2 * extent;
    self_->keep_gap(least_gap(extents_.back()));
}

/// Calls visit(number, model) for the models that are not away.
template <typename Visit>
void SurfaceCollision::for_each_near(const Visit& visit) {
    for (std::size_t c = 0; c < models_.size(); ++c)
        if (is_near_[c] != 0) visit(c, models_[c]);
}

void SurfaceCollision::begin_frame(const std::vector<Collider>& colliders,
                                   std::span<const SurfaceMotion* const> motions,
                                   const Collisions& collisions, const Particles& particles,
                                   const SimulationOptions& options, const Workers& workers) {
    options_ = options;
    keep_gaps(colliders, particles);
    motions_.assign(motions.begin(), motions.end());
    own_frame_ = models_.size();
    for (std::size_t c = 0; c < models_.size(); ++c) {
        moves_[c] = colliders[c].moves() || motions[c] != nullptr ? 1 : 0;
        start_poses_[c] = poses_[c] = colliders[c].pose;
        // Vertices may have left their rooms meanwhile and come back.
        const bool was_away = std::exchange(is_near_[c], collisions.is_away(c) ? 0 : 1) == 0;
        if (is_near_[c] != 0 && was_away) models_[c].reset();
    }
    const auto near_count = std::count(is_near_.begin(), is_near_.end(), std::uint8_t{1});
    for_each_near([&](std::size_t c, ModelSurface& model) {
        if (near_count == 1 && moves_[c] != 0) own_frame_ = c;
        collisions.known_clearances(c, particles, clearances_[c]);
        model.begin_frame(colliders[c], motions[c], particles.positions, clearances_[c], workers);
    });
    find_pulls(colliders, particles);
    if (self_) self_->begin_pass(own_pose(), particles.positions, true);
}

/// Where several models are near and move, a vertex between them is taken along by all of them, the more the
/// nearer they are: what goes straight between two plates that approach each other keeps its share of the
/// room, and so does all that lies between them.
void SurfaceCollision::find_pulls(const std::vector<Collider>& colliders, const Particles& particles) {
    has_pulls_ = std::count(moves_.begin(), moves_.end(), std::uint8_t{1}) != 0 &&
                 std::count(is_near_.begin(), is_near_.end(), std::uint8_t{1}) > 1;
    if (!has_pulls_) return;
    begin_pulls(particles.count());
    for_each_near([&](std::size_t c, ModelSurface&) { find_pulls_of(c, colliders[c], particles); });
}

void SurfaceCollision::begin_pulls(std::size_t particle_count) {
    has_pulls_ = true;
    pull_reach_ = kPullReach * *std::max_element(carry_reaches_.begin(), carry_reaches_.end());
    pulls_.resize(models_.size());
    for (std::vector<float>& pulls : pulls_) pulls.assign(particle_count, 0.0F);
}

/// @param collider  as the frame begins
void SurfaceCollision::find_pulls_of(std::size_t c, const Collider& collider, const Particles& particles) {
    const float reach = pull_reach_;
    beside_.clear();
    places_.clear();
    for (std::uint32_t v = 0; v < particles.count(); ++v) {
        if (clearances_[c][v] > reach) continue;
        beside_.push_back(v);
        places_.push_back(particles.frame_start[v]);
    }
    contacts_.resize(beside_.size());
    contacts_batch(collider, places_, reach, contacts_);
    for (std::size_t n = 0; n < beside_.size(); ++n) {
        if (!contacts_[n].found()) continue;
        const float distance = std::max(std::fabs(contacts_[n].depth), kLeastDistance * reach);
        pulls_[c][beside_[n]] = pull_at(distance, reach);
    }
}

void SurfaceCollision::look_ahead(const std::vector<Collider>& colliders, const Particles& particles,
                                  const Workers& workers) {
    const auto substeps = static_cast<float>(options_.substep_count);
    for (std::size_t i = 0; i < particles.count(); ++i) {
        const Vec3f start = particles.frame_start[i];
        expected_.set(i, start + (particles.positions[i] - start) * substeps);
    }
    RigidTransform own_pose_at_end;
    for_each_near([&](std::size_t c, ModelSurface& model) {
        Collider at_end = colliders[c];
        at_end.pose = pose_after(at_end, options_.time_step);
        if (c == own_frame_) own_pose_at_end = at_end.pose;
        model.look_ahead(at_end, expected_, workers);
    });
    if (self_) self_->look_ahead(own_pose() != nullptr ? &own_pose_at_end : nullptr, expected_, workers);
}

void SurfaceCollision::begin_substep(const std::vector<Collider>& colliders) {
    for_each_near([&](std::size_t c, ModelSurface& model) {
        model.begin_substep(colliders[c], std::exchange(poses_[c], colliders[c].pose),
                            options_.substep_count);
    });
}

void SurfaceCollision::relax(Particles& particles, SimulationProfile& profile, LoadMeter* meter) {
    for_each_near([&](std::size_t c, ModelSurface& model) {
        if (meter != nullptr) meter->note(particles);
        model.relax(particles, inverse_masses_, profile);
        if (meter != nullptr) meter->charge(c, particles);
    });
    if (self_) self_->relax(particles, inverse_masses_, profile);
}

void SurfaceCollision::relax_part(std::span<const std::uint8_t> chosen, Particles& particles,
                                  SimulationProfile& profile, LoadMeter* meter) {
    for_each_near([&](std::size_t c, ModelSurface& model) {
        if (meter != nullptr) meter->note(particles);
        model.relax(particles, inverse_masses_, profile, chosen);
        if (meter != nullptr) meter->charge(c, particles);
    });
}

void SurfaceCollision::meet_late(std::size_t collider, const Collider& at_end, const Particles& particles,
                                 const Workers& workers) {
    is_near_[collider] = 1;
    ModelSurface& model = models_[collider];
    model.reset();
    Collider at_start = at_end;
    at_start.pose = start_poses_[collider];
    model.begin_frame(at_start, motions_[collider], particles.frame_start, {}, workers);
    model.look_ahead(at_end, particles.positions, workers);
    poses_[collider] = at_end.pose;
    if (own_frame_ < models_.size()) return; // another takes along what stays behind
    if (!has_pulls_ && moves_[collider] == 0) return;
    if (!has_pulls_) begin_pulls(particles.count());
    clearances_[collider].assign(particles.count(), 0.0F); // nothing is known
    find_pulls_of(collider, at_start, particles);
}

void SurfaceCollision::end_frame(Particles& particles, SimulationProfile& profile, LoadMeter* meter,
                                 const Workers& workers) {
    if (meter != nullptr) std::fill(stopped_by_.begin(), stopped_by_.end(), kNone);
    goals_ = particles.positions;
    for (int number = 0; number < kMostPasses; ++number) {
        if (number > 0) {
            for_each_near([&](std::size_t, ModelSurface& model) { model.begin_pass(particles.positions); });
            if (self_) self_->begin_pass(own_pose(), particles.positions, false);
        }
        const bool may_go_on = pass(particles, number == 0, workers);
        profile.squeezed_count += std::exchange(squeezed_now_, 0);
        if (!may_go_on) break;
    }
    for (std::uint32_t v = 0; v < particles.count(); ++v) {
        if (std::exchange(is_truncated_[v], 0) == 0) continue;
        ++profile.truncated_count;
        // The velocity is shortened as the way was.
        const Vec3f way = goals_[v] - particles.frame_start[v];
        const Vec3f left = particles.positions[v] - particles.frame_start[v];
        const float way_sq = dot(way, way);
        const float share = way_sq > 0 ? std::clamp(dot(left, way) / way_sq, 0.0F, 1.0F) : 0;
        const Vec3f velocity = goals_[v] - particles.previous[v];
        particles.previous.set(v, particles.positions[v] - velocity * share);
        if (meter != nullptr && stopped_by_[v] != kNone) meter->charge(stopped_by_[v], v, particles);
    }
    profile.searched_face_count = profile.measured_pair_count = 0;
    if (self_) {
        profile.searched_face_count = self_->searched_count;
        profile.measured_pair_count = self_->measured_count;
    }
    for (const ModelSurface& model : models_) {
        profile.searched_face_count += model.pairs().listed_count;
        profile.measured_pair_count += model.pairs().measured_count;
    }
}

/// @return whether another pass may take a vertex farther
bool SurfaceCollision::pass(Particles& particles, bool is_first, const Workers& workers) {
    for_each_near([&](std::size_t, ModelSurface& model) { model.set_goals(goals_); });
    find_leaving(workers);
    ends_ = goals_;
    for (const std::uint32_t v : leaving_) {
        ends_.set(v, find_place(v, is_first, particles, workers));
        is_leaving_[v] = 0;
    }
    if (self_) shorten_ways(is_first, particles, workers);
    bool may_go_on = false;
    for (std::uint32_t v = 0; v < particles.count(); ++v) {
        is_truncated_[v] = ends_[v] == goals_[v] ? 0 : 1;
        may_go_on = may_go_on || is_truncated_[v] != 0;
    }
    particles.positions = ends_;
    return may_go_on;
}

/// So that the deformable does not meet itself. What models allow of a way, they allow of a part of it: the
/// places that they allow are convex.
void SurfaceCollision::shorten_ways(bool is_first, const Particles& particles, const Workers& workers) {
    const bool deforms =
        std::any_of(motions_.begin(), motions_.end(), [](const SurfaceMotion* m) { return m != nullptr; });
    const bool moves = std::count(moves_.begin(), moves_.end(), std::uint8_t{1}) != 0;
    const bool is_one_frame = !is_first || !moves || (own_pose() != nullptr && !deforms);
    if (!is_one_frame)
        for (std::uint32_t v = 0; v < particles.count(); ++v) {
            bases_.places.set(v, base_of(v, is_first, particles, workers));
            bases_.bodies[v] = body_of(v);
        }
    std::span<const float> shares;
    for (int round = 0; round < kMostLeads; ++round) {
        shares = self_->allowed_shares(own_pose(), ends_, is_one_frame ? nullptr : &bases_, workers);
        if (is_one_frame || !is_first || self_->stuck().empty()) break;
        if (round == 0) std::iota(groups_.begin(), groups_.end(), 0U);
        if (!lead_together(self_->stuck(), particles, workers)) break;
    }
    squeezed_now_ += self_->stuck().size();
    if (shares.empty()) return;
    for (std::uint32_t v = 0; v < particles.count(); ++v) {
        if (shares[v] == 1) continue;
        const Vec3f end = ends_[v];
        const Vec3f from = is_one_frame ? base_of(v, is_first, particles, workers) : bases_.places[v];
        ends_.set(v, from + (end - from) * shares[v]);
        // Where one of the models takes a vertex may be none that another allows.
        if (!is_one_frame && !is_permitted(v, ends_[v], true)) ++squeezed_now_;
    }
}

/// The model that takes an attached vertex along, if as one rigid body.
std::uint32_t SurfaceCollision::body_of(std::uint32_t vertex) const {
    const std::uint32_t model = attached_[vertex];
    const bool is_rigid = model != kNone && is_near_[model] != 0 && motions_[model] == nullptr;
    return is_rigid ? model : SelfSurface::Bases::kAlone;
}

float SurfaceCollision::most_pull(std::uint32_t vertex) const {
    float most = 0;
    for (const std::vector<float>& pulls : pulls_)
        if (has_pulls_) most = std::max(most, pulls[vertex]);
    return most;
}

std::uint32_t SurfaceCollision::group_of(std::uint32_t vertex) {
    while (groups_[vertex] != vertex) vertex = groups_[vertex] = groups_[groups_[vertex]];
    return vertex;
}

/// Vertices between models that move are led on different ways, and may meet where they go none of their own.
/// All that hang together by pairs which do, in this round and before, are led on one way then, which all
/// models permit. @return whether some are led anew
bool SurfaceCollision::lead_together(std::span<const std::array<std::uint32_t, 4>> pairs,
                                     const Particles& particles, const Workers& workers) {
    for (const std::array<std::uint32_t, 4>& points : pairs)
        for (const std::uint32_t v : points) groups_[group_of(v)] = group_of(points[0]);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> members; // by group
    for (std::uint32_t v = 0; v < particles.count(); ++v) members.emplace_back(group_of(v), v);
    std::sort(members.begin(), members.end());
    std::vector<std::uint32_t> barred; // groups
    bool is_led = false;
    for (std::size_t first = 0, end = 0; first < members.size(); first = end) {
        while (end < members.size() && members[end].first == members[first].first) ++end;
        if (end - first == 1) continue;
        if (lead_group(std::span(members).subspan(first, end - first), particles, workers))
            is_led = true;
        else
            barred.push_back(members[first].first);
    }
    // What no way leads as a whole may be led pair by pair.
    for (const std::array<std::uint32_t, 4>& points : pairs) {
        if (!std::binary_search(barred.begin(), barred.end(), group_of(points[0]))) continue;
        std::array<std::pair<std::uint32_t, std::uint32_t>, 4> alone;
        for (std::size_t k = 0; k < 4; ++k) alone[k] = {points[0], points[k]};
        is_led = lead_group(alone, particles, workers) || is_led;
    }
    return is_led;
}

/// On the way of one that is pinned and goes it anyway; otherwise on the mean way of the models, on that of
/// one of those that models pull most, or on none.
bool SurfaceCollision::lead_group(std::span<const std::pair<std::uint32_t, std::uint32_t>> members,
                                  const Particles& particles, const Workers& workers) {
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
        lead_on(led, mean_way(members, particles), SelfSurface::Bases::kAlone, particles, workers))
        return true;
    for (std::size_t i = 0; i < std::min(by_pull.size(), kMostTried); ++i) {
        const std::uint32_t v = by_pull[i].second;
        const Vec3f way = bases_.places[v] - particles.frame_start[v];
        if (lead_on(led, way, bases_.bodies[v], particles, workers)) return true;
    }
    return lead_on(led, {}, SelfSurface::Bases::kAlone, particles, workers);
}

/// @param body  that leads them in place of the way: a model, which may turn, or none
/// @return whether all models permit it
bool SurfaceCollision::lead_on(std::span<const std::uint32_t> vertices, const Vec3f& way, std::uint32_t body,
                               const Particles& particles, const Workers& workers) {
    const auto place_of = [&](std::uint32_t v) {
        return body == SelfSurface::Bases::kAlone ? particles.frame_start[v] + way : models_[body].carried(v);
    };
    for (const std::uint32_t v : vertices)
        if (!may_end(v, place_of(v), true, workers)) return false;
    for (const std::uint32_t v : vertices) {
        bases_.places.set(v, place_of(v));
        bases_.bodies[v] = body;
    }
    return true;
}

/// A vertex that leaves its room beside one model is looked at beside all of them.
void SurfaceCollision::find_leaving(const Workers& workers) {
    leaving_.clear();
    const auto add = [&](std::span<const std::uint32_t> vertices) {
        const std::size_t before = leaving_.size();
        for (const std::uint32_t v : vertices)
            if (std::exchange(is_leaving_[v], 1) == 0) leaving_.push_back(v);
        return leaving_.size() > before;
    };
    for (bool found = true; found;) {
        found = false;
        for_each_near(
            [&](std::size_t, ModelSurface& model) { found = add(model.find_leaving(workers)) || found; });
        if (!found || models_.size() == 1) break;
        for (const std::uint32_t v : leaving_)
            for_each_near([&](std::size_t, ModelSurface& model) { model.renew(v, workers); });
    }
}

/// The only model that is near and moves, which takes along what would else stay behind; or none.
const ModelSurface* SurfaceCollision::carrier() const {
    return own_frame_ < models_.size() ? &models_[own_frame_] : nullptr;
}

/// Where a vertex ends that goes none of its way.
Vec3f SurfaceCollision::base_of(std::uint32_t vertex, bool is_first, const Particles& particles,
                                const Workers& workers) {
    if (!is_first) return particles.positions[vertex];
    if (particles.pinned(vertex)) return goals_[vertex]; // nothing holds it back
    if (has_pulls_) return carried_between(vertex, particles, workers);
    return carrier() != nullptr ? carrier()->carried(vertex) : particles.frame_start[vertex];
}

/// The mean of where the models take it. Beside one that it all but touches, a mean may be too coarse; then
/// where it was, or where one of them takes it.
Vec3f SurfaceCollision::carried_between(std::uint32_t vertex, const Particles& particles,
                                        const Workers& workers) {
    const std::pair alone{vertex, vertex};
    const Vec3f start = particles.frame_start[vertex];
    const Vec3f mean = start + mean_way({&alone, 1}, particles);
    if (may_end(vertex, mean, false, workers)) return mean;
    if (may_end(vertex, start, false, workers)) return start;
    for (std::size_t c = 0; c < models_.size(); ++c) {
        if (is_near_[c] == 0 || moves_[c] == 0) continue;
        const Vec3f carried = models_[c].carried(vertex);
        if (may_end(vertex, carried, true, workers)) return carried;
    }
    return mean;
}

/// @param is_carried  there by one of the models
bool SurfaceCollision::is_permitted(std::uint32_t vertex, const Vec3f& place, bool is_carried) const {
    for (std::size_t c = 0; c < models_.size(); ++c)
        if (is_near_[c] != 0 && !models_[c].permits(vertex, place, is_carried)) return false;
    return true;
}

/// The same, after a closer look where little is known of what is around.
bool SurfaceCollision::may_end(std::uint32_t vertex, const Vec3f& place, bool is_carried,
                               const Workers& workers) {
    if (is_permitted(vertex, place, is_carried)) return true;
    bool is_renewed = false;
    for_each_near(
        [&](std::size_t, ModelSurface& model) { is_renewed = model.renew(vertex, workers) || is_renewed; });
    return is_renewed && is_permitted(vertex, place, is_carried);
}

/// On which models take along one vertex, or several as one that is as near to each model as any of them.
Vec3f SurfaceCollision::mean_way(std::span<const std::pair<std::uint32_t, std::uint32_t>> members,
                                 const Particles& particles) const {
    float sum = 0;
    Vec3f way;
    for (std::size_t c = 0; c < models_.size(); ++c) {
        if (is_near_[c] == 0) continue;
        const auto& pulls = pulls_[c];
        const auto pulls_less = [&](const auto& a, const auto& b) {
            return pulls[a.second] < pulls[b.second];
        };
        const std::uint32_t nearest = std::max_element(members.begin(), members.end(), pulls_less)->second;
        if (!(pulls[nearest] > 0)) continue;
        sum += pulls[nearest];
        if (moves_[c] != 0)
            way += (models_[c].carried(nearest) - particles.frame_start[nearest]) * pulls[nearest];
    }
    return way * (1 / std::max(sum, pull_at(pull_reach_ / 2, pull_reach_)));
}

Vec3f SurfaceCollision::find_place(std::uint32_t vertex, bool is_first, const Particles& particles,
                                   const Workers& workers) {
    const Vec3f goal = goals_[vertex];
    if (particles.pinned(vertex)) {
        ++squeezed_now_;
        return goal;
    }
    const ModelSurface* only = is_first ? carrier() : nullptr;
    const Vec3f from = base_of(vertex, is_first, particles, workers);
    Shares shares;
    for_each_near([&](std::size_t c, ModelSurface& model) {
        const float most = shares.most;
        shares.keep(model.allowed(vertex, &model == only ? nullptr : &from));
        if (shares.most < most || shares.none()) stopped_by_[vertex] = static_cast<std::uint32_t>(c);
    });
    if (shares.none()) ++squeezed_now_;
    const float share = shares.none() ? 0 : std::max(shares.most, 0.0F);
    if (share == 1) return goal;
    return only != nullptr ? only->place_at(share, vertex) : from + (goal - from) * share;
}

} // namespace echinus
