#include "simulation/contact/contact_set.hpp"

#include "geometry/elementary.hpp"
#include "simulation/contact/thresholds.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace echinus {

namespace {

/// The energy of a gap and its derivatives with respect to the gap, from the barrier -(1 - s)^2 ln s with s
/// the ratio of the gap to the thickness (Li et al. 2020), which begins so smoothly that Newton's method sees
/// a contact before it pushes.
struct GapEnergy {
    double value, first, second;
};
GapEnergy gap_energy(double gap, double thickness, double force) {
    if (!(gap < thickness)) return {0, 0, 0};
    const double share = std::max(gap / thickness, threshold::kLeastBarrierShare);
    const double open = 1 - share, logarithm = portable_log(share);
    GapEnergy energy{-open * open * logarithm, 2 * open * logarithm - open * open / share,
                     -2 * logarithm + 4 * open / share + open * open / (share * share)};
    // For smaller gaps, including negative ones, which occur only in trials, the barrier continues as a
    // parabola.
    const double beyond = gap / thickness - share;
    energy.value += (energy.first + energy.second / 2 * beyond) * beyond;
    energy.first += energy.second * beyond;
    return {force * thickness * energy.value, force * energy.first, force / thickness * energy.second};
}

Vec3d turned_to_world(const std::optional<FrameChange>& frame, const Vec3d& local) {
    return frame ? Vec3d(frame->normal_to_world(Vec3f(local))) : local;
}

Vec3d turned_to_local(const std::optional<FrameChange>& frame, const Vec3d& world) {
    if (!frame) return world;
    return Vec3d(frame->point_to_local(frame->point_to_world<double>({}) + world));
}

} // namespace

ContactSet::ContactSet(std::size_t particle_count, std::size_t obstacle_count, std::size_t collider_count,
                       double gravity)
    : gravity_(gravity), obstacle_count_(obstacle_count), first_bristle_(particle_count + 1),
      first_patch_(particle_count), impulses_(collider_count) {}

void ContactSet::begin_frame() {
    std::fill(impulses_.begin(), impulses_.end(), Impulse{});
    recorded_.clear();
    points_.clear();
}

void ContactSet::end_frame() {
    std::sort(recorded_.begin(), recorded_.end(), [](const Recorded& a, const Recorded& b) {
        return std::tuple_cat(a.key.order(), std::tie(a.number)) <
               std::tuple_cat(b.key.order(), std::tie(b.number));
    });
    for (std::size_t i = 0; i < recorded_.size(); ++i) {
        ContactPoint point = recorded_[i].point;
        if (i > 0 && recorded_[i].key.order() == recorded_[i - 1].key.order()) {
            point.normal_impulse += points_.back().normal_impulse;
            point.friction_impulse += points_.back().friction_impulse;
            points_.pop_back();
        }
        points_.push_back(point);
    }
}

void ContactSet::record(const Held& contact, Places places, double push, const Vec3d& friction) {
    const bool is_own = contact.key.obstacle >= impulses_.size();
    const std::size_t first_part = own_count(contact.key.kind);
    ContactPoint point{.position = {},
                       .normal = contact.normal,
                       .gap = gap_of(contact, places),
                       .normal_impulse = push * step_,
                       .friction_impulse = friction * -step_,
                       .collider = is_own ? kNoIndex : contact.key.obstacle,
                       .particles = {}};
    point.particles.fill(kNoIndex);
    std::copy_n(contact.key.points.begin(), is_own ? 4 : first_part, point.particles.begin());
    for (std::size_t k = 0; k < first_part; ++k)
        point.position += places[contact.particles[k]] * contact.weights[k];
    recorded_.push_back({contact.key, static_cast<std::uint32_t>(recorded_.size()), point});
}

Load ContactSet::load_on(std::size_t collider, double seconds) const {
    const Impulse& impulse = impulses_[collider];
    return {impulse.linear * (1 / seconds), impulse.angular * (1 / seconds)};
}

void ContactSet::begin_step(double step, std::span<const std::optional<FrameChange>> frames) {
    step_ = step;
    for (Bristle& bristle : bristles_) {
        const auto& frame = frames[bristle.key.obstacle];
        bristle.normal = turned_to_world(frame, bristle.normal);
        bristle.friction = turned_to_world(frame, bristle.friction);
    }
    index_bristles();
    find_patches();
    find_borne();
    clear();
}

void ContactSet::cancel_step(std::span<const std::optional<FrameChange>> frames) {
    for (Bristle& bristle : bristles_) {
        const auto& frame = frames[bristle.key.obstacle];
        bristle.normal = turned_to_local(frame, bristle.normal);
        bristle.friction = turned_to_local(frame, bristle.friction);
    }
    clear();
}

void ContactSet::set_free_bodies(std::vector<double> masses, std::span<const std::uint32_t> bodies) {
    free_masses_ = std::move(masses);
    bodies_.assign(bodies.begin(), bodies.end());
    borne_.assign(bodies.size(), 0);
}

/// A body is borne not only by the layer that it touches, but also by those below it.
void ContactSet::find_borne() {
    if (free_masses_.empty()) return;
    std::fill(borne_.begin(), borne_.end(), 0);
    for (bool is_any_new = true; is_any_new;) {
        is_any_new = false;
        for (const Bristle& bristle : bristles_) {
            const bool is_own = bristle.key.obstacle >= impulses_.size();
            double& first = borne_[bodies_[bristle.key.points.front()]];
            double& second = is_own ? borne_[bodies_[bristle.key.points.back()]] : first;
            const double most = std::max({first, second, is_own ? 0 : free_masses_[bristle.key.obstacle]});
            is_any_new = is_any_new || first < most || second < most;
            first = second = most;
        }
    }
}

/// The mass of the heaviest free body that this contact may have to bear alone. A barrier that grew only when
/// a body lay on it would be weaker in front of the body than behind it, and would roll the body along.
double ContactSet::borne_by(const Contact& contact) const {
    if (free_masses_.empty()) return 0;
    const double of_first = borne_[bodies_[contact.key.points.front()]];
    return std::max(of_first, contact.key.obstacle < impulses_.size()
                                  ? free_masses_[contact.key.obstacle]
                                  : borne_[bodies_[contact.key.points.back()]]);
}

void ContactSet::index_bristles() {
    std::fill(first_bristle_.begin(), first_bristle_.end(), 0U);
    for (const Bristle& bristle : bristles_) ++first_bristle_[bristle.key.points[0] + 1];
    std::partial_sum(first_bristle_.begin(), first_bristle_.end(), first_bristle_.begin());
}

const ContactSet::Bristle* ContactSet::find(const ContactKey& key) const {
    for (std::uint32_t b = first_bristle_[key.points[0]]; b < first_bristle_[key.points[0] + 1]; ++b)
        if (bristles_[b].key.order() == key.order()) return &bristles_[b];
    return nullptr;
}

/// The bristle that a contact continues: its own, or, if the nearest parts of the two surfaces have changed,
/// the mean of those around it in about the same plane.
ContactSet::Bristle ContactSet::remembered(const Contact& contact) const {
    if (const Bristle* const own = find(contact.key)) return *own;
    Bristle mean{};
    double weights = 0;
    for (std::size_t k = 0; k < 4; ++k) {
        if (contact.weights[k] == 0) continue;
        const double share = std::abs(contact.weights[k]), turn = contact.weights[k] < 0 ? -1 : 1;
        for (std::uint32_t p = first_patch_[contact.particles[k]]; p != kNone; p = patches_[p].next) {
            const Patch& patch = patches_[p];
            if (patch.obstacle != contact.key.obstacle ||
                turn * dot(patch.normal, contact.normal) < threshold::kSamePlane)
                continue;
            mean.friction += patch.friction * (turn * share);
            mean.push += patch.push * share;
            mean.force += patch.force * share;
            weights += patch.weight * share;
        }
    }
    if (!(weights > 0)) return {};
    mean.friction *= 1 / weights;
    mean.push *= 1 / weights;
    mean.force *= 1 / weights;
    return mean;
}

double ContactSet::barrier_force(const Contact& contact, const Bristle& before) const {
    const double of_weight =
        (gravity_ > 0 ? threshold::kBarrierWeights * gravity_ : contact.thickness / (step_ * step_)) /
        contact.mobility;
    const double of_push =
        std::min(before.push * threshold::kBarrierOfPush, before.force * threshold::kMostBarrierGrowth);
    return std::max({of_weight, threshold::kBarrierOfPush * gravity_ * borne_by(contact),
                     std::min(of_push, threshold::kMostBarrierStrain / contact.yielding)});
}

void ContactSet::add(const Contact& contact, const Vec3d& start, std::optional<double> gap) {
    Held held{};
    static_cast<Contact&>(held) = contact;
    const Bristle before = remembered(contact);
    held.force = barrier_force(contact, before);
    held.stiffness = std::max(threshold::kBristleStiffness / (contact.mobility * step_ * step_),
                              contact.friction * before.push / (threshold::kMostBend * contact.thickness));
    const double push = gap ? push_of(held, *gap) : before.push;
    if (contact.friction > 0 && (push > 0 || !gap)) {
        held.most_friction = contact.friction * push;
        held.slip_offset = before.friction * (1 / held.stiffness) - start;
    }
    contacts_.push_back(held);
}

/// The normal force at a gap.
double ContactSet::push_of(const Held& contact, double gap) {
    return -gap_energy(gap, contact.thickness, contact.force).first;
}

double ContactSet::gap_of(const Held& contact, Places places) const {
    double gap = contact.offset;
    for (std::size_t k = 0; k < contact.part_count; ++k)
        gap += contact.weights[k] * dot(contact.normal, places[contact.particles[k]]);
    return gap;
}

/// The slip along the contact's plane since the contact began to hold.
Vec3d ContactSet::slip_of(const Held& contact, Places places) const {
    Vec3d slip = contact.slip_offset;
    for (std::size_t k = 0; k < contact.part_count; ++k)
        slip += places[contact.particles[k]] * contact.weights[k];
    return slip - contact.normal * dot(contact.normal, slip);
}

/// The part of the slip that bends the bristle.
Vec3d ContactSet::held_slip(const Held& contact, Places places) const {
    if (!(contact.most_friction > 0)) return {};
    const Vec3d slip = slip_of(contact, places);
    const double size = length(slip), held = contact.most_friction / contact.stiffness;
    return size > held ? slip * (held / size) : slip;
}

double ContactSet::energy(Places places, const Workers& workers) const {
    return sum_of(contacts_.size(), workers, [&](std::size_t c) {
        const Held& contact = contacts_[c];
        double energy = gap_energy(gap_of(contact, places), contact.thickness, contact.force).value;
        if (!(contact.most_friction > 0)) return energy;
        const double slip = length(slip_of(contact, places));
        const double most = contact.most_friction, held = most / contact.stiffness;
        return energy + (slip <= held ? contact.stiffness / 2 * slip * slip : most * (slip - held / 2));
    });
}

void ContactSet::add_derivatives(Places places, std::span<Vec3d> gradient, BlockMatrix* hessian,
                                 const Workers&) const {
    for (const Held& contact : contacts_) {
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
        for (std::size_t k = 0; k < contact.part_count; ++k) {
            if (contact.weights[k] == 0) continue;
            const std::uint32_t i = contact.particles[k];
            gradient[i] += force * contact.weights[k];
            if (hessian == nullptr) continue;
            for (std::size_t l = 0; l < contact.part_count; ++l) {
                const double weight = contact.weights[k] * contact.weights[l];
                if (weight == 0) continue;
                hessian->add_coupling({i, contact.particles[l]}, block, static_cast<float>(weight));
            }
        }
    }
    if (hessian != nullptr) hessian->set_contacts();
}

std::size_t ContactSet::pushing_count(Places places) const {
    return static_cast<std::size_t>(
        std::count_if(contacts_.begin(), contacts_.end(),
                      [&](const Held& contact) { return gap_of(contact, places) < contact.thickness; }));
}

void ContactSet::end_step(Places places, std::span<const std::optional<FrameChange>> frames,
                          std::span<std::uint8_t> is_touching) {
    bristles_.clear();
    for (const Held& contact : contacts_) {
        const double push = push_of(contact, gap_of(contact, places));
        if (push > 0)
            for (std::size_t k = 0; k < 4; ++k)
                if (contact.weights[k] != 0) is_touching[contact.particles[k]] = 1;
        const Vec3d friction = held_slip(contact, places) * contact.stiffness;
        const std::uint32_t obstacle = contact.key.obstacle;
        const auto& frame = frames[obstacle];
        if (obstacle < impulses_.size())
            add_load(obstacle, point_of(contact, places), contact.normal * push - friction, frame);
        if (records_ && (push > 0 || friction != Vec3d{})) record(contact, places, push, friction);
        if (!(push > 0)) continue;
        Bristle bristle{
            contact.key,  {}, turned_to_local(frame, contact.normal), turned_to_local(frame, friction), push,
            contact.force};
        for (std::size_t k = 0; k < 4; ++k) bristle.weights[k] = static_cast<float>(contact.weights[k]);
        bristles_.push_back(bristle);
    }
    std::sort(bristles_.begin(), bristles_.end(),
              [](const Bristle& a, const Bristle& b) { return a.key.order() < b.key.order(); });
}

/// Sums up the bristles around each particle by planes, since there can be hundreds.
void ContactSet::find_patches() {
    patches_.clear();
    std::fill(first_patch_.begin(), first_patch_.end(), kNone);
    for (const Bristle& bristle : bristles_)
        for (std::size_t k = 0; k < 4; ++k) {
            if (bristle.weights[k] == 0) continue;
            const double weight = std::abs(double{bristle.weights[k]});
            // A pair of the surface with itself may have either orientation: the normal is seen from the
            // particle.
            const double turn = bristle.weights[k] < 0 ? -1 : 1;
            Patch& patch = patch_at(bristle.key.points[k], bristle.key.obstacle, bristle.normal * turn);
            patch.friction += bristle.friction * (turn * weight);
            patch.push += bristle.push * weight;
            patch.force += bristle.force * weight;
            patch.weight += weight;
        }
}

/// The patch of this plane, which may be new.
ContactSet::Patch& ContactSet::patch_at(std::uint32_t particle, std::uint32_t obstacle, const Vec3d& normal) {
    for (std::uint32_t p = first_patch_[particle]; p != kNone; p = patches_[p].next)
        if (patches_[p].obstacle == obstacle && dot(patches_[p].normal, normal) >= threshold::kSamePlane)
            return patches_[p];
    patches_.push_back({obstacle, first_patch_[particle], normal, {}});
    first_patch_[particle] = static_cast<std::uint32_t>(patches_.size() - 1);
    return patches_.back();
}

/// The point at which the deformable touches.
Vec3d ContactSet::point_of(const Held& contact, Places places) const {
    Vec3d point;
    for (std::size_t k = 0; k < 4; ++k) point += places[contact.particles[k]] * contact.weights[k];
    return point;
}

void ContactSet::add_load(std::uint32_t collider, const Vec3d& place, const Vec3d& force,
                          const std::optional<FrameChange>& frame) {
    const Vec3d pivot = frame ? frame->point_to_world<double>({}) : Vec3d{};
    impulses_[collider].linear -= force * step_;
    impulses_[collider].angular -= cross(place - pivot, force) * step_;
}

void ContactSet::turn(std::uint32_t obstacle, const Rotation& turn) {
    for (Bristle& bristle : bristles_)
        if (bristle.key.obstacle == obstacle) {
            bristle.normal = turn.apply(bristle.normal);
            bristle.friction = turn.apply(bristle.friction);
        }
}

void ContactSet::archive(StateArchive& state) {
    state.items(bristles_, [&](Bristle& bristle) {
        state.index(bristle.key.obstacle, obstacle_count_);
        state.choice(bristle.key.kind, PairKind::EdgeEdge);
        state.value(bristle.key.points);
        state.value(bristle.weights);
        state.value(bristle.normal);
        state.value(bristle.friction);
        state.value(bristle.push);
        state.value(bristle.force);
    });
    for (Impulse& impulse : impulses_) {
        state.value(impulse.linear);
        state.value(impulse.angular);
    }
    if (!state.reads()) return;
    recorded_.clear();
    points_.clear();
    state.require(std::is_sorted(bristles_.begin(), bristles_.end(), [](const Bristle& a, const Bristle& b) {
        return a.key.order() < b.key.order();
    }));
    const std::size_t particle_count = first_patch_.size();
    for (const Bristle& bristle : bristles_)
        for (std::size_t k = 0; k < 4; ++k) {
            const bool is_unused =
                k > 0 && bristle.key.obstacle < impulses_.size() && bristle.weights[k] == 0;
            state.require(is_unused || bristle.key.points[k] < particle_count);
        }
}

} // namespace echinus
