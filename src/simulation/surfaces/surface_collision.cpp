#include "simulation/surfaces/surface_collision.hpp"

#include "directions/lattice.hpp"
#include "files/text.hpp"
#include "simulation/collider_now.hpp"
#include "simulation/surfaces/edge_lengths.hpp"

#include <echinus/error.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
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
      common_motion_(deformable), inverse_masses_(deformable.inverse_masses), expected_(particles.positions),
      goals_(particles.positions), common_displacements_(particles.positions), is_leaving_(particles.count()),
      is_truncated_(particles.count()) {
    const float edge_length = mean_edge_length(*elements_, particles.positions);
    for (const Collider& collider : colliders) {
        const std::vector<std::uint8_t> passes = let_through(deformable, models_.count());
        const auto own =
            passes.empty() ? elements_ : std::make_shared<const Elements>(elements_of(deformable, passes));
        const ColliderNow now(collider, collider.pose, options);
        const float most = edge_length > 0 ? kMostThickness * edge_length : now.thickness;
        const float thickness = std::min(kSurfaceShare * now.thickness, most);
        extents_.push_back(extent_of(now));
        const PairReach reach = reach_of(thickness, edge_length, least_gap(now, extents_.back()));
        // A face that is near has a vertex no farther than its edges are long.
        carry_reaches_.push_back(reach.listed + 2 * edge_length);
        models_.add(ModelSurface(collider, own, reach, thickness, now.friction));
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
    poses_.resize(models_.count());
    start_poses_.resize(models_.count());
    leading_.emplace(deformable, carry_reaches_);
    clearances_.assign(models_.count(), std::vector<float>(particles.count()));
}

void SurfaceCollision::archive(StateArchive& state) {
    state.array(extents_);
    state.array(models_.is_near);
    for (ModelSurface& model : models_.all) model.archive(state);
    if (self_) self_->archive(state);
}

/// What travels far from where it began is rounded more. Least gaps grow in large steps, since all is
/// measured anew then.
void SurfaceCollision::keep_gaps(const std::vector<Collider>& colliders, const Particles& particles) {
    for (std::size_t c = 0; c < models_.count(); ++c) {
        const ColliderNow now(colliders[c], colliders[c].pose, options_);
        if (extent_of(now) <= extents_[c]) continue;
        extents_[c] = 2 * extent_of(now);
        models_.all[c].keep_gap(least_gap(now, extents_[c]));
    }
    if (!self_) return;
    const float extent = largest_coordinate(particles.positions);
    if (extent <= extents_.back()) return;
    extents_.back() = 2 * extent;
    self_->keep_gap(least_gap(extents_.back()));
}

void SurfaceCollision::begin_frame(const std::vector<Collider>& colliders,
                                   std::span<const SurfaceMotion* const> motions,
                                   const Collisions& collisions, const Particles& particles,
                                   const SimulationOptions& options, const Workers& workers) {
    options_ = options;
    keep_gaps(colliders, particles);
    models_.motions.assign(motions.begin(), motions.end());
    own_frame_ = models_.count();
    for (std::size_t c = 0; c < models_.count(); ++c) {
        models_.moves[c] = colliders[c].moves() || motions[c] != nullptr ? 1 : 0;
        start_poses_[c] = poses_[c] = colliders[c].pose;
        // Vertices may have left their rooms meanwhile and come back.
        const bool was_away = std::exchange(models_.is_near[c], collisions.is_away(c) ? 0 : 1) == 0;
        if (models_.is_near[c] != 0 && was_away) models_.all[c].reset();
    }
    const std::size_t near_count = models_.near_count();
    models_.for_each_near([&](std::size_t c, ModelSurface& model) {
        if (near_count == 1 && models_.moves[c] != 0) own_frame_ = c;
        collisions.known_clearances(c, particles, clearances_[c]);
        model.begin_frame(colliders[c], motions[c], particles.positions, clearances_[c], workers);
    });
    leading_->begin_frame(models_, colliders, clearances_, particles);
    if (self_) self_->begin_pass(own_pose(), particles.positions, true);
}

void SurfaceCollision::look_ahead(const std::vector<Collider>& colliders, const Particles& particles,
                                  const Workers& workers) {
    const auto substeps = static_cast<float>(options_.substep_count);
    for (std::size_t i = 0; i < particles.count(); ++i) {
        const Vec3f start = particles.frame_start[i];
        expected_.set(i, start + (particles.positions[i] - start) * substeps);
    }
    RigidTransform own_pose_at_end;
    models_.for_each_near([&](std::size_t c, ModelSurface& model) {
        Collider at_end = colliders[c];
        at_end.pose = pose_after(at_end, options_.time_step);
        if (c == own_frame_) own_pose_at_end = at_end.pose;
        model.look_ahead(at_end, expected_, workers);
    });
    if (self_) self_->look_ahead(own_pose() != nullptr ? &own_pose_at_end : nullptr, expected_, workers);
}

void SurfaceCollision::begin_substep(const std::vector<Collider>& colliders) {
    models_.for_each_near([&](std::size_t c, ModelSurface& model) {
        model.begin_substep(colliders[c], std::exchange(poses_[c], colliders[c].pose),
                            options_.substep_count);
    });
}

void SurfaceCollision::relax(Particles& particles, SimulationProfile& profile, LoadMeter* meter) {
    models_.for_each_near([&](std::size_t c, ModelSurface& model) {
        if (meter != nullptr) meter->note(particles);
        model.relax(particles, inverse_masses_, profile);
        if (meter != nullptr) meter->charge(c, particles);
    });
    if (self_) self_->relax(particles, inverse_masses_, profile);
}

void SurfaceCollision::relax_part(std::span<const std::uint8_t> chosen, Particles& particles,
                                  SimulationProfile& profile, LoadMeter* meter) {
    models_.for_each_near([&](std::size_t c, ModelSurface& model) {
        if (meter != nullptr) meter->note(particles);
        model.relax(particles, inverse_masses_, profile, chosen);
        if (meter != nullptr) meter->charge(c, particles);
    });
}

void SurfaceCollision::meet_late(std::size_t collider, const Collider& at_end, const Particles& particles,
                                 const Workers& workers) {
    models_.is_near[collider] = 1;
    ModelSurface& model = models_.all[collider];
    model.reset();
    Collider at_start = at_end;
    at_start.pose = start_poses_[collider];
    model.begin_frame(at_start, models_.motions[collider], particles.frame_start, {}, workers);
    model.look_ahead(at_end, particles.positions, workers);
    poses_[collider] = at_end.pose;
    if (own_frame_ < models_.count()) return; // another takes along what stays behind
    leading_->meet_late(collider, at_start, models_, particles);
}

void SurfaceCollision::end_frame(Particles& particles, SimulationProfile& profile, LoadMeter* meter,
                                 const Workers& workers) {
    if (meter != nullptr) std::fill(stopped_by_.begin(), stopped_by_.end(), kNone);
    goals_ = particles.positions;
    common_displacements_.fill(0);
    goes_along_.assign(particles.count(), 0);
    for (int number = 0; number < kMostPasses; ++number) {
        if (number > 0) {
            models_.for_each_near(
                [&](std::size_t, ModelSurface& model) { model.begin_pass(particles.positions); });
            if (self_) self_->begin_pass(own_pose(), particles.positions, false);
        }
        const bool may_go_on = pass(particles, number == 0, workers);
        profile.squeezed_count += std::exchange(squeezed_now_, 0);
        if (!may_go_on) break;
    }
    shorten_velocities(particles, profile, meter);
    profile.searched_face_count = profile.measured_pair_count = 0;
    if (self_) {
        profile.searched_face_count = self_->searched_count;
        profile.measured_pair_count = self_->measured_count;
    }
    for (const ModelSurface& model : models_.all) {
        profile.searched_face_count += model.pairs().listed_count;
        profile.measured_pair_count += model.pairs().measured_count;
    }
}

/// Each is shortened as the path was, both relative to the common motion of the piece. Layers of a piece that
/// no model reaches hold only each other back: all of it shares the momentum that they lose, which otherwise
/// the model bears.
void SurfaceCollision::shorten_velocities(Particles& particles, SimulationProfile& profile,
                                          LoadMeter* meter) {
    if (std::find(is_truncated_.begin(), is_truncated_.end(), std::uint8_t{1}) == is_truncated_.end()) return;
    common_motion_.begin_losses();
    models_.for_each_near([&](std::size_t, ModelSurface& model) {
        for (std::uint32_t v = 0; v < particles.count(); ++v)
            if (model.pairs().lists_any(v)) goes_along_[common_motion_.piece_of(v)] = 0;
    });
    for (std::uint32_t v = 0; v < particles.count(); ++v) {
        if (std::exchange(is_truncated_[v], 0) == 0) continue;
        ++profile.truncated_count;
        const Vec3f from = particles.frame_start[v] + common_displacements_[v];
        const Vec3f way = goals_[v] - from;
        const Vec3f left = particles.positions[v] - from;
        const float way_sq = dot(way, way);
        const float share = way_sq > 0 ? std::clamp(dot(left, way) / way_sq, 0.0F, 1.0F) : 0;
        const Vec3f common = common_displacements_[v] * (1 / static_cast<float>(options_.substep_count));
        const Vec3f velocity = (goals_[v] - particles.previous[v]) +
                               (particles.remainders[v] - particles.previous_remainders[v]);
        const Vec3f left_velocity = common + (velocity - common) * share;
        particles.put(v, {particles.positions[v], left_velocity});
        if (goes_along(v)) common_motion_.lose(v, velocity - left_velocity);
        if (meter != nullptr && stopped_by_[v] != kNone) meter->charge(stopped_by_[v], v, particles);
    }
    for (std::uint32_t v = 0; v < particles.count(); ++v) {
        const Vec3f given_back = common_motion_.loss_of(v);
        if (given_back == Vec3f{} || particles.pinned(v)) continue;
        particles.put(v, {particles.positions[v], particles.step(v) + given_back});
    }
}

/// @return whether another pass may take a vertex farther
bool SurfaceCollision::pass(Particles& particles, bool is_first, const Workers& workers) {
    leaving_.clear();
    find_leaving(goals_, workers);
    ends_ = goals_;
    for (const std::uint32_t v : leaving_) ends_.set(v, find_place(v, is_first, particles, workers));
    if (self_) shorten_ways(is_first, particles, workers);
    for (const std::uint32_t v : leaving_) is_leaving_[v] = 0;
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
    if (!self_->may_meet(own_pose(), ends_, workers)) return;
    SelfSurface::Bases& bases = leading_->begin(models_);
    if (is_first) common_motion_.measure(particles, goals_);
    std::span<const float> shares;
    do {
        find_bases(bases, is_first, particles, workers);
        shares = self_->allowed_shares(own_pose(), bases, workers);
    } while (join_stuck_pieces());
    const bool is_one_frame = !is_first || has_one_frame();
    for (int round = 1; round < kMostLeads && !is_one_frame && !self_->stuck().empty(); ++round) {
        if (!leading_->lead_together(self_->stuck(), models_, particles, workers)) break;
        shares = self_->allowed_shares(own_pose(), bases, workers);
    }
    squeezed_now_ += self_->stuck().size();
    for (std::uint32_t v = 0; v < particles.count(); ++v) {
        if (shares[v] == 1) continue;
        const Vec3f from = bases.places[v], end = ends_[v];
        ends_.set(v, from + (end - from) * shares[v]);
        if (is_first && goes_along(v)) common_displacements_.set(v, from - particles.frame_start[v]);
        // Where one of the models takes a vertex may be none that another allows.
        if (!is_one_frame && !models_.permit(v, ends_[v], true)) ++squeezed_now_;
    }
}

/// Is there a frame in which all models that are near rest?
bool SurfaceCollision::has_one_frame() const {
    return !models_.any_moves() || (own_pose() != nullptr && !models_.any_deforms());
}

/// Where vertices end that go none of their way: along with their piece if the models permit that to all of
/// it, otherwise where models take each of them along, which is nowhere in one frame of all models.
void SurfaceCollision::find_bases(SelfSurface::Bases& bases, bool is_first, const Particles& particles,
                                  const Workers& workers) {
    if (is_first) find_common_motion(bases.places, particles, workers);
    const bool is_one_frame = !is_first || has_one_frame();
    for (std::uint32_t v = 0; v < particles.count(); ++v) {
        if (is_first && goes_along(v)) {
            bases.bodies[v] = static_cast<std::uint32_t>(models_.count()) + common_motion_.piece_of(v);
        } else {
            bases.places.set(v, base_of(v, is_first, particles, workers));
            if (is_one_frame && !particles.pinned(v)) bases.bodies[v] = SelfSurface::Bases::kStaying;
        }
    }
}

/// Which pieces may go along with their common motion, and where that leads their vertices. A vertex that
/// leaves its room on the way there is looked at beside all models as if its goal were there.
void SurfaceCollision::find_common_motion(PointArrays& places, const Particles& particles,
                                          const Workers& workers) {
    for (std::uint32_t v = 0; v < particles.count(); ++v) {
        const std::uint32_t piece = common_motion_.piece_of(v);
        const std::optional<Vec3f> displacement = common_motion_.displacement_of(piece);
        goes_along_[piece] = displacement ? 1 : 0;
        places.set(v, particles.frame_start[v] + displacement.value_or(Vec3f{}));
    }
    const std::size_t known_count = leaving_.size();
    std::size_t count = 0;
    do {
        count = leaving_.size();
        find_leaving(places, workers);
        find_leaving(goals_, workers);
    } while (leaving_.size() > count);
    for (std::size_t i = known_count; i < leaving_.size(); ++i)
        ends_.set(leaving_[i], find_place(leaving_[i], true, particles, workers));
    for (std::uint32_t v = 0; v < particles.count(); ++v)
        if (!particles.pinned(v) && !models_.permit(v, places[v], false))
            goes_along_[common_motion_.piece_of(v)] = 0;
}

bool SurfaceCollision::goes_along(std::uint32_t vertex) {
    return goes_along_[common_motion_.piece_of(vertex)] != 0;
}

/// Pieces that would meet on their common motions go on as one. @return whether there were any
bool SurfaceCollision::join_stuck_pieces() {
    bool is_any_joined = false;
    for (const std::array<std::uint32_t, 4>& points : self_->stuck())
        if (std::any_of(points.begin(), points.end(), [&](std::uint32_t v) { return goes_along(v); }))
            is_any_joined = common_motion_.join(points) || is_any_joined;
    return is_any_joined;
}

/// A vertex that leaves its room beside one model is looked at beside all of them.
void SurfaceCollision::find_leaving(const PointArrays& places, const Workers& workers) {
    models_.for_each_near([&](std::size_t, ModelSurface& model) { model.set_goals(places); });
    const auto add = [&](std::span<const std::uint32_t> vertices) {
        const std::size_t before = leaving_.size();
        for (const std::uint32_t v : vertices)
            if (std::exchange(is_leaving_[v], 1) == 0) leaving_.push_back(v);
        return leaving_.size() > before;
    };
    for (bool found = true; found;) {
        found = false;
        models_.for_each_near(
            [&](std::size_t, ModelSurface& model) { found = add(model.find_leaving(workers)) || found; });
        if (!found || models_.count() == 1) break;
        for (const std::uint32_t v : leaving_)
            models_.for_each_near([&](std::size_t, ModelSurface& model) { model.renew(v, workers); });
    }
}

/// The only model that is near and moves, which takes along what would else stay behind; or none.
const ModelSurface* SurfaceCollision::carrier() const {
    return own_frame_ < models_.count() ? &models_.all[own_frame_] : nullptr;
}

/// Where a vertex ends that goes none of its way.
Vec3f SurfaceCollision::base_of(std::uint32_t vertex, bool is_first, const Particles& particles,
                                const Workers& workers) {
    if (!is_first) return particles.positions[vertex];
    if (particles.pinned(vertex)) return goals_[vertex]; // nothing holds it back
    if (leading_->has_pulls()) return leading_->carried_between(vertex, models_, particles, workers);
    return carrier() != nullptr ? carrier()->carried(vertex) : particles.frame_start[vertex];
}

Vec3f SurfaceCollision::find_place(std::uint32_t vertex, bool is_first, const Particles& particles,
                                   const Workers& workers) {
    const Vec3f goal = goals_[vertex];
    const ModelSurface* only = is_first ? carrier() : nullptr;
    const bool is_pinned = particles.pinned(vertex); // goes all of its way, beside each model as that sees it
    const Vec3f from = base_of(vertex, is_first, particles, workers);
    Shares shares;
    models_.for_each_near([&](std::size_t c, ModelSurface& model) {
        const float most = shares.most;
        shares.keep(model.allowed(vertex, is_pinned || &model == only ? nullptr : &from));
        if (shares.most < most || shares.none()) stopped_by_[vertex] = static_cast<std::uint32_t>(c);
    });
    if (shares.none() || (is_pinned && shares.most < 1)) ++squeezed_now_;
    if (is_pinned) return goal;
    const float share = shares.none() ? 0 : std::max(shares.most, 0.0F);
    if (share == 1) return goal;
    return only != nullptr ? only->place_at(share, vertex) : from + (goal - from) * share;
}

} // namespace echinus
