#include "simulation/surfaces/self_surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace echinus {

namespace {

/// A share of an element's least height: neighbours of neighbours lie no nearer than a height, and have to
/// move a little.
constexpr float kMostOfHeight = 0.4F;

float least_height(const Element& element, const PointArrays& positions) {
    if (element.vertex_count == 1) return std::numeric_limits<float>::infinity();
    const Vec3f a = positions[element.vertices[0]], b = positions[element.vertices[1]];
    if (element.vertex_count == 2) return length(b - a);
    const Vec3f c = positions[element.vertices[2]];
    const float longest = std::max({length(b - a), length(c - b), length(a - c)});
    return longest > 0 ? length(cross(b - a, c - a)) / longest : 0;
}

} // namespace

SelfSurface::SelfSurface(std::shared_ptr<const Elements> own, const PointArrays& positions,
                         const PairReach& reach, float thickness, float friction)
    : own_(std::move(own)), tree_(*own_, positions), pairs_(*own_, reach), thickness_(thickness),
      friction_(friction), is_measured_(own_->all.size()), is_alert_(own_->vertex_count()) {
    for (const Element& element : own_->all) most_.push_back(kMostOfHeight * least_height(element, positions));
    starts_.resize(own_->vertex_count());
    goals_.resize(own_->vertex_count());
}

void SelfSurface::to_frame(const RigidTransform* frame, const PointArrays& places, PointArrays& result) {
    in_world_ = frame == nullptr;
    if (in_world_) {
        result = places;
        return;
    }
    now_ = FrameChange(*frame, {1, 1, 1});
    for (std::size_t i = 0; i < own_->vertex_count(); ++i) result.set(i, now_.point_to_local(places[i]));
}

void SelfSurface::begin_pass(const RigidTransform* frame, const PointArrays& starts) {
    if (in_world_ != (frame == nullptr)) pairs_.reset();
    to_frame(frame, starts, starts_);
    pairs_.begin({own_.get(), &tree_, &starts_, true}, starts_, {});
    if (!pairs_.needs_listing()) return;
    tree_.refit(*own_, starts_);
    pairs_.list_around_moved();
}

void SelfSurface::set_goals(const RigidTransform* frame, const PointArrays& goals) {
    to_frame(frame, goals, goals_);
}

void SelfSurface::look_ahead(const RigidTransform* frame, const PointArrays& goals) {
    set_goals(frame, goals);
    pairs_.look_ahead(
        goals_, [&](std::span<const std::uint32_t> elements) { forget_contacts(elements); },
        [&](std::uint32_t element, const Pair& pair, const Separation& apart) {
            return consider(element, pair, apart);
        });
    std::fill(is_measured_.begin(), is_measured_.end(), std::uint8_t{0});
}

void SelfSurface::forget_contacts(std::span<const std::uint32_t> elements) {
    std::fill(is_alert_.begin(), is_alert_.end(), std::uint8_t{0});
    for (const std::uint32_t element : elements) is_measured_[element] = 1;
    std::erase_if(contacts_, [&](const Contact& contact) {
        if (is_measured_[contact.element] == 0 && is_measured_[contact.opponent] == 0) return false;
        if (contact.has_pushed)
            for (const std::uint32_t v : contact.pair.particles) is_alert_[v] = 1;
        return true;
    });
}

float SelfSurface::consider(std::uint32_t element, const Pair& pair, const Separation& apart) {
    const float thickness = thickness_of(element, pair.opponent);
    // How far the two sides come towards each other.
    const auto way_of = [&](std::uint32_t v) { return goals_[v] - starts_[v]; };
    float way = 0;
    float readiness = kReadiness;
    for (std::size_t i = 0; i < own_count(pair.kind); ++i)
        for (std::size_t j = own_count(pair.kind); j < 4; ++j)
            way = std::max(way, -dot(apart.normal, way_of(pair.points[i]) - way_of(pair.points[j])));
    for (const std::uint32_t v : pair.points)
        if (is_alert_[v] != 0) readiness = kAlertReadiness;
    if (!(apart.gap < thickness * (1 + readiness) + way)) return apart.gap - thickness;
    // Where both sides are measured, the pair comes twice.
    if (is_measured_[pair.opponent] == 0 || element < pair.opponent) {
        Contact& contact = contacts_.emplace_back();
        contact.pair.particles = pair.points;
        for (std::size_t k = 0; k < 4; ++k)
            contact.pair.weights[k] = k < own_count(pair.kind) ? apart.weights[k] : -apart.weights[k];
        contact.pair.normal = in_world_ ? apart.normal : now_.normal_to_world(apart.normal);
        contact.pair.offset = thickness;
        contact.element = element;
        contact.opponent = pair.opponent;
    }
    return kPlaneReuse * thickness;
}

void SelfSurface::relax(Particles& particles, std::span<const float> inverse_masses,
                        SimulationProfile& profile) {
    for (Contact& contact : contacts_) {
        if (!echinus::relax(contact.pair, inverse_masses, {}, friction_, particles)) continue;
        contact.has_pushed = true;
        ++profile.contact_count;
    }
}

Shares SelfSurface::allowed(std::uint32_t vertex, const Vec3f* from) const {
    if (from == nullptr) return pairs_.allowed(vertex, starts_[vertex], goals_[vertex]);
    return pairs_.allowed(vertex, in_world_ ? *from : now_.point_to_local(*from), goals_[vertex]);
}

} // namespace echinus
