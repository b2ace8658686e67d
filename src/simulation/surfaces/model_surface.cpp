#include "simulation/surfaces/model_surface.hpp"

#include "simulation/surfaces/model_mesh.hpp"
#include "simulation/surfaces/sliding.hpp"

#include <echinus/exact_map.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>

namespace echinus {

namespace {

/// Ten degrees, and at a shallow angle.
constexpr SlidingLimits kSliding{.smoothness = 0.985F, .towards = 0.25F};

bool is_identity(const RigidTransform& pose) {
    const Rotation& r = pose.rotation;
    return pose.translation == Vec3d{} && r.x == 0 && r.y == 0 && r.z == 0;
}

} // namespace

ModelSurface::ModelSurface(const Collider& collider, std::shared_ptr<const Elements> own,
                           const PairReach& reach, float thickness, float friction)
    : own_(std::move(own)), pairs_(*own_, reach), now_(collider.pose, {1, 1, 1}), thickness_(thickness),
      friction_(friction) {
    const TriangleMesh mesh = model_mesh(map_of_surface(collider)->view(), collider.scale);
    const auto shape = std::make_shared<Shape>();
    shape->positions.load(mesh.vertices);
    shape->elements = Elements(mesh.vertices.size(), mesh.faces, {});
    shape->tree = ElementTree(shape->elements.all, shape->positions);
    shape_ = shape;
    is_forgotten_.resize(own_->all.size());
    is_alert_.resize(own_->vertex_count());
    starts_.resize(own_->vertex_count());
    bases_.resize(own_->vertex_count());
    goals_.resize(own_->vertex_count());
}

void ModelSurface::to_body(const PointArrays& places, PointArrays& result) const {
    if (at_origin_) {
        result = places;
        return;
    }
    for (std::size_t i = 0; i < own_->vertex_count(); ++i) result.set(i, now_.point_to_local(places[i]));
}

void ModelSurface::begin_frame(const Collider& collider, const SurfaceMotion* motion,
                               const PointArrays& starts, std::span<const float> clearances,
                               const Workers& workers) {
    now_ = FrameChange(collider.pose, {1, 1, 1});
    at_origin_ = is_identity(collider.pose);
    if (motion == nullptr) return begin_pass(starts, clearances);
    deform(*motion, workers);
    motion_ = motion;
    to_body(starts, starts_);
    for (std::size_t v = 0; v < own_->vertex_count(); ++v) bases_.set(v, starts_[v] + motion->carried[v]);
    pairs_.begin({&shape_->elements, &deformed_->tree, &motion->from, &motion->to, motion->most, &ways_},
                 starts_, bases_, clearances);
}

/// The tree covers the ways of this frame, and therefore also where they end.
void ModelSurface::deform(const SurfaceMotion& motion, const Workers& workers) {
    if (!deformed_) {
        deformed_.emplace();
        deformed_->tree = shape_->tree;
    }
    deformed_->positions = motion.to;
    deformed_->tree.refit(shape_->elements.all, motion.from, motion.to, workers);
    if (ways_.wanted.empty()) {
        ways_.from = ways_.to = shape_->tree;
        ways_.wanted.resize(shape_->tree.group_count());
        ways_.want([](std::uint32_t) { return true; }, workers);
    }
    ways_.refit(shape_->elements.all, motion.from, motion.to, workers);
}

void ModelSurface::begin_pass(const PointArrays& starts, std::span<const float> clearances) {
    motion_ = nullptr;
    to_body(starts, starts_);
    bases_ = starts_;
    const Shape& shape = deformed_ ? *deformed_ : *shape_;
    pairs_.begin({&shape_->elements, &shape.tree, &shape.positions}, starts_, bases_, clearances);
}

void ModelSurface::look_ahead(const Collider& collider_at_end, const PointArrays& goals,
                              const Workers& workers) {
    now_ = FrameChange(collider_at_end.pose, {1, 1, 1});
    at_origin_ = is_identity(collider_at_end.pose);
    set_goals(goals);
    pairs_.look_ahead(
        goals_, workers, [&](std::span<const std::uint32_t> elements) { forget_contacts(elements); },
        [&](std::uint32_t element, const Pair& pair, const Separation& apart) {
            return consider(element, pair, apart);
        });
}

void ModelSurface::forget_contacts(std::span<const std::uint32_t> elements) {
    std::fill(is_alert_.begin(), is_alert_.end(), std::uint8_t{0});
    for (const std::uint32_t element : elements) is_forgotten_[element] = 1;
    std::erase_if(contacts_, [&](const Contact& contact) {
        if (is_forgotten_[contact.element] == 0) return false;
        if (contact.has_pushed)
            for (const std::uint32_t v : contact.in_world.particles) is_alert_[v] = 1;
        return true;
    });
    for (const std::uint32_t element : elements) is_forgotten_[element] = 0;
}

float ModelSurface::consider(std::uint32_t element, const Pair& pair, const Separation& apart) {
    // Vertices keep the thickness from the nearest face anyway.
    if (pair.kind == PairKind::VertexFace) return std::numeric_limits<float>::infinity();
    float way = 0;
    float readiness = kReadiness;
    for (std::size_t k = 0; k < own_count(pair.kind); ++k) {
        way = std::max(way, length(goals_[pair.points[k]] - bases_[pair.points[k]]));
        if (is_alert_[pair.points[k]] != 0) readiness = kAlertReadiness;
    }
    if (!(apart.gap < thickness_ * (1 + readiness) + way)) return apart.gap - thickness_;
    if (!slides_past(pair, apart)) add_contact(element, pair, apart);
    return kContactReuse * thickness_;
}

bool ModelSurface::slides_past(const Pair& pair, const Separation& apart) const {
    const std::size_t own = own_count(pair.kind);
    const auto ridge = ridge_of(std::span(pair.points).subspan(own), std::span(apart.weights).subspan(own));
    if (!ridge) return false;
    Vec3f way;
    for (std::size_t k = 0; k < own; ++k)
        way += (goals_[pair.points[k]] - bases_[pair.points[k]]) * apart.weights[k];
    const PointArrays& places = motion_ != nullptr ? motion_->from
                                : deformed_        ? deformed_->positions
                                                   : shape_->positions;
    return faces_at(*ridge, shape_->elements, places, {apart.normal, way}, kSliding) == Faces::Passed;
}

void ModelSurface::add_contact(std::uint32_t element, const Pair& pair, const Separation& apart) {
    Contact& contact = contacts_.emplace_back();
    const std::size_t own = own_count(pair.kind);
    for (std::size_t k = 0; k < 4; ++k) {
        contact.in_world.particles[k] = pair.points[k < own ? k : 0];
        contact.in_world.weights[k] = k < own ? apart.weights[k] : 0;
    }
    float level = -std::numeric_limits<float>::infinity();
    const PointArrays& model = deformed_ ? deformed_->positions : shape_->positions;
    for (std::size_t k = own; k < 4; ++k) {
        const std::uint32_t vertex = pair.points[k];
        level = std::max(level, dot(apart.normal, model[vertex]));
        if (motion_ != nullptr)
            contact.drift_body += (motion_->to[vertex] - motion_->from[vertex]) * apart.weights[k];
    }
    contact.element = element;
    contact.normal_body = apart.normal;
    contact.offset_body = level + thickness_;
    place(contact);
}

void ModelSurface::place(Contact& contact) const {
    contact.in_world.normal = now_.normal_to_world(contact.normal_body);
    const Vec3f on_plane = now_.point_to_world(contact.normal_body * contact.offset_body);
    contact.in_world.offset = dot(contact.in_world.normal, on_plane);
}

void ModelSurface::begin_substep(const Collider& collider, const RigidTransform& previous_pose,
                                 std::uint32_t substeps) {
    material_ = MaterialMotion(previous_pose, collider.pose);
    drift_share_ = motion_ != nullptr ? 1 / static_cast<float>(substeps) : 0;
    if (!collider.moves()) return;
    now_ = FrameChange(collider.pose, {1, 1, 1});
    at_origin_ = is_identity(collider.pose);
    for (Contact& contact : contacts_) place(contact);
}

void ModelSurface::relax(Particles& particles, std::span<const float> inverse_masses,
                         SimulationProfile& profile, std::span<const std::uint8_t> chosen) {
    for (Contact& contact : contacts_) {
        const auto& at = contact.in_world.particles;
        if (!chosen.empty() && (chosen[at[0]] | chosen[at[1]] | chosen[at[2]]) == 0) continue;
        Vec3f point;
        for (std::size_t k = 0; k < 3; ++k)
            point += particles.positions[contact.in_world.particles[k]] * contact.in_world.weights[k];
        const Vec3f drift = now_.normal_to_world(contact.drift_body) * drift_share_;
        if (!echinus::relax(contact.in_world, inverse_masses, material_.at(point) + drift, friction_,
                            particles))
            continue;
        contact.has_pushed = true;
        ++profile.contact_count;
    }
}

void ModelSurface::archive(StateArchive& state) {
    state.optional(deformed_, [&](Shape& deformed) {
        if (state.reads()) {
            deformed.tree = shape_->tree;
            deformed.positions = shape_->positions;
        }
        state.points(deformed.positions);
        deformed.tree.archive(state);
    });
    pairs_.archive(state, shape_->elements.vertex_count());
    state.items(contacts_, [&](Contact& contact) {
        echinus::archive(state, contact.in_world, own_->vertex_count());
        state.value(contact.normal_body);
        state.value(contact.drift_body);
        state.value(contact.offset_body);
        state.index(contact.element, own_->all.size());
        state.flag(contact.has_pushed);
    });
}

void ModelSurface::set_goals(const PointArrays& goals) {
    to_body(goals, goals_);
}

} // namespace echinus
