#include "simulation/contact/surface_contacts.hpp"

#include "geometry/union_find.hpp"
#include "simulation/surfaces/edge_lengths.hpp"
#include "simulation/surfaces/model_mesh.hpp"
#include "simulation/surfaces/shares.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace echinus {

namespace {

/// The force of a contact's barrier over the weight of what it carries: with one layer on it a contact at
/// rest is 0.77 of the thickness wide, under ten 0.4.
constexpr double kContactWeights = 5;
/// The share of the thickness from which on the barrier goes on as a parabola.
constexpr double kLeastShare = 1.0 / 64;
/// Of friction that holds: stiffness over mass / h^2, the resistance of inertia in a step.
constexpr double kFrictionStiffness = 100;
/// In thicknesses: a pair this near is a contact, which begins to push as soon as a trial comes within one.
constexpr double kReady = 2;
/// Edges and faces of a model lie between vertices: they need less thickness than vertices keep.
constexpr float kSurfaceShare = 0.75F;
/// In mean edges: how far around its displacement a vertex looks for pairs.
constexpr float kReach = 0.25F;
/// In mean edges, and in least heights of faces: layers of one surface cannot keep farther apart than the
/// faces around a vertex are small.
constexpr float kMostSelfThickness = 0.25F, kMostOfHeight = 0.4F;
/// Of a pair's gap the share that carrying may close, and the rounds in which what would close more is
/// joined.
constexpr float kMostClosed = 0.5F;
constexpr int kMostCarryRounds = 64;
/// Rounds in which ends that were not expected are looked at anew.
constexpr int kMostRounds = 8;
/// No share of a displacement leads quite to a plane.
constexpr float kAlmost = 1 - 1.0F / (1 << 10);
/// Of coordinates: no pair comes nearer, since its gap would be lost in rounding.
constexpr float kLeastGap = 1.0F / (1 << 19);

float largest_coordinate(const PointArrays& points, std::size_t count) {
    float largest = 0;
    for (std::size_t i = 0; i < count; ++i)
        largest = std::max({largest, std::fabs(points.x[i]), std::fabs(points.y[i]), std::fabs(points.z[i])});
    return largest;
}

float least_height_of(const Element& element, std::span<const Vec3f> positions) {
    if (!element.is_face()) return std::numeric_limits<float>::infinity();
    const Vec3f a = positions[element.vertices[0]], b = positions[element.vertices[1]],
                c = positions[element.vertices[2]];
    const float longest = std::max({length(b - a), length(c - b), length(a - c)});
    return longest > 0 ? length(cross(b - a, c - a)) / longest : 0;
}

} // namespace

/// An obstacle of the surface: a model, in the frame that moves with it, or itself, in the world.
struct SurfaceContacts::Side {
    std::shared_ptr<const Elements> own;
    Elements obstacle; ///< of a model
    PointArrays obstacle_places;
    PairSet pairs;
    FrameChange frame{RigidTransform{}, {1, 1, 1}};
    float thickness = 0, friction = 0, least_gap = 0;
    float extent = 0;     ///< of the obstacle's coordinates
    PointArrays from, to; ///< of the surface in this frame
    PointArrays expected; ///< ends of displacements for which the pairs are listed
    bool is_in_world = false;

    Side(std::shared_ptr<const Elements> own_in) : own(std::move(own_in)), pairs(*own) {}
    Side(std::shared_ptr<const Elements> own_in, Elements obstacle_in)
        : own(std::move(own_in)), obstacle(std::move(obstacle_in)), pairs(*own, obstacle) {}
    /// Pairs are known for one step, and are not copied.
    Side(const Side& other)
        : own(other.own), obstacle(other.obstacle), obstacle_places(other.obstacle_places),
          pairs(other.pairs.is_of_itself() ? PairSet(*own) : PairSet(*own, obstacle)), frame(other.frame),
          thickness(other.thickness), friction(other.friction), least_gap(other.least_gap),
          extent(other.extent), is_in_world(other.is_in_world) {
        pairs.set_reach(other.pairs.reach());
    }
    Side& operator=(const Side&) = delete;

    void to_frame(const PointArrays& world, PointArrays& result) const {
        if (is_in_world) {
            result = world;
            return;
        }
        result.resize(own->vertex_count());
        for (std::size_t i = 0; i < own->vertex_count(); ++i) result.set(i, frame.point_to_local(world[i]));
    }
    Vec3d obstacle_point(std::uint32_t vertex) const {
        return is_in_world ? Vec3d(obstacle_places[vertex])
                           : frame.point_to_world<double>(obstacle_places[vertex]);
    }
    /// The surface where a step begins, beside the obstacle there; then the frame is that where it ends.
    void begin_carrying(const RigidTransform& before, const RigidTransform& after,
                        const PointArrays& places) {
        set_pose(before);
        to_frame(places, from);
        set_pose(after);
    }
    void set_pose(const RigidTransform& pose) {
        frame = FrameChange(pose, {1, 1, 1});
        const Rotation& r = pose.rotation;
        is_in_world = pose.translation == Vec3d{} && r.x == 0 && r.y == 0 && r.z == 0;
    }
    const PointArrays& obstacle_at(const PointArrays& own_places) const {
        return pairs.is_of_itself() ? own_places : obstacle_places;
    }
};

/// A pair that pushes, or may before the step ends: its gap is linear in the places.
struct SurfaceContacts::Contact {
    std::array<std::uint32_t, 4> particles{};
    std::array<double, 4> weights{}; ///< 0 of what is not the deformable's
    Vec3d normal;
    double offset;                      ///< gap = offset + normal . sum of weights * place
    double thickness, force, stiffness; ///< of the barrier, and of friction that holds
    Vec3d slip_offset;                  ///< slip = tangential part of this + sum of weights * place
    double most_friction;               ///< force: of the normal one where it was measured
    std::uint32_t side;
    Pair pair;
};

/// The memory of a pair from step to step: how far it is strained along its plane.
struct SurfaceContacts::Friction {
    std::uint32_t side;
    PairKind kind;
    std::array<std::uint32_t, 4> points;
    Vec3d slip;  ///< in the side's frame
    double push; ///< the normal force when the step ended
    auto key() const { return std::tie(side, kind, points); }
};

namespace {

/// The energy of a gap and its derivatives by the gap: the barrier -(1 - s)^2 ln s of the gap's share s of
/// the thickness (Li et al. 2020), which begins so smoothly that Newton's method sees a contact before it
/// pushes.
struct GapEnergy {
    double value, first, second;
};
GapEnergy gap_energy(double gap, double thickness, double force) {
    if (!(gap < thickness)) return {0, 0, 0};
    const double share = std::max(gap / thickness, kLeastShare);
    const double open = 1 - share, logarithm = std::log(share);
    GapEnergy energy{-open * open * logarithm, 2 * open * logarithm - open * open / share,
                     -2 * logarithm + 4 * open / share + open * open / (share * share)};
    // Nearer, or beyond the plane, where only trials come, the barrier goes on as a parabola.
    const double beyond = gap / thickness - share;
    energy.value += (energy.first + energy.second / 2 * beyond) * beyond;
    energy.first += energy.second * beyond;
    return {force * thickness * energy.value, force * energy.first, force / thickness * energy.second};
}

} // namespace

SurfaceContacts::SurfaceContacts(const Deformable& deformable, const std::vector<Collider>& colliders,
                                 std::span<const double> masses, const SimulationOptions& options)
    : own_(std::make_shared<Elements>(elements_of(deformable))), masses_(masses.begin(), masses.end()),
      collider_count_(colliders.size()), options_(options), impulses_(colliders.size()) {
    const float edge_length = mean_edge_length(*own_, deformable.positions);
    for (const Collider& collider : colliders) {
        const std::vector<std::uint8_t> passes = let_through(deformable, sides_.size());
        const auto own =
            passes.empty() ? own_ : std::make_shared<const Elements>(elements_of(deformable, passes));
        const TriangleMesh mesh = model_mesh(map_of_surface(collider)->view(), collider.scale);
        auto side = std::make_unique<Side>(own, Elements(mesh.vertices.size(), mesh.faces, {}));
        side->obstacle_places.load(mesh.vertices);
        side->thickness = static_cast<float>(*options.thickness);
        side->friction = static_cast<float>(options.friction);
        side->extent = largest_coordinate(side->obstacle_places, mesh.vertices.size());
        side->pairs.set_reach(std::max(2 * side->thickness, kReach * edge_length + side->thickness));
        sides_.push_back(std::move(side));
    }
    most_.assign(own_->vertex_count(), kMostSelfThickness * edge_length);
    for (const Element& element : own_->all)
        for (const std::uint32_t v : element.vertices)
            most_[v] = std::min(most_[v], kMostOfHeight * least_height_of(element, deformable.positions));
    if (options.self_collision) {
        auto side = std::make_unique<Side>(own_);
        side->is_in_world = true;
        side->thickness = static_cast<float>(options.self_thickness.value_or(*options.thickness));
        side->thickness = std::min(side->thickness, kMostSelfThickness * edge_length);
        side->friction = static_cast<float>(options.friction);
        side->pairs.set_reach(std::max(2 * side->thickness, kReach * edge_length));
        sides_.push_back(std::move(side));
    }
    is_touching_.resize(own_->vertex_count());
    safe_places_.resize(own_->vertex_count());
}

SurfaceContacts::SurfaceContacts(const SurfaceContacts& other)
    : own_(other.own_), masses_(other.masses_), collider_count_(other.collider_count_),
      options_(other.options_), most_(other.most_), impulses_(other.impulses_),
      unresolved_count_(other.unresolved_count_), safe_places_(other.safe_places_),
      friction_(other.friction_), is_touching_(other.is_touching_) {
    for (const auto& side : other.sides_) sides_.push_back(std::make_unique<Side>(*side));
}

SurfaceContacts::~SurfaceContacts() = default;

void SurfaceContacts::begin_frame() {
    std::fill(impulses_.begin(), impulses_.end(), Impulse{});
    unresolved_count_ = 0;
}

Load SurfaceContacts::load_on(std::size_t collider, double seconds) const {
    const Impulse& impulse = impulses_[collider];
    return {impulse.linear * (1 / seconds), impulse.angular * (1 / seconds)};
}

std::size_t SurfaceContacts::pair_count() const {
    std::size_t count = 0;
    for (const auto& side : sides_) count += side->pairs.pairs().size();
    return count;
}

void SurfaceContacts::carry(const std::vector<Collider>& before, const std::vector<Collider>& after,
                            const PointArrays& from, PointArrays& carried,
                            std::span<const std::uint8_t> is_held, const Workers& workers) {
    PointArrays wanted = carried;
    for (std::size_t c = 0; c < collider_count_; ++c) {
        sides_[c]->pairs.clear();
        sides_[c]->begin_carrying(before[c].pose, after[c].pose, from);
    }
    if (Side* const own = own_side()) {
        own->pairs.clear();
        own->pairs.list(from, carried, from, carried, workers);
        own->pairs.measure(from, from, workers);
    }
    UnionFind groups(own_->vertex_count());
    for (int round = 0;; ++round) {
        bool is_any_changed = false;
        for (std::size_t c = 0; c < collider_count_; ++c)
            is_any_changed =
                carry_whole(*sides_[c], from, carried, wanted, is_held, workers) || is_any_changed;
        if (Side* const own = own_side())
            is_any_changed = join_closing(*own, from, carried, groups) || is_any_changed;
        if (!is_any_changed) break;
        if (round == kMostCarryRounds) {
            ++unresolved_count_;
            break;
        }
        carry_together(groups, from, wanted, is_held, carried);
    }
    is_carried_ = true;
}

/// Of pairs with a model that carrying would close by more than a share of the gap, the particles go along
/// with the model. @return whether there are any
bool SurfaceContacts::carry_whole(Side& side, const PointArrays& from, const PointArrays& carried,
                                  PointArrays& wanted, std::span<const std::uint8_t> is_held,
                                  const Workers& workers) {
    side.to_frame(carried, side.to);
    side.pairs.list(side.from, side.to, side.obstacle_places, side.obstacle_places, workers);
    side.pairs.measure(side.from, side.obstacle_places, workers);
    bool is_any_changed = false;
    for (std::size_t p = 0; p < side.pairs.pairs().size(); ++p) {
        const Pair& pair = side.pairs.pairs()[p];
        const Separation& apart = side.pairs.separations()[p];
        float closing = 0;
        for (std::size_t k = 0; k < own_count(pair.kind); ++k) {
            const std::uint32_t i = pair.points[k];
            closing = std::max(closing, -dot(apart.normal, side.to[i] - side.from[i]));
        }
        if (closing <= kMostClosed * apart.gap) continue;
        for (std::size_t k = 0; k < own_count(pair.kind); ++k) {
            const std::uint32_t i = pair.points[k];
            const Vec3f whole = side.is_in_world ? from[i] : side.frame.point_to_world(side.from[i]);
            if (is_held[i] != 0 || wanted[i] == whole) continue;
            wanted.set(i, whole);
            is_any_changed = true;
        }
    }
    return is_any_changed;
}

/// Joins the particles of pairs of the surface's own that carrying would close by more than a share of the
/// gap.
bool SurfaceContacts::join_closing(const Side& side, const PointArrays& from, const PointArrays& carried,
                                   UnionFind& groups) {
    bool is_any_joined = false;
    for (std::size_t p = 0; p < side.pairs.pairs().size(); ++p) {
        const Pair& pair = side.pairs.pairs()[p];
        const Separation& apart = side.pairs.separations()[p];
        std::array<float, 2> closing;
        closing.fill(-std::numeric_limits<float>::infinity());
        for (std::size_t k = 0; k < 4; ++k) {
            const std::size_t part = k < own_count(pair.kind) ? 0 : 1;
            const float along = dot(apart.normal, carried[pair.points[k]] - from[pair.points[k]]);
            closing[part] = std::max(closing[part], part == 0 ? -along : along);
        }
        if (closing[0] + closing[1] <= kMostClosed * apart.gap) continue;
        for (const std::uint32_t i : pair.points) {
            is_any_joined = is_any_joined || groups.find(pair.points[0]) != groups.find(i);
            groups.join(pair.points[0], i);
        }
    }
    return is_any_joined;
}

/// Joined particles go with the one that is held among them, or else with the one that is carried farthest:
/// that keeps all gaps among them, and leaves the colliders behind.
void SurfaceContacts::carry_together(UnionFind& groups, const PointArrays& from, const PointArrays& wanted,
                                     std::span<const std::uint8_t> is_held, PointArrays& carried) {
    const auto count = static_cast<std::uint32_t>(is_held.size());
    std::vector<Vec3f> leading(count);
    std::vector<std::uint8_t> is_led(count); // by what is held
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t group = groups.find(i);
        const Vec3f own = wanted[i] - from[i];
        if (is_held[i] == 0 && (is_led[group] != 0 || dot(own, own) <= dot(leading[group], leading[group])))
            continue;
        leading[group] = own;
        is_led[group] = is_held[i];
    }
    std::vector<std::uint32_t> sizes(count);
    for (std::uint32_t i = 0; i < count; ++i) ++sizes[groups.find(i)];
    for (std::uint32_t i = 0; i < count; ++i)
        if (is_held[i] == 0)
            carried.set(i, sizes[groups.find(i)] == 1 ? wanted[i] : from[i] + leading[groups.find(i)]);
}

void SurfaceContacts::begin_step(const std::vector<Collider>& colliders, const PointArrays& places,
                                 Places guess, std::span<const std::uint8_t> is_held, double step,
                                 const Workers& workers) {
    step_ = step;
    is_held_ = is_held;
    is_solved_ = false;
    base_ = safe_ = places;
    for (std::size_t i = 0; i < safe_places_.size(); ++i) safe_places_[i] = Vec3d(places[i]);
    std::fill(is_touching_.begin(), is_touching_.end(), std::uint8_t{0});
    const float extent = largest_coordinate(places, own_->vertex_count());
    for (std::size_t s = 0; s < sides_.size(); ++s) {
        Side& side = *sides_[s];
        if (side.pairs.is_of_itself()) {
            side.least_gap = extent * kLeastGap;
        } else {
            side.least_gap = (extent + side.extent) * kLeastGap;
            side.set_pose(colliders[s].pose);
        }
        if (!is_carried_) side.pairs.clear();
        side.to_frame(base_, side.from);
        list(side, guess, workers);
    }
    is_carried_ = false;
    measure(workers);
    for (const auto& side : sides_)
        for (const Separation& apart : side->pairs.separations())
            if (!(apart.gap > 0)) ++unresolved_count_;
    find_contacts(guess);
}

/// Of displacements from where the step began, to there.
void SurfaceContacts::list(Side& side, Places goals, const Workers& workers) {
    PointArrays world;
    world.resize(own_->vertex_count());
    for (std::size_t i = 0; i < own_->vertex_count(); ++i) world.set(i, Vec3f(goals[i]));
    side.to_frame(world, side.expected);
    side.pairs.list(side.from, side.expected, side.obstacle_at(side.from), side.obstacle_at(side.expected),
                    workers);
}

void SurfaceContacts::measure(const Workers& workers) {
    for (const auto& side : sides_) {
        side->to_frame(safe_, side->to);
        side->pairs.measure(side->to, side->obstacle_at(side->to), workers);
    }
}

/// Lessens the shares of displacements from the safe state to the goals, so that of no pair more than the gap
/// is closed. Each of its parts gets of the gap what it asks for; one that is held all.
void SurfaceContacts::limit(const Side& side, Places goals, std::span<float> shares) const {
    const auto pairs = side.pairs.pairs();
    const auto separations = side.pairs.separations();
    for (std::size_t p = 0; p < pairs.size(); ++p) {
        const Pair& pair = pairs[p];
        const Separation& apart = separations[p];
        const std::size_t own = own_count(pair.kind), moving = side.pairs.moving_count(pair);
        if (!(apart.gap > 0)) {
            for (std::size_t k = 0; k < moving; ++k) shares[pair.points[k]] = 0;
            continue;
        }
        const Vec3d normal(side.is_in_world ? apart.normal : side.frame.normal_to_world(apart.normal));
        std::array<float, 4> closing{};
        std::array<float, 2> most{}; // by part, none if it recedes
        std::array<bool, 2> is_held{};
        for (std::size_t k = 0; k < moving; ++k) {
            const std::uint32_t i = pair.points[k];
            const double along = dot(normal, goals[i] - Vec3d(safe_[i]));
            const std::size_t part = k < own ? 0 : 1;
            closing[k] = static_cast<float>(part == 0 ? -along : along);
            most[part] = std::max(most[part], closing[k]);
            is_held[part] = is_held[part] || (is_held_[i] != 0 && closing[k] > 0);
        }
        const float room = std::max(usable_gap(apart.gap, side.least_gap), 0.0F);
        if (most[0] + most[1] <= room) continue;
        for (std::size_t part = 0; part < 2; ++part) {
            if (!(most[part] > 0) || is_held[part]) continue;
            const float of_other = is_held[1 - part] ? most[1 - part] : 0;
            const float allowed = is_held[1 - part] ? std::max(room - of_other, 0.0F)
                                                    : room * (most[part] / (most[0] + most[1]));
            for (std::size_t k = part == 0 ? 0 : own; k < (part == 0 ? own : moving); ++k) {
                if (!(closing[k] > allowed)) continue;
                float& share = shares[pair.points[k]];
                share = std::min(share, allowed / closing[k] * kAlmost);
            }
        }
    }
}

std::size_t SurfaceContacts::advance(std::span<Vec3d> places, bool is_solved, const Workers& workers) {
    is_solved_ = is_solved;
    const std::size_t count = own_->vertex_count();
    std::vector<float> shares(count);
    std::vector<Vec3d> ends(count);
    const std::vector<Vec3d> goals(places.begin(), places.end());
    for (int round = 0;; ++round) {
        std::fill(shares.begin(), shares.end(), round == kMostRounds ? 0.0F : 1.0F);
        for (const auto& side : sides_) limit(*side, goals, shares);
        for (std::size_t i = 0; i < count; ++i) {
            if (is_held_[i] != 0) shares[i] = 1;
            ends[i] = shares[i] == 1 ? goals[i]
                                     : safe_places_[i] + (goals[i] - safe_places_[i]) * double{shares[i]};
        }
        // Is every end one for which the pairs are listed?
        PointArrays world, in_frame;
        world.resize(count);
        for (std::size_t i = 0; i < count; ++i) world.set(i, Vec3f(ends[i]));
        bool is_covered = true;
        for (const auto& side : sides_) {
            side->to_frame(world, in_frame);
            float farthest_sq = 0;
            for (std::size_t i = 0; i < count; ++i) {
                const Vec3f away = in_frame[i] - side->expected[i];
                farthest_sq = std::max(farthest_sq, dot(away, away));
            }
            if (farthest_sq <= side->pairs.covered() * side->pairs.covered()) continue;
            if (round == kMostRounds) continue; // all stay where they were, which was covered before
            is_covered = false;
            list(*side, ends, workers);
        }
        if (is_covered) break;
        measure(workers);
    }
    std::size_t stopped = 0;
    for (std::size_t i = 0; i < count; ++i) {
        if (shares[i] < 1) {
            ++stopped;
            is_touching_[i] = 1;
        }
        places[i] = ends[i];
        safe_places_[i] = ends[i];
        safe_.set(i, Vec3f(ends[i]));
    }
    measure(workers);
    find_contacts(goals);
    return stopped;
}

/// @param goals  where particles may go: contacts that push there are ready
void SurfaceContacts::find_contacts(Places goals) {
    contacts_.clear();
    for (std::size_t s = 0; s < sides_.size(); ++s) add_contacts(s, goals);
}

void SurfaceContacts::add_contacts(std::size_t side_number, Places goals) {
    const Side& side = *sides_[side_number];
    const auto pairs = side.pairs.pairs();
    const auto separations = side.pairs.separations();
    for (std::size_t p = 0; p < pairs.size(); ++p) {
        const Pair& pair = pairs[p];
        const Separation& apart = separations[p];
        if (!(apart.gap > 0)) continue;
        const std::size_t own = own_count(pair.kind), moving = side.pairs.moving_count(pair);
        float thickness = side.thickness;
        if (side.pairs.is_of_itself())
            for (const std::uint32_t v : pair.points) thickness = std::min(thickness, most_[v]);
        else if (pair.kind != PairKind::VertexFace)
            thickness *= kSurfaceShare;
        // The proven gap may be less than the distance by a tenth: it decides what is measured again in
        // double.
        double approach = 0;
        for (std::size_t k = 0; k < moving; ++k)
            approach = std::max(approach, length(goals[pair.points[k]] - safe_places_[pair.points[k]]));
        if (!(double{apart.gap} - 2 * approach < kReady * double{thickness})) continue;
        std::array<Vec3d, 4> points;
        for (std::size_t k = 0; k < 4; ++k)
            points[k] = k < moving ? safe_places_[pair.points[k]] : side.obstacle_point(pair.points[k]);
        const std::array<double, 4> shares = nearest_points(pair.kind, points);
        Vec3d across;
        for (std::size_t k = 0; k < 4; ++k) across += points[k] * (k < own ? shares[k] : -shares[k]);
        const double distance = length(across);
        if (!(distance > 0)) continue;
        const Vec3d normal = across * (1 / distance);
        Contact contact{};
        double mobility = 0, offset = distance, closing = 0;
        Vec3d relative;
        for (std::size_t k = 0; k < moving; ++k) {
            const std::uint32_t i = pair.points[k];
            const double weight = k < own ? shares[k] : -shares[k];
            contact.particles[k] = i;
            contact.weights[k] = weight;
            relative += safe_places_[i] * weight;
            closing -= weight * dot(normal, goals[i] - safe_places_[i]);
            if (is_held_[i] == 0) mobility += weight * weight / masses_[i];
        }
        for (std::size_t k = moving; k < 4; ++k) contact.particles[k] = pair.points[0];
        if (!(distance - std::max(closing, 0.0) < kReady * double{thickness}) || !(mobility > 0)) continue;
        offset -= dot(normal, relative);
        contact.normal = normal;
        contact.offset = offset;
        contact.thickness = double{thickness};
        const double gravity = length(options_.gravity);
        contact.force =
            (gravity > 0 ? kContactWeights * gravity : contact.thickness / (step_ * step_)) / mobility;
        contact.stiffness = kFrictionStiffness / (mobility * step_ * step_);
        contact.side = static_cast<std::uint32_t>(side_number);
        contact.pair = pair;
        const double push = -gap_energy(distance, contact.thickness, contact.force).first;
        // Where the pair's points were when the step began.
        Vec3d before;
        for (std::size_t k = 0; k < moving; ++k)
            before += Vec3d(base_[contact.particles[k]]) * contact.weights[k];
        const Friction key{contact.side, pair.kind, pair.points, {}, 0};
        const auto found =
            std::lower_bound(friction_.begin(), friction_.end(), key,
                             [](const Friction& a, const Friction& b) { return a.key() < b.key(); });
        const bool is_known = found != friction_.end() && found->key() == key.key();
        contact.most_friction = double{side.friction} * (is_solved_ ? push : is_known ? found->push : 0);
        Vec3d slip;
        if (is_known)
            slip = side.is_in_world ? found->slip : Vec3d(side.frame.normal_to_world(Vec3f(found->slip)));
        contact.slip_offset = slip - before;
        contacts_.push_back(contact);
    }
}

double SurfaceContacts::gap_of(const Contact& contact, Places places) const {
    double gap = contact.offset;
    for (std::size_t k = 0; k < 4; ++k)
        gap += contact.weights[k] * dot(contact.normal, places[contact.particles[k]]);
    return gap;
}

/// Along the contact's plane, since it began to hold.
Vec3d SurfaceContacts::slip_of(const Contact& contact, Places places) const {
    Vec3d slip = contact.slip_offset;
    for (std::size_t k = 0; k < 4; ++k) slip += places[contact.particles[k]] * contact.weights[k];
    return slip - contact.normal * dot(contact.normal, slip);
}

double SurfaceContacts::energy(Places places, const Workers& workers) const {
    return sum_of(contacts_.size(), workers, [&](std::size_t c) {
        const Contact& contact = contacts_[c];
        double energy = gap_energy(gap_of(contact, places), contact.thickness, contact.force).value;
        if (!(contact.most_friction > 0)) return energy;
        const double slip = length(slip_of(contact, places));
        const double most = contact.most_friction, held = most / contact.stiffness;
        return energy + (slip <= held ? contact.stiffness / 2 * slip * slip : most * (slip - held / 2));
    });
}

void SurfaceContacts::add_derivatives(Places places, std::span<Vec3d> gradient, BlockMatrix& hessian,
                                      const Workers&) const {
    std::vector<BlockMatrix::ContactEntry> far;
    for (const Contact& contact : contacts_) {
        const GapEnergy gap = gap_energy(gap_of(contact, places), contact.thickness, contact.force);
        Vec3d force = contact.normal * gap.first;
        Block block;
        const Float4 normal(contact.normal);
        block.add_outer(normal * static_cast<float>(gap.second), normal);
        if (contact.most_friction > 0) {
            const Vec3d slip = slip_of(contact, places);
            const double size = length(slip), held = contact.most_friction / contact.stiffness;
            const bool slips = size > held;
            const double stiffness = slips ? contact.most_friction / size : contact.stiffness;
            force += slip * stiffness;
            const auto tangential = static_cast<float>(stiffness);
            block.add_identity(tangential);
            block.add_outer(normal * -tangential, normal);
            if (slips) {
                const Float4 direction(slip * (1 / size));
                block.add_outer(direction * -tangential, direction);
            }
        } else if (gap.second == 0) {
            continue;
        }
        for (std::size_t k = 0; k < 4; ++k) {
            if (contact.weights[k] == 0) continue;
            const std::uint32_t i = contact.particles[k];
            gradient[i] += force * contact.weights[k];
            for (std::size_t l = 0; l < 4; ++l) {
                const double weight = contact.weights[k] * contact.weights[l];
                if (weight == 0) continue;
                const std::uint32_t j = contact.particles[l];
                const std::uint32_t entry = i == j ? hessian.diagonal[i] : hessian.find_block(i, j);
                if (entry != BlockMatrix::kNone)
                    hessian.blocks.values[entry].add_scaled(block, static_cast<float>(weight));
                else
                    far.push_back({{i, j}, block * static_cast<float>(weight)});
            }
        }
    }
    hessian.set_contacts(std::move(far));
}

std::size_t SurfaceContacts::pushing_count(Places places) const {
    return static_cast<std::size_t>(
        std::count_if(contacts_.begin(), contacts_.end(),
                      [&](const Contact& contact) { return gap_of(contact, places) < contact.thickness; }));
}

void SurfaceContacts::end_step(Places places) {
    friction_.clear();
    for (const Contact& contact : contacts_) {
        const double push = -gap_energy(gap_of(contact, places), contact.thickness, contact.force).first;
        if (push > 0)
            for (std::size_t k = 0; k < 4; ++k)
                if (contact.weights[k] != 0) is_touching_[contact.particles[k]] = 1;
        Vec3d slip;
        if (contact.most_friction > 0) {
            slip = slip_of(contact, places);
            const double size = length(slip), held = contact.most_friction / contact.stiffness;
            if (size > held) slip *= held / size;
        }
        if (contact.side < collider_count_)
            note_load(contact, places, slip * contact.stiffness - contact.normal * push);
        if (!(push > 0)) continue;
        const Side& side = *sides_[contact.side];
        if (!side.is_in_world) {
            const Vec3d origin = side.frame.point_to_world<double>({});
            slip = Vec3d(side.frame.point_to_local(origin + slip));
        }
        friction_.push_back({contact.side, contact.pair.kind, contact.pair.points, slip, push});
    }
    std::sort(friction_.begin(), friction_.end(),
              [](const Friction& a, const Friction& b) { return a.key() < b.key(); });
}

/// @param force  on the collider
void SurfaceContacts::note_load(const Contact& contact, Places places, const Vec3d& force) {
    Vec3d point;
    for (std::size_t k = 0; k < 4; ++k) point += places[contact.particles[k]] * contact.weights[k];
    Impulse& impulse = impulses_[contact.side];
    const Vec3d arm = point - sides_[contact.side]->frame.point_to_world<double>({});
    impulse.linear += force * step_;
    impulse.angular += cross(arm, force) * step_;
}

void SurfaceContacts::archive(StateArchive& state) {
    state.items(friction_, [&](Friction& friction) {
        state.index(friction.side, sides_.size());
        state.choice(friction.kind, PairKind::EdgeEdge);
        state.value(friction.points);
        state.value(friction.slip);
        state.value(friction.push);
    });
    for (Impulse& impulse : impulses_) {
        state.value(impulse.linear);
        state.value(impulse.angular);
    }
    state.require(std::is_sorted(friction_.begin(), friction_.end(),
                                 [](const Friction& a, const Friction& b) { return a.key() < b.key(); }));
}

} // namespace echinus
