#include "simulation/contact/surface_contacts.hpp"

#include "simulation/contact/passing_planes.hpp"
#include "simulation/contact/safe_displacements.hpp"
#include "simulation/contact/thresholds.hpp"
#include "simulation/surfaces/edge_lengths.hpp"
#include "simulation/surfaces/model_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace echinus {

namespace {

float least_height_of(const Element& element, std::span<const Vec3f> positions) {
    if (!element.is_face()) return std::numeric_limits<float>::infinity();
    const Vec3f a = positions[element.vertices[0]], b = positions[element.vertices[1]],
                c = positions[element.vertices[2]];
    const float longest = std::max({length(b - a), length(c - b), length(a - c)});
    return longest > 0 ? length(cross(b - a, c - a)) / longest : 0;
}

/// The height at rest: a barycentric coordinate falls from 1 to 0 along a height.
float least_height_of(const ElasticTetrahedron& tetrahedron) {
    const auto& [b, c, d] = tetrahedron.gradients;
    return 1 / std::max({length(b), length(c), length(d), length(b + c + d)});
}

/// [collider] 1 for colliders whose faces do not collide: only particles are kept out of them.
std::vector<std::uint8_t> without_faces(const std::vector<Collider>& colliders,
                                        const SimulationOptions& options) {
    std::vector<std::uint8_t> result;
    for (const Collider& collider : colliders)
        result.push_back(options.surfaces_collide() && map_of_surface(collider) != nullptr ? 0 : 1);
    return result;
}

/// The side between a deformable and a model with faces.
ContactSide side_of_model(std::shared_ptr<const Elements> own, const PointArrays& places,
                          const Collider& collider, float thickness, float edge_length) {
    const TriangleMesh mesh = model_mesh(map_of_surface(collider)->view(), collider.scale);
    PointArrays vertices;
    vertices.load(mesh.vertices);
    ContactSide side(
        std::move(own), places,
        std::make_shared<const Elements>(mesh.vertices.size(), mesh.faces, std::span<const Edge>{}),
        std::move(vertices));
    side.thickness = thickness;
    side.extent = largest_coordinate(side.obstacle_places, mesh.vertices.size());
    side.pairs.set_reach(
        std::max(threshold::kReady * thickness, threshold::kReach * edge_length + thickness));
    return side;
}

/// The side between a surface and itself. @param thickness  the wanted one
ContactSide side_of_layers(const std::shared_ptr<const Elements>& own, const PointArrays& places,
                           float thickness, float edge_length) {
    ContactSide side(own, places);
    side.thickness = std::min(thickness, threshold::kMostSelfThickness * edge_length);
    side.pairs.set_reach(std::max(threshold::kReady * side.thickness, threshold::kReach * edge_length));
    return side;
}

/// [vertex] the largest thickness between layers for which its neighbourhood leaves room.
std::vector<float> most_self_thicknesses(const Elements& own, const Deformable& deformable,
                                         float edge_length) {
    std::vector<float> most(own.vertex_count(), threshold::kMostSelfThickness * edge_length);
    const auto limit = [&](const auto& vertices, float least_height) {
        for (const std::uint32_t v : vertices)
            most[v] = std::min(most[v], threshold::kMostOfHeight * least_height);
    };
    for (const Element& element : own.all)
        limit(element.vertices, least_height_of(element, deformable.positions));
    for (const ElasticTetrahedron& tetrahedron : deformable.tetrahedra)
        limit(tetrahedron.particles, least_height_of(tetrahedron));
    return most;
}

/// The parts of their displacements that stopped bodies keep, from attempt to attempt: ever smaller shares of
/// the displacements relative to the common one of the body, then of the whole ones, and in the end nothing.
class Shortening {
  public:
    Vec3d goal(const Vec3d& from, const Vec3d& wanted, const Vec3d& common) const {
        const Vec3d kept = keeps_common() ? common : Vec3d{};
        return from + kept + (wanted - from - kept) * share();
    }
    bool keeps_nothing() const { return attempt_ >= kFirstWithout; }
    bool is_last() const { return attempt_ == kLast; }
    bool is_last_but_one() const { return attempt_ + 1 == kLast; }

    /// Shortening the whole displacement helps against strain. If there is too little room, it takes long and
    /// does not help.
    void go_on(bool has_room) {
        ++attempt_;
        if (!has_room && !keeps_common() && !keeps_nothing()) attempt_ = kFirstWithout;
    }

  private:
    static constexpr int kFirstOfAll = threshold::kMostHalvings,
                         kFirstWithout = kFirstOfAll + threshold::kMostHalvingsOfAll,
                         kLast = kFirstWithout + threshold::kMostHalvings;

    bool keeps_common() const { return attempt_ < kFirstOfAll; }
    double share() const {
        if (keeps_nothing()) return 0;
        return keeps_common() ? std::ldexp(1.0, -attempt_) : std::ldexp(0.5, kFirstOfAll - attempt_);
    }

    int attempt_ = 0;
};

using FourPoints = std::array<Vec3d, 4>;

double longest_of(const FourPoints& displacements) {
    double longest = 0;
    for (const Vec3d& displacement : displacements) longest = std::max(longest, length(displacement));
    return longest;
}

Vec3d weighted_sum(const FourPoints& points, const std::array<double, 4>& weights) {
    Vec3d sum;
    for (std::size_t k = 0; k < 4; ++k) sum += points[k] * weights[k];
    return sum;
}

/// The nearest point of a pair's obstacle.
Vec3d point_of_obstacle(PairKind kind, const FourPoints& points, const std::array<double, 4>& shares) {
    Vec3d point;
    for (std::size_t k = own_count(kind); k < 4; ++k) point += points[k] * shares[k];
    return point;
}

/// The normal of a contact. If its parts move farther than their distance, they may pass each other.
Vec3d normal_of(const PassingParts<double>& parts, double distance) {
    const double closing = -dot(parts.normal, parts.ahead);
    if (!(closing > 0) || !(dot(parts.ahead, parts.ahead) > distance * distance)) return parts.normal;
    Vec3d best = parts.normal;
    double most = distance - closing;
    for (const Vec3d& normal : parts.normals()) {
        const double gap = parts.gap_along(normal), left = gap + std::min(dot(normal, parts.ahead), 0.0);
        if (gap > 0 && left > most) {
            best = normal;
            most = left;
        }
    }
    return best;
}

} // namespace

SurfaceContacts::SurfaceContacts(const Deformable& deformable, const std::vector<Collider>& colliders,
                                 std::span<const double> masses, std::span<const double> strengths,
                                 std::span<const std::uint32_t> bodies, const SimulationOptions& options)
    : own_(std::make_shared<Elements>(elements_of(deformable))), masses_(masses.begin(), masses.end()),
      strengths_(strengths.begin(), strengths.end()), bodies_(bodies.begin(), bodies.end()),
      collider_count_(colliders.size()), particles_(deformable, colliders, without_faces(colliders, options),
                                                    *options.thickness, options.friction),
      contacts_(own_->vertex_count(), colliders.size() + (options.layers_collide() ? 1 : 0), colliders.size(),
                length(options.gravity)) {
    const float edge_length = mean_edge_length(*own_, deformable.positions);
    const auto thickness = static_cast<float>(*options.thickness);
    PointArrays places;
    places.load(deformable.positions);
    const std::vector<std::uint8_t> has_none = without_faces(colliders, options);
    for (std::uint32_t c = 0; c < colliders.size(); ++c) {
        if (has_none[c] != 0) continue;
        const std::vector<std::uint8_t> passes = let_through(deformable, c);
        const auto own =
            passes.empty() ? own_ : std::make_shared<const Elements>(elements_of(deformable, passes));
        sides_.push_back(side_of_model(own, places, colliders[c], thickness, edge_length));
        sides_.back().number = c;
    }
    if (options.layers_collide()) {
        const auto between_layers =
            static_cast<float>(options.newton().self_thickness.value_or(*options.thickness));
        sides_.push_back(side_of_layers(own_, places, between_layers, edge_length));
        sides_.back().number = static_cast<std::uint32_t>(collider_count_);
    }
    for (ContactSide& side : sides_) {
        side.friction = static_cast<float>(options.friction);
        side.ready = threshold::kReady * side.thickness;
    }
    most_ = most_self_thicknesses(*own_, deformable, edge_length);
    most_missed_ = threshold::kMostMissed * edge_length;
    frames_.resize(collider_count_ + 1);
    is_touching_.resize(own_->vertex_count());
    stopped_by_.assign(own_->vertex_count(), kNoObstacle);
    safe_places_.resize(own_->vertex_count());
}

void SurfaceContacts::set_free_bodies(std::vector<FreeBody> free_bodies, std::span<const double> masses,
                                      std::span<const std::uint32_t> bodies) {
    free_bodies_ = std::move(free_bodies);
    std::vector<double> free_masses(free_bodies_.empty() ? 0 : collider_count_);
    for (const FreeBody& body : free_bodies_) free_masses[body.collider()] = body.mass();
    contacts_.set_free_bodies(std::move(free_masses), bodies);
    masses_.assign(masses.begin(), masses.end());
    bodies_.assign(bodies.begin(), bodies.end());
    is_touching_.assign(masses.size(), 0);
    stopped_by_.assign(masses.size(), kNoObstacle);
    safe_places_.resize(masses.size());
}

void SurfaceContacts::begin_frame() {
    contacts_.begin_frame();
    unresolved_count_ = 0;
}

std::size_t SurfaceContacts::pair_count() const {
    std::size_t count = 0;
    for (const ContactSide& side : sides_) count += side.pairs.listed_count();
    return count;
}

void SurfaceContacts::place_obstacle(std::size_t collider, std::span<const Vec3f> vertices) {
    PointArrays places;
    places.load(vertices);
    for (ContactSide& side : sides_)
        if (side.number == collider) side.place_obstacle(std::move(places));
}

bool SurfaceContacts::carry(const std::vector<Collider>& before, const std::vector<Collider>& after,
                            std::span<const Deformation> deformations, const FramePart& part,
                            const PointArrays& from, PointArrays& carried,
                            std::span<const std::uint8_t> is_held, bool in_any_case, const Workers& workers) {
    is_held_ = is_held;
    start_ = from;
    set_safe(from);
    ScratchVector<Vec3d> places(own_->vertex_count(), workers.scratch());
    for (std::size_t i = 0; i < places.size(); ++i) places[i] = Vec3d(carried[i]);
    for (ContactSide& side : sides_) {
        const bool is_model = !side.pairs.is_of_itself();
        if (is_model) side.set_pose(before[side.number].pose);
        side.set_safe(from);
        if (is_model) {
            side.start = side.safe;
            side.set_pose(after[side.number].pose);
            const SurfaceMotion* const motion = deformations[side.number].motion;
            side.moves = CarryField::longest_displacement(before[side.number], after[side.number]) > 0 ||
                         motion != nullptr;
            side.has_deformed = false;
            if (motion != nullptr) side.deform(motion->at(part.end));
        }
        side.list(places, workers);
    }
    const ScratchVector<std::uint8_t> none_is_held(in_any_case ? is_held.size() : 0, workers.scratch());
    const PushRules rules{.is_held = in_any_case ? std::span(none_is_held) : is_held,
                          .yields = true,
                          .masses = {},
                          .share = threshold::kMostClosedByCarrying};
    const bool is_safe = find_ends(places, rules, workers);
    is_carried_ = is_safe || in_any_case;
    for (ContactSide& side : sides_) side.end_deforming(is_carried_);
    if (!is_carried_) return false;
    unresolved_count_ += is_safe ? unresolved_ : std::max(unresolved_, std::size_t{1});
    for (std::size_t i = 0; i < places.size(); ++i) carried.set(i, Vec3f(places[i]));
    return true;
}

double SurfaceContacts::overlap_ahead(const std::vector<Collider>& colliders, const PointArrays& from,
                                      Places guess, std::span<std::uint8_t> may_touch,
                                      const Workers& workers) {
    double most = 0;
    std::fill(may_touch.begin(), may_touch.end(), std::uint8_t{0});
    for (ContactSide& side : sides_) {
        if (!side.pairs.is_of_itself()) side.set_pose(colliders[side.number].pose);
        if (const FreeBody* const body = free_body_of(side.number)) side.head_for(body->goal_pose);
        side.set_safe(from);
        side.list(guess, workers);
        side.measure_towards(guess, workers);
        most = std::max(most, side.overlap_ahead(may_touch));
    }
    return most;
}

void SurfaceContacts::set_safe(const PointArrays& places) {
    safe_ = places;
    for (std::size_t i = 0; i < own_->vertex_count(); ++i) safe_places_[i] = Vec3d(places[i]);
    const float extent = largest_coordinate(places, own_->vertex_count());
    for (ContactSide& side : sides_) side.least_gap = (extent + side.extent) * threshold::kLeastGap;
}

void SurfaceContacts::begin_step(const std::vector<Collider>& colliders, const PointArrays& places,
                                 Places guess, std::span<const std::uint8_t> is_held, double step,
                                 const Workers& workers) {
    is_held_ = is_held;
    if (!is_carried_) start_ = places;
    set_safe(places);
    for (FreeBody& body : free_bodies_) {
        body.start_pose = body.safe_pose = colliders[body.collider()].pose;
        body.goal_pose = body.fit(guess, body.safe_pose);
        body.put(body.safe_pose, safe_places_);
    }
    std::fill(is_touching_.begin(), is_touching_.end(), std::uint8_t{0});
    std::fill(stopped_by_.begin(), stopped_by_.end(), kNoObstacle);
    for (ContactSide& side : sides_) {
        if (!side.pairs.is_of_itself()) side.set_pose(colliders[side.number].pose);
        if (const FreeBody* const body = free_body_of(side.number)) side.head_for(body->goal_pose);
        if (!is_carried_) side.moves = side.has_deformed = false;
        side.set_safe(safe_);
        side.list(guess, workers);
        side.measure_towards(guess, workers);
    }
    for (std::size_t c = 0; c < collider_count_; ++c) frames_[c] = frame_of(colliders[c].pose);
    contacts_.begin_step(step, frames_);
    is_carried_ = has_moved_ = false;
    is_begun_ = true;
    find_contacts(guess, false);
}

/// The ends of displacements towards goals, as far as the planes between the pairs allow.
/// @param places  in: the goals. Out: the ends
/// @return whether nothing meets on the way to the ends, except the pairs counted as unresolved
bool SurfaceContacts::find_ends(std::span<Vec3d> places, const PushRules& rules, const Workers& workers) {
    const ScratchVector<Vec3d> goals(places.begin(), places.end(), workers.scratch());
    SafeDisplacements displacements(sides_, goals, rules, workers);
    for (int round = 0; round < threshold::kMostListingRounds; ++round) {
        const Places ends = displacements.find();
        unresolved_ = displacements.unresolved_count();
        std::copy(ends.begin(), ends.end(), places.begin());
        for (std::size_t i = 0; i < places.size(); ++i)
            if (const std::uint32_t by = displacements.pushed_by()[i]; by != kNoObstacle) stopped_by_[i] = by;
        if (!displacements.has_converged() || meets_what_cannot_yield(displacements)) return false;
        bool is_any_added = false;
        for (ContactSide& side : sides_) is_any_added = side.list(places, workers) || is_any_added;
        if (!is_any_added) return true;
    }
    return false;
}

/// Marks the free bodies that would still close a pair after its particles have been pushed, because these
/// are held.
/// @return whether there are any
bool SurfaceContacts::meets_what_cannot_yield(const SafeDisplacements& displacements) {
    bool is_any = false;
    for (std::size_t s = 0; s < sides_.size(); ++s) {
        FreeBody* const body = free_body_of(sides_[s].number);
        if (body == nullptr) continue;
        body->is_stopped = displacements.closed_counts()[s] > 0 && body->goal_pose != body->safe_pose;
        is_any = is_any || body->is_stopped;
    }
    return is_any;
}

FreeBody* SurfaceContacts::free_body_of(std::uint32_t collider) {
    for (FreeBody& body : free_bodies_)
        if (body.collider() == collider) return &body;
    return nullptr;
}

/// Sets the goals of free bodies to the rigid poses that fit the goals of their control points best.
/// @param goals  in, out
void SurfaceContacts::head_for(std::span<Vec3d> goals) {
    for (FreeBody& body : free_bodies_) {
        body.goal_pose = body.fit(goals, body.safe_pose);
        body.put(body.goal_pose, goals);
    }
    for (ContactSide& side : sides_)
        if (const FreeBody* const body = free_body_of(side.number)) side.head_for(body->goal_pose);
}

/// Makes these places, and the goals of free bodies, the safe state.
void SurfaceContacts::arrive_at(Places places) {
    has_moved_ = has_moved_ || !std::equal(places.begin(), places.end(), safe_places_.begin());
    std::copy(places.begin(), places.end(), safe_places_.begin());
    for (std::size_t i = 0; i < own_->vertex_count(); ++i) safe_.set(i, Vec3f(places[i]));
    for (FreeBody& body : free_bodies_) {
        body.safe_pose = body.goal_pose;
        particles_.move(body.collider(), body.safe_pose);
    }
    for (ContactSide& side : sides_)
        if (const FreeBody* const body = free_body_of(side.number)) side.set_pose(body->safe_pose);
}

/// Marks the bodies of particles that did not reach their goals, and the free bodies that stopped them.
/// @param is_stopped  [body] set to 1 if any part of it was stopped
/// @return the number of stopped particles and bodies, and whether any of their bodies had not been marked
SurfaceContacts::Stopped SurfaceContacts::mark_stopped(Places goals, Places ends,
                                                       std::span<std::uint8_t> is_stopped,
                                                       const Workers& workers) {
    Stopped stopped;
    const ScratchVector<std::uint8_t> before(is_stopped.begin(), is_stopped.end(), workers.scratch());
    const auto stop = [&](std::uint32_t body) {
        is_stopped[body] = 1;
        if (before[body] == 0) stopped.is_any_new = true;
    };
    missed_ = 0;
    for (std::size_t i = 0; i < goals.size(); ++i) {
        const double missed = length(goals[i] - ends[i]);
        missed_ = std::max(missed_, missed);
        if (!(missed > 0)) continue;
        ++stopped.count;
        is_touching_[i] = 1;
        stop(bodies_[i]);
        if (FreeBody* const body = free_body_of(stopped_by_[i])) body->is_stopped = true;
    }
    for (FreeBody& body : free_bodies_) {
        if (!std::exchange(body.is_stopped, false)) continue;
        ++stopped.count;
        stop(body.first_point());
    }
    return stopped;
}

/// Goes from the safe state towards goals as far as the planes between the pairs allow. A body of which any
/// particle is stopped is moved less far if there is too little room, if listing pairs does not end, or if
/// the stops strain the rest of the body so that the energy rises. First its displacements relative to the
/// common displacement of the body are shortened, then its whole displacement, because the body may be in the
/// way of others that rest on it. In the end all of it except held particles stays where it is, and the
/// others move around it.
/// @param places  in: the goals. Out: the new safe state, whose pairs are not measured yet
/// @return how many particles and free bodies were stopped
std::size_t SurfaceContacts::go_towards(std::span<Vec3d> places, const StepEnergy& energy,
                                        const Workers& workers) {
    Scratch& scratch = workers.scratch();
    const ScratchVector<Vec3d> wanted(places.begin(), places.end(), scratch);
    const ScratchVector<Vec3d> common =
        common_displacements(safe_places_, wanted, masses_, bodies_, is_held_, workers);
    ScratchVector<Vec3d> goals = wanted;
    ScratchVector<std::uint8_t> is_stopped(goals.size(), scratch); // [body]
    std::optional<double> most_energy;
    std::size_t most_stopped = 0;
    for (Shortening shortening;;) {
        for (std::size_t i = 0; i < goals.size(); ++i)
            if (is_held_[i] == 0 && is_stopped[bodies_[i]] != 0)
                goals[i] = shortening.goal(safe_places_[i], wanted[i], common[bodies_[i]]);
        head_for(goals);
        std::copy(goals.begin(), goals.end(), places.begin());
        const bool is_safe = find_ends(places, {.is_held = is_held_, .masses = masses_}, workers);
        const Stopped stopped = mark_stopped(goals, places, is_stopped, workers);
        most_stopped = std::max(most_stopped, stopped.count);
        if (is_safe && most_stopped == 0) break;
        if (shortening.keeps_nothing()) {
            if (shortening.is_last() || (is_safe && !stopped.is_any_new)) break;
            if (!stopped.is_any_new || shortening.is_last_but_one())
                std::fill(is_stopped.begin(), is_stopped.end(), 1);
        } else if (is_safe) {
            if (!most_energy) most_energy = energy(safe_places_);
            if (energy(places) <= *most_energy) break;
        }
        shortening.go_on(is_safe);
    }
    arrive_at(places);
    return most_stopped;
}

std::size_t SurfaceContacts::advance(std::span<Vec3d> places, const StepEnergy& energy,
                                     const Workers& workers) {
    std::fill(stopped_by_.begin(), stopped_by_.end(), kNoObstacle);
    return advance_further(places, energy, workers);
}

std::size_t SurfaceContacts::advance_further(std::span<Vec3d> places, const StepEnergy& energy,
                                             const Workers& workers) {
    goals_.assign(places.begin(), places.end());
    std::size_t stopped = 0;
    for (int pass = 0; pass < threshold::kMostPasses; ++pass) {
        std::copy(goals_.begin(), goals_.end(), places.begin());
        stopped = go_towards(places, energy, workers);
        if (std::exchange(is_begun_, false)) unresolved_count_ += unresolved_;
        head_for(goals_);
        for (ContactSide& side : sides_) {
            side.set_safe(safe_);
            side.measure_towards(goals_, workers);
        }
        if (missed_ <= double{most_missed_}) break;
    }
    return stopped;
}

void SurfaceContacts::renew() {
    find_contacts(goals_, true);
}

/// @param goals  where particles may go: contacts that push there are included
/// @param is_solved  whether the contact forces at the current gaps are those of the step and limit friction;
/// otherwise those of the step before do
void SurfaceContacts::find_contacts(Places goals, bool is_solved) {
    contacts_.clear();
    for (const ContactSide& side : sides_) add_contacts(side, goals, is_solved);
    const Places places = is_solved ? Places(safe_places_) : goals;
    particles_.add_to(contacts_, places.first(own_->vertex_count()), masses_, strengths_, free_bodies_,
                      is_solved);
}

float SurfaceContacts::thickness_of(const ContactSide& side, const Pair& pair) const {
    if (!side.pairs.is_of_itself())
        return pair.kind == PairKind::VertexFace ? side.thickness : threshold::kSurfaceShare * side.thickness;
    float thickness = side.thickness;
    for (const std::uint32_t v : pair.points) thickness = std::min(thickness, most_[v]);
    return thickness;
}

/// The difference between a pair's nearest points when the step began, carried along with the obstacle since.
Vec3d SurfaceContacts::slip_start(const ContactSide& side, const Pair& pair,
                                  const std::array<double, 4>& shares) const {
    const std::size_t own = own_count(pair.kind), moving = side.pairs.moving_count(pair);
    Vec3d start;
    for (std::size_t k = 0; k < moving; ++k) {
        const std::uint32_t i = pair.points[k];
        start += Vec3d(side.moves ? side.start[i] : start_[i]) * (k < own ? shares[k] : -shares[k]);
    }
    return side.moves ? side.to_world(Vec3f(start + side.obstacle_displacement(pair, shares))) : start;
}

void SurfaceContacts::add_contacts(const ContactSide& side, Places goals, bool is_solved) {
    const auto pairs = side.pairs.pairs();
    const auto separations = side.pairs.separations();
    for (std::size_t p = 0; p < pairs.size(); ++p)
        if (separations[p].gap > 0) add_contact(side, pairs[p], separations[p].gap, goals, is_solved);
}

/// Adds the contact of a pair, measured in double, if it may push.
/// @param proven_gap  in single precision; it may be a tenth less than the distance
void SurfaceContacts::add_contact(const ContactSide& side, const Pair& pair, float proven_gap, Places goals,
                                  bool is_solved) {
    const double thickness{thickness_of(side, pair)}, ready = double{threshold::kReady} * thickness;
    const std::size_t own = own_count(pair.kind), moving = side.pairs.moving_count(pair);
    FourPoints displacements, points;
    for (std::size_t k = 0; k < 4; ++k) {
        const std::uint32_t i = pair.points[k];
        displacements[k] = k < moving ? goals[i] - safe_places_[i] : side.obstacle_ahead(i);
    }
    if (!(double{proven_gap} - 2 * longest_of(displacements) < ready)) return;
    for (std::size_t k = 0; k < 4; ++k) {
        const std::uint32_t i = pair.points[k];
        points[k] = k < moving ? safe_places_[i] : side.to_world(side.obstacle_places[i]);
    }
    const std::array<double, 4> shares = nearest_points(pair.kind, points);
    std::array<double, 4> weights = shares;
    for (std::size_t k = own; k < 4; ++k) weights[k] = -shares[k];
    const Vec3d across = weighted_sum(points, weights), ahead = weighted_sum(displacements, weights);
    const double distance = length(across);
    if (!(distance > 0)) return;
    const Vec3d normal = normal_of({pair.kind, points, across * (1 / distance), ahead}, distance);
    const double gap = dot(normal, across);
    ContactSet::Contact contact = contact_along(normal, gap, side, pair, weights);
    contact.thickness = thickness;
    Vec3d start = slip_start(side, pair, shares);
    if (const FreeBody* const body = free_body_of(side.number))
        body->join(contact, start, point_of_obstacle(pair.kind, points, shares));
    if (gap + std::min(dot(normal, ahead), 0.0) < ready && contact.mobility > 0)
        contacts_.add(contact, start, is_solved ? std::optional(gap) : std::nullopt);
}

/// The contact of a pair's moving points along a normal.
/// @param weights  of the points in the difference between the pair's nearest points
ContactSet::Contact SurfaceContacts::contact_along(const Vec3d& normal, double gap, const ContactSide& side,
                                                   const Pair& pair,
                                                   const std::array<double, 4>& weights) const {
    ContactSet::Contact contact;
    contact.key = {side.number, pair.kind, pair.points};
    contact.normal = normal;
    contact.offset = gap;
    contact.friction = double{side.friction};
    contact.particles.fill(pair.points[0]);
    for (std::size_t k = 0; k < side.pairs.moving_count(pair); ++k) {
        const std::uint32_t i = pair.points[k];
        const double weight = weights[k];
        contact.particles[k] = i;
        contact.weights[k] = weight;
        contact.offset -= weight * dot(normal, safe_places_[i]);
        if (is_held_[i] != 0) continue;
        contact.mobility += weight * weight / masses_[i];
        contact.yielding += weight * weight / strengths_[i];
    }
    return contact;
}

void SurfaceContacts::put_outside(std::span<Vec3d> places, const StepEnergy& energy, const Workers& workers) {
    if (particles_.put_outside(places.first(own_->vertex_count()), is_touching_))
        advance_further(places, energy, workers);
}

bool SurfaceContacts::stops() const {
    return std::any_of(stopped_by_.begin(), stopped_by_.end(),
                       [&](std::uint32_t side) { return side < collider_count_; });
}

void SurfaceContacts::add_loads(Places places, std::span<const Vec3d> forces,
                                std::span<const std::uint32_t> held_by, const Workers& workers) {
    if (collider_count_ == 0) return;
    // If stops have shortened the step of a body, its particles next to the stopped ones are stopped as well.
    ScratchVector<std::size_t> stops(bodies_.size() * collider_count_, workers.scratch());
    for (std::size_t i = 0; i < bodies_.size(); ++i)
        if (stopped_by_[i] < collider_count_) ++stops[bodies_[i] * collider_count_ + stopped_by_[i]];
    const auto stopped_with = [&](std::size_t body) {
        const auto begin = stops.begin() + static_cast<std::ptrdiff_t>(body * collider_count_);
        const auto most = std::max_element(begin, begin + static_cast<std::ptrdiff_t>(collider_count_));
        return *most > 0 ? static_cast<std::uint32_t>(most - begin) : kNoObstacle;
    };
    for (std::size_t i = 0; i < forces.size(); ++i) {
        const std::uint32_t stopped_by =
            stopped_by_[i] < collider_count_ ? stopped_by_[i] : stopped_with(bodies_[i]);
        const std::uint32_t collider = is_held_[i] != 0 ? held_by[i] : stopped_by;
        if (collider < collider_count_) contacts_.add_load(collider, places[i], forces[i], frames_[collider]);
    }
}

void SurfaceContacts::end_step(Places places) {
    for (const FreeBody& body : free_bodies_) frames_[body.collider()] = frame_of(body.safe_pose);
    contacts_.end_step(places, frames_, is_touching_);
}

void SurfaceContacts::archive(StateArchive& state) {
    contacts_.archive(state);
    for (ContactSide& side : sides_) {
        const auto archive_places = [&](PointArrays& places) {
            places.resize(own_->vertex_count());
            state.points(places);
        };
        bool is_listed = side.is_listed();
        state.flag(is_listed);
        if (is_listed) {
            archive_places(side.listed_from);
            archive_places(side.listed_to);
        } else {
            side.listed_from = side.listed_to = {};
        }
        state.value(side.away.from);
        state.value(side.away.to);
        state.require(side.away.from >= 0 && side.away.to >= 0);
        side.away_before = side.away;
        side.pairs.archive(state);
    }
}

} // namespace echinus
