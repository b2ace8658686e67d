#include "simulation/surfaces/self_surface.hpp"

#include "simulation/surfaces/near_elements.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace echinus {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// A share of an element's least height: neighbours of neighbours lie no nearer than a height, and have to
/// move a little.
constexpr float kMostOfHeight = 0.4F;

float least_height(const Element& element, const PointArrays& positions) {
    if (element.vertex_count == 1) return kInfinity;
    const Vec3f a = positions[element.vertices[0]], b = positions[element.vertices[1]];
    if (element.vertex_count == 2) return length(b - a);
    const Vec3f c = positions[element.vertices[2]];
    const float longest = std::max({length(b - a), length(c - b), length(a - c)});
    return longest > 0 ? length(cross(b - a, c - a)) / longest : 0;
}

std::vector<Element> faces_of(const Elements& elements) {
    std::vector<Element> faces;
    for (const Element& element : elements.all)
        if (element.is_face()) faces.push_back(element);
    return faces;
}

std::vector<Element> edges_of(const Elements& elements) {
    std::vector<Element> edges;
    for (const auto& [a, b] : elements.edges) edges.push_back({.vertices = {a, b, b}, .vertex_count = 2});
    return edges;
}

std::vector<Element> vertices_of(const Elements& elements) {
    std::vector<Element> vertices;
    for (std::uint32_t v = 0; v < elements.vertex_count(); ++v)
        vertices.push_back({.vertices = {v, v, v}, .vertex_count = 1});
    return vertices;
}

} // namespace

SelfSurface::SelfSurface(std::shared_ptr<const Elements> own, const Particles& particles, const Reach& reach,
                         float thickness, float friction)
    : own_(std::move(own)), faces_(faces_of(*own_)), edges_(edges_of(*own_)), vertices_(vertices_of(*own_)),
      reach_(reach), thickness_(thickness), friction_(friction), mobility_(particles.mobility) {
    const std::size_t count = own_->vertex_count();
    most_.assign(count, kInfinity);
    for (const Element& element : own_->all) {
        const float most = kMostOfHeight * least_height(element, particles.positions);
        for (const std::uint32_t v : element.vertices) most_[v] = std::min(most_[v], most);
    }
    for (PointArrays* points : {&starts_, &goals_, &anchors_, &searched_at_}) points->resize(count);
    rooms_.assign(count, -1);
    quiet_.assign(count, -1);
    is_alert_.assign(count, 0);
    leaving_.reserve(count);
    if (!faces_.empty()) face_tree_ = ElementTree(faces_, particles.positions);
    if (!edges_.empty()) edge_tree_ = ElementTree(edges_, particles.positions);
    if (!vertices_.empty()) vertex_tree_ = ElementTree(vertices_, particles.positions);
}

// ---- The frame

void SelfSurface::to_frame(const RigidTransform* frame, const PointArrays& places, PointArrays& result) {
    if (in_world_ != (frame == nullptr)) {
        in_world_ = frame == nullptr;
        has_searched_ = false;
        std::fill(rooms_.begin(), rooms_.end(), -1.0F);
        std::fill(quiet_.begin(), quiet_.end(), -1.0F);
    }
    if (in_world_) {
        result = places;
        return;
    }
    now_ = FrameChange(*frame, {1, 1, 1});
    for (std::size_t i = 0; i < own_->vertex_count(); ++i) result.set(i, now_.point_to_local(places[i]));
}

void SelfSurface::take_off(const Vec3f& drift, PointArrays& places) const {
    for (std::size_t i = 0; i < own_->vertex_count(); ++i) places.set(i, places[i] - drift);
}

void SelfSurface::begin_pass(const RigidTransform* frame, const PointArrays& starts) {
    drift_ = drift_goal_;
    to_frame(frame, starts, starts_);
    take_off(drift_, starts_);
    is_measured_ = false;
}

void SelfSurface::set_goals(const RigidTransform* frame, const PointArrays& goals, bool drifts) {
    drifts_ = drifts;
    to_frame(frame, goals, goals_);
    Vec3d sum;
    double count = 0;
    if (drifts)
        for (std::size_t i = 0; i < own_->vertex_count(); ++i) {
            if (mobility_[i] == 0) continue;
            sum += Vec3d(goals_[i] - drift_ - starts_[i]);
            ++count;
        }
    drift_goal_ = drift_ + (count > 0 ? Vec3f(sum * (1 / count)) : Vec3f{});
    take_off(drift_goal_, goals_);
}

// ---- Pairs

void SelfSurface::search() {
    ++search_count;
    has_searched_ = true;
    searched_at_ = starts_;
    face_tree_.refit(faces_, starts_);
    edge_tree_.refit(edges_, starts_);
    vertex_tree_.refit(vertices_, starts_);
    candidates_.clear();
    near_.clear();
    find_near(vertex_tree_, face_tree_, reach_.listed, near_);
    for (const auto& [vertex, face] : near_) {
        const auto& corners = faces_[face].vertices;
        if (!faces_[face].has(vertex))
            candidates_.push_back({{vertex, corners[0], corners[1], corners[2]}, face, PairKind::VertexFace});
    }
    near_.clear();
    find_near(edge_tree_, edge_tree_, reach_.listed, near_);
    for (const auto& [a, b] : near_) {
        const auto& p = edges_[a].vertices;
        const auto& q = edges_[b].vertices;
        if (p[0] != q[0] && p[0] != q[1] && p[1] != q[0] && p[1] != q[1])
            candidates_.push_back({{p[0], p[1], q[0], q[1]}, b, PairKind::EdgeEdge});
    }
    separations_.resize(candidates_.size());
    separations(candidates_, starts_, starts_, separations_);
    pairs_.clear();
    for (std::size_t i = 0; i < candidates_.size(); ++i)
        if (separations_[i].gap <= reach_.listed) pairs_.push_back(candidates_[i]);
}

/// Gives every vertex a new room where it is.
void SelfSurface::measure() {
    float moved_sq = 0;
    for (std::size_t i = 0; i < own_->vertex_count() && has_searched_; ++i) {
        const Vec3f moved = starts_[i] - searched_at_[i];
        moved_sq = std::max(moved_sq, dot(moved, moved));
    }
    if (!has_searched_ || !(moved_sq <= reach_.slack * reach_.slack)) {
        search();
        moved_sq = 0;
    }
    separations_.resize(pairs_.size());
    separations(pairs_, starts_, starts_, separations_);
    measured_count += pairs_.size();
    anchors_ = starts_;
    unlisted_room_ = usable(reach_.listed - 2 * std::sqrt(moved_sq)) / 2;
    std::fill(rooms_.begin(), rooms_.end(), unlisted_room_);
    std::fill(quiet_.begin(), quiet_.end(), unlisted_room_);
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
        const float by_gap = usable(separations_[i].gap) / 2;
        for (const std::uint32_t v : pairs_[i].points) rooms_[v] = std::min(rooms_[v], by_gap);
    }
    is_measured_ = true;
}

bool SelfSurface::is_beyond(std::uint32_t vertex, float radius) const {
    const Vec3f way = goals_[vertex] - anchors_[vertex];
    return !(dot(way, way) <= radius * std::fabs(radius));
}

// ---- Contacts

void SelfSurface::look_ahead(const RigidTransform* frame, const PointArrays& goals) {
    set_goals(frame, goals, true);
    bool is_quiet = true;
    for (std::uint32_t v = 0; v < own_->vertex_count() && is_quiet; ++v) is_quiet = !is_beyond(v, quiet_[v]);
    if (is_quiet) return;
    std::fill(is_alert_.begin(), is_alert_.end(), std::uint8_t{0});
    for (const Contact& contact : contacts_)
        if (contact.has_pushed)
            for (const std::uint32_t v : contact.pair.particles) is_alert_[v] = 1;
    contacts_.clear();
    measure();
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
        const float quiet = consider(pairs_[i], separations_[i]);
        for (const std::uint32_t v : pairs_[i].points) quiet_[v] = std::min(quiet_[v], quiet);
    }
}

float SelfSurface::thickness_of(const Pair& pair) const {
    float thickness = thickness_;
    for (const std::uint32_t v : pair.points) thickness = std::min(thickness, most_[v]);
    return thickness;
}

/// @return how far each of the pair's vertices may go before it has to be measured again
float SelfSurface::consider(const Pair& pair, const Separation& apart) {
    const float thickness = thickness_of(pair);
    const auto way_of = [&](std::uint32_t v) { return goals_[v] - starts_[v]; };
    const std::size_t own = own_count(pair.kind);
    float closing = 0;
    for (std::size_t i = 0; i < own; ++i)
        for (std::size_t j = own; j < 4; ++j)
            closing = std::max(closing, -dot(apart.normal, way_of(pair.points[i]) - way_of(pair.points[j])));
    const bool is_alert = std::any_of(pair.points.begin(), pair.points.end(),
                                      [&](std::uint32_t v) { return is_alert_[v] != 0; });
    const float ready = thickness * (1 + (is_alert ? kAlertReadiness : kReadiness)) + closing;
    if (!(apart.gap < ready)) return (apart.gap - thickness) / 2;
    Contact& contact = contacts_.emplace_back();
    contact.pair.particles = pair.points;
    for (std::size_t k = 0; k < 4; ++k)
        contact.pair.weights[k] = k < own ? apart.weights[k] : -apart.weights[k];
    contact.pair.normal = in_world_ ? apart.normal : now_.normal_to_world(apart.normal);
    contact.pair.offset = thickness;
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

// ---- Truncation

bool SelfSurface::renew() {
    if (is_measured_) return false;
    measure();
    std::fill(quiet_.begin(), quiet_.end(), -1.0F); // too late for contacts: the next frame looks
    return true;
}

std::span<const std::uint32_t> SelfSurface::find_leaving() {
    do {
        leaving_.clear();
        for (std::uint32_t v = 0; v < own_->vertex_count(); ++v)
            if (is_beyond(v, rooms_[v])) leaving_.push_back(v);
    } while (!leaving_.empty() && renew());
    return leaving_;
}

void SelfSurface::prepare(std::span<const std::uint32_t> vertices) {
    const auto for_each_wanted = [&](const auto& visit) {
        for (std::uint32_t i = 0; i < pairs_.size(); ++i)
            for (const std::uint32_t v : pairs_[i].points)
                if (is_wanted_[v] != 0) visit(v, i);
    };
    is_wanted_.assign(own_->vertex_count(), 0);
    for (const std::uint32_t v : vertices) is_wanted_[v] = 1;
    pair_offsets_.assign(own_->vertex_count() + 1, 0);
    for_each_wanted([&](std::uint32_t v, std::uint32_t) { ++pair_offsets_[v + 1]; });
    for (std::size_t v = 0; v < own_->vertex_count(); ++v) pair_offsets_[v + 1] += pair_offsets_[v];
    pairs_at_.resize(pair_offsets_.back());
    next_ = pair_offsets_;
    for_each_wanted([&](std::uint32_t v, std::uint32_t i) { pairs_at_[next_[v]++] = i; });
}

Shares SelfSurface::allowed(std::uint32_t vertex, const Vec3f& from) const {
    const Vec3f start = starts_[vertex];
    // Without drift the way begins where the vertex is, but for rounding.
    const Vec3f offset = drifts_ ? into_frame(from) - drift_goal_ - start : Vec3f{};
    const Vec3f way = goals_[vertex] - start;
    Shares shares;
    shares.keep_in_ball(offset, way - offset, unlisted_room_);
    for (std::uint32_t n = pair_offsets_[vertex]; n < pair_offsets_[vertex + 1]; ++n) {
        const Pair& pair = pairs_[pairs_at_[n]];
        const Separation& apart = separations_[pairs_at_[n]];
        const std::size_t own = own_count(pair.kind);
        const auto place = static_cast<std::size_t>(
            std::find(pair.points.begin(), pair.points.end(), vertex) - pair.points.begin());
        const std::size_t first = place < own ? 0 : own, last = place < own ? own : 4;
        const Vec3f away = place < own ? apart.normal : -apart.normal;
        // How far beyond its side's nearest vertex to the other side the vertex begins.
        float behind = kInfinity;
        for (std::size_t k = first; k < last; ++k)
            behind = std::min(behind, dot(away, starts_[pair.points[k]] - start));
        const float allowed_way = std::max(usable(apart.gap) / 2, 0.0F) - behind;
        shares.keep_not_negative(dot(away, offset) + allowed_way, dot(away, way) + allowed_way);
    }
    return shares;
}

} // namespace echinus
