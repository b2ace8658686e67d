#include "simulation/surfaces/self_surface.hpp"

#include "simulation/surfaces/near_elements.hpp"
#include "simulation/surfaces/shares.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace echinus {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// After so many rounds a way that is still too long is given up.
constexpr int kRounds = 12;

/// No way is shortened to quite the length that is left.
constexpr float kAlmost = 1 - 1.0F / (1 << 10);

/// Where fewer vertices than one in so many have left their ways, only what is near them is searched for.
constexpr std::size_t kFewMoved = 8;

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
    for (PointArrays* points : {&starts_, &goals_, &anchors_, &searched_from_, &searched_to_})
        points->resize(count);
    rooms_.assign(count, -1);
    quiet_.assign(count, -1);
    is_alert_.assign(count, 0);
    has_moved_.assign(count, 0);
    if (!faces_.empty()) face_tree_ = ElementTree(faces_, particles.positions);
    if (!edges_.empty()) edge_tree_ = ElementTree(edges_, particles.positions);
    vertex_tree_ = ElementTree(vertices_, particles.positions);
}

// ---- The frame

void SelfSurface::to_frame(const RigidTransform* frame, const PointArrays& places, PointArrays& result) {
    if (in_world_ != (frame == nullptr)) {
        in_world_ = frame == nullptr;
        has_searched_ = false;
        std::fill(rooms_.begin(), rooms_.end(), -1.0F);
        std::fill(quiet_.begin(), quiet_.end(), -1.0F);
    }
    if (!in_world_) now_ = FrameChange(*frame, {1, 1, 1});
    for (std::size_t i = 0; i < own_->vertex_count(); ++i)
        result.set(i, (in_world_ ? places[i] : now_.point_to_local(places[i])) - drift_);
}

void SelfSurface::begin_pass(const RigidTransform* frame, const PointArrays& starts) {
    drift_ = drift_ + drifting_;
    drifting_ = {};
    to_frame(frame, starts, starts_);
    is_measured_ = false;
    searched_from_ = searched_to_;
}

void SelfSurface::set_goals(const RigidTransform* frame, const PointArrays& goals) {
    to_frame(frame, goals, goals_);
    Vec3d sum;
    double count = 0;
    for (std::size_t i = 0; i < own_->vertex_count(); ++i) {
        sum += Vec3d(goals_[i] - starts_[i]) * static_cast<double>(mobility_[i]);
        count += static_cast<double>(mobility_[i]);
    }
    drifting_ = count > 0 ? Vec3f(sum * (1 / count)) : Vec3f{};
}

/// A way that was proven otherwise may have led out of a room, and the next one may lead back into it.
bool SelfSurface::all_within(std::span<const float> radii) const {
    const auto is_within = [&](const Vec3f& place, std::size_t v) {
        const Vec3f way = place - anchors_[v];
        return dot(way, way) <= radii[v] * std::fabs(radii[v]);
    };
    for (std::size_t v = 0; v < own_->vertex_count(); ++v)
        if (!is_within(starts_[v], v) || !is_within(goals_[v] - drifting_, v)) return false;
    return true;
}

// ---- Pairs

/// Pairs were dropped since a plane separates them widely both at the beginning and at the end of the ways
/// for which they were searched. So it does while their vertices stay near such a way in time, in the pass in
/// which it begins, and later while they stay near its end.
bool SelfSurface::is_off_its_way(std::uint32_t v) const {
    if (!has_searched_) return true;
    const auto is_near = [&](const Vec3f& place) {
        const Vec3f away = place - searched_to_[v];
        return dot(away, away) <= reach_.slack * reach_.slack;
    };
    return !(is_near(goals_[v] - drifting_) && (searched_from_[v] == starts_[v] || is_near(starts_[v])));
}

/// Which pairs are listed depends on the way of each vertex for which they were searched last.
void SelfSurface::list_pairs() {
    std::size_t moved_count = 0;
    for (std::uint32_t v = 0; v < own_->vertex_count(); ++v) {
        has_moved_[v] = is_off_its_way(v) ? 1 : 0;
        if (has_moved_[v] == 0) continue;
        ++moved_count;
        searched_from_.set(v, starts_[v]);
        searched_to_.set(v, goals_[v] - drifting_);
    }
    if (moved_count == 0) return;
    is_measured_ = false;
    has_searched_ = true;
    face_tree_.refit(faces_, searched_from_, searched_to_);
    edge_tree_.refit(edges_, searched_from_, searched_to_);
    vertex_tree_.refit(vertices_, searched_from_, searched_to_);
    candidates_.clear();
    if (moved_count > own_->vertex_count() / kFewMoved)
        search_everywhere();
    else
        search_around_moved();
    keep_near();
}

void SelfSurface::search_everywhere() {
    searched_count += faces_.size();
    pairs_.clear();
    const float reach = reach_.near + 2 * reach_.slack;
    near_.clear();
    find_near(vertex_tree_, face_tree_, reach, near_);
    for (const auto& [vertex, face] : near_) add_vertex_face(vertex, face);
    near_.clear();
    find_near(edge_tree_, edge_tree_, reach, near_);
    for (const auto& [a, b] : near_) add_edge_edge(a, b);
}

void SelfSurface::search_around_moved() {
    const auto is_moved = [&](const Element& element) {
        return (has_moved_[element.vertices[0]] | has_moved_[element.vertices[1]] |
                has_moved_[element.vertices[2]]) != 0;
    };
    std::erase_if(pairs_, [&](const Pair& pair) {
        return std::any_of(pair.points.begin(), pair.points.end(),
                           [&](std::uint32_t v) { return has_moved_[v] != 0; });
    });
    const auto find_around = [&](std::span<const Element> elements, const ElementTree& others) {
        wanted_.clear();
        boxes_.clear();
        for (std::uint32_t e = 0; e < elements.size(); ++e) {
            if (!is_moved(elements[e])) continue;
            wanted_.push_back(e);
            boxes_.push_back(box_of(elements[e], searched_from_, searched_to_));
        }
        near_.clear();
        find_near(boxes_, others, reach_.near + 2 * reach_.slack, near_);
    };
    find_around(vertices_, face_tree_);
    for (const auto& [i, face] : near_) add_vertex_face(wanted_[i], face);
    find_around(faces_, vertex_tree_);
    searched_count += wanted_.size();
    for (const auto& [i, vertex] : near_)
        if (has_moved_[vertex] == 0) add_vertex_face(vertex, wanted_[i]);
    find_around(edges_, edge_tree_);
    for (const auto& [i, b] : near_) // two that moved are found from both sides
        if (wanted_[i] < b || !is_moved(edges_[b])) add_edge_edge(wanted_[i], b);
}

void SelfSurface::add_vertex_face(std::uint32_t vertex, std::uint32_t face) {
    const auto& corners = faces_[face].vertices;
    if (!faces_[face].has(vertex))
        candidates_.push_back({{vertex, corners[0], corners[1], corners[2]}, face, PairKind::VertexFace});
}

void SelfSurface::add_edge_edge(std::uint32_t a, std::uint32_t b) {
    const auto& p = edges_[a].vertices;
    const auto& q = edges_[b].vertices;
    if (p[0] != q[0] && p[0] != q[1] && p[1] != q[0] && p[1] != q[1])
        candidates_.push_back({{p[0], p[1], q[0], q[1]}, b, PairKind::EdgeEdge});
}

/// Of the candidates, those that may come near on their ways, which they go together.
void SelfSurface::keep_near() {
    separations_.resize(candidates_.size());
    separations(candidates_, searched_from_, searched_from_, separations_);
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
        const Pair& pair = candidates_[i];
        const Vec3f normal = separations_[i].normal;
        const std::size_t own = own_count(pair.kind);
        float least = kInfinity, most = -kInfinity;
        for (std::size_t k = 0; k < 4; ++k) {
            const float height = dot(normal, searched_to_[pair.points[k]] - searched_from_[pair.points[0]]);
            least = k < own ? std::min(least, height) : least;
            most = k < own ? most : std::max(most, height);
        }
        const float gap = std::min(separations_[i].gap, least - most);
        if (gap <= reach_.near + 2 * reach_.slack) pairs_.push_back(pair);
    }
}

/// Gives every vertex a new room where it is.
void SelfSurface::measure() {
    if (is_measured_) return;
    is_measured_ = true;
    separations_.resize(pairs_.size());
    separations(pairs_, starts_, starts_, separations_);
    measured_count += pairs_.size();
    anchors_ = starts_;
    const float unlisted = usable_gap(reach_.near, reach_.least_gap) / 2;
    std::fill(rooms_.begin(), rooms_.end(), unlisted);
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
        const float by_gap = usable_gap(separations_[i].gap, reach_.least_gap) / 2;
        for (const std::uint32_t v : pairs_[i].points) rooms_[v] = std::min(rooms_[v], by_gap);
    }
    std::fill(quiet_.begin(), quiet_.end(), -1.0F); // the next frame looks for contacts
}

// ---- Contacts

void SelfSurface::look_ahead(const RigidTransform* frame, const PointArrays& goals) {
    set_goals(frame, goals);
    if (all_within(quiet_)) return;
    std::fill(is_alert_.begin(), is_alert_.end(), std::uint8_t{0});
    for (const Contact& contact : contacts_)
        if (contact.has_pushed)
            for (const std::uint32_t v : contact.pair.particles) is_alert_[v] = 1;
    contacts_.clear();
    list_pairs();
    measure();
    std::fill(quiet_.begin(), quiet_.end(), reach_.near / 2);
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

/// By how much the gap of a pair shrinks along its normal on the way to the goals.
float SelfSurface::closing(const Pair& pair, const Separation& apart) const {
    const auto along = [&](std::uint32_t v) { return dot(apart.normal, goals_[v] - starts_[v]); };
    const std::size_t own = own_count(pair.kind);
    float least = along(pair.points[0]), most = along(pair.points[own]);
    for (std::size_t k = 1; k < own; ++k) least = std::min(least, along(pair.points[k]));
    for (std::size_t k = own + 1; k < 4; ++k) most = std::max(most, along(pair.points[k]));
    return std::max(most - least, 0.0F);
}

/// @return how far each of the pair's vertices may go before it has to be measured again
float SelfSurface::consider(const Pair& pair, const Separation& apart) {
    const float thickness = thickness_of(pair);
    const bool is_alert = std::any_of(pair.points.begin(), pair.points.end(),
                                      [&](std::uint32_t v) { return is_alert_[v] != 0; });
    const float ready = thickness * (1 + (is_alert ? kAlertReadiness : kReadiness));
    if (!(apart.gap < ready + closing(pair, apart))) return (apart.gap - thickness) / 2;
    const std::size_t own = own_count(pair.kind);
    Contact& contact = contacts_.emplace_back();
    contact.pair.particles = pair.points;
    for (std::size_t k = 0; k < 4; ++k)
        contact.pair.weights[k] = k < own ? apart.weights[k] : -apart.weights[k];
    contact.pair.normal = in_world_ ? apart.normal : now_.normal_to_world(apart.normal);
    contact.pair.offset = thickness;
    return kContactReuse * thickness;
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

/// A vertex that ends early does not drift on with the others: it leaves the way for which its pairs were
/// listed, and the next round finds what is near its new one.
std::span<const float> SelfSurface::allowed_shares(const RigidTransform* frame, const PointArrays& goals) {
    set_goals(frame, goals);
    stuck_count_ = 0;
    if (all_within(rooms_)) return {};
    list_pairs();
    measure();
    shares_.assign(own_->vertex_count(), 1);
    whole_goals_ = goals_;
    for (int round = 0; shorten_ways(round); ++round) {
        for (std::uint32_t v = 0; v < own_->vertex_count(); ++v)
            if (shares_[v] != 1) goals_.set(v, starts_[v] + (whole_goals_[v] - starts_[v]) * shares_[v]);
        list_pairs();
        measure();
    }
    return shares_;
}

/// Shortens the ways of pairs that could meet. @return whether there were any
bool SelfSurface::shorten_ways(int round) {
    bool found = false;
    stuck_count_ = 0;
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
        const Pair& pair = pairs_[i];
        const Separation& apart = separations_[i];
        const std::size_t own = own_count(pair.kind);
        const Vec3f origin = starts_[pair.points[0]];
        float least = kInfinity, most = -kInfinity;
        for (std::size_t k = 0; k < 4; ++k) {
            const std::uint32_t v = pair.points[k];
            const Vec3f end = starts_[v] + (whole_goals_[v] - starts_[v]) * shares_[v];
            const float height = dot(apart.normal, end - origin);
            least = k < own ? std::min(least, height) : least;
            most = k < own ? most : std::max(most, height);
        }
        const float kept = apart.gap - std::max(usable_gap(apart.gap, reach_.least_gap), 0.0F);
        const float at_end = least - most;
        if (apart.gap > 0 && at_end >= kept) continue;
        const float share = round < kRounds && apart.gap > kept
                                ? std::clamp((apart.gap - kept) / (apart.gap - at_end), 0.0F, 1.0F) * kAlmost
                                : 0.0F;
        bool can_be_shortened = false, moves = false;
        for (const std::uint32_t v : pair.points) {
            moves = moves || (mobility_[v] == 0 && whole_goals_[v] != starts_[v]);
            if (shares_[v] == 0 || mobility_[v] == 0) continue;
            shares_[v] *= share;
            can_be_shortened = true;
        }
        found = found || can_be_shortened;
        if (!can_be_shortened && moves) ++stuck_count_;
    }
    return found;
}

} // namespace echinus
