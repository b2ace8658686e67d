#include "simulation/surfaces/self_surface.hpp"

#include "simulation/surfaces/pair_lists.hpp"
#include "simulation/surfaces/shares.hpp"
#include "simulation/surfaces/sliding.hpp"
#include "simulation/surfaces/turning_plane.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>

namespace echinus {

namespace {

constexpr float kUnlimited = std::numeric_limits<float>::infinity();

/// Of loops over vertices and over pairs.
constexpr std::size_t kVerticesPerPiece = 1024, kOwnPairsPerPiece = 512;

/// After so many rounds a way that is still too long is given up.
constexpr int kRounds = 12;

/// Pairs are listed for at most so many frames: for more, more are near some time; for fewer, the search
/// comes more often. And for no more than in which a vertex goes so many times the distance called near.
constexpr std::uint32_t kMostFrames = 6;
constexpr float kMostWay = 4;

/// Pairs of a vertex are listed for one pass only: for this one, for one before.
constexpr std::uint8_t kNow = 1, kOver = 2;

/// A pair that is led on one way stays as far apart but for rounding, which is so large a share of the least
/// gap. Of that more may be lost, frame by frame, but for a rest that no rounding in a frame takes.
constexpr float kRigidTolerance = 1.0F / 32, kLeastShare = 1.0F / 8;
/// A pair that a plane kept apart which turned can still be led on one way in later frames.
constexpr float kLeastTurningShare = 1.0F / 4;

/// Of layers that slide over each other: three degrees, since a sheet that crumples needs the contacts of its
/// edges. What is nearer to the faces around an edge than half a thickness lies beside it.
constexpr SlidingLimits kOwnSliding{.smoothness = 0.9985F, .towards = 0.7F};
constexpr float kLeastHeight = 0.5F;

/// No way is shortened to quite the length that is left.
constexpr float kAlmost = 1 - 1.0F / (1 << 10);

/// A share of an element's least height: neighbours of neighbours lie no nearer than a height, and have to
/// move a little.
constexpr float kMostOfHeight = 0.4F;

float least_height(const Element& element, const PointArrays& positions) {
    if (element.vertex_count == 1) return kUnlimited;
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

/// Particles inside a soft body have no element.
std::vector<std::uint32_t> surface_of(const Elements& elements) {
    std::vector<std::uint32_t> surface;
    for (std::uint32_t v = 0; v < elements.vertex_count(); ++v)
        if (!elements.at(v).empty()) surface.push_back(v);
    return surface;
}

std::vector<Element> vertices_of(const std::vector<std::uint32_t>& surface) {
    std::vector<Element> vertices;
    for (const std::uint32_t v : surface) vertices.push_back({.vertices = {v, v, v}, .vertex_count = 1});
    return vertices;
}

/// Of its corners over the faces opposite them.
float least_height(const ElasticTetrahedron& tetrahedron, const PointArrays& positions) {
    const auto corner = [&](std::size_t k) { return positions[tetrahedron.particles[k]]; };
    const float six_volumes =
        std::fabs(dot(cross(corner(1) - corner(0), corner(2) - corner(0)), corner(3) - corner(0)));
    float twice_area = 0;
    for (std::size_t k = 0; k < 4; ++k) {
        const Vec3f a = corner((k + 1) % 4);
        twice_area = std::max(twice_area, length(cross(corner((k + 2) % 4) - a, corner((k + 3) % 4) - a)));
    }
    return twice_area > 0 ? six_volumes / twice_area : 0;
}

} // namespace

SelfSurface::SelfSurface(std::shared_ptr<const Elements> own, std::span<const ElasticTetrahedron> tetrahedra,
                         const Particles& particles, const Reach& reach, float thickness, float friction)
    : own_(std::move(own)), faces_(faces_of(*own_)), edges_(edges_of(*own_)), surface_(surface_of(*own_)),
      vertices_(vertices_of(surface_)), reach_(reach), thickness_(thickness), friction_(friction),
      mobility_(particles.mobility) {
    const std::size_t count = own_->vertex_count();
    most_.assign(count, kUnlimited);
    for (const Element& element : own_->all) {
        const float most = kMostOfHeight * least_height(element, particles.positions);
        for (const std::uint32_t v : element.vertices) most_[v] = std::min(most_[v], most);
    }
    for (const ElasticTetrahedron& tetrahedron : tetrahedra) {
        const float most = kMostOfHeight * least_height(tetrahedron, particles.positions);
        for (const std::uint32_t v : tetrahedron.particles) most_[v] = std::min(most_[v], most);
    }
    for (PointArrays* points : {&starts_, &goals_, &bases_, &anchors_, &expected_, &speeds_, &from_, &to_})
        points->resize(count);
    rooms_.assign(count, -1);
    quiet_.assign(count, -1);
    is_alert_.assign(count, 0);
    has_moved_.assign(count, 0);
    listed_in_.assign(count, 0);
    is_listed_for_pass_.assign(count, 0);
    if (!faces_.empty()) face_tree_ = MovingTree(faces_, particles.positions);
    if (!edges_.empty()) edge_tree_ = MovingTree(edges_, particles.positions);
    vertex_tree_ = MovingTree(vertices_, particles.positions);
}

void SelfSurface::archive(StateArchive& state) {
    const std::size_t count = own_->vertex_count();
    state.value(reach_.least_gap);
    state.flag(in_world_);
    state.value(drift_);
    state.value(drifting_);
    state.flag(has_searched_);
    state.value(frame_number_);
    state.value(first_frame_);
    state.value(last_frame_);
    state.flag(has_window_);
    for (PointArrays* points : {&expected_, &speeds_, &from_, &to_, &anchors_}) state.points(*points);
    state.array(listed_in_);
    state.array(is_listed_for_pass_);
    state.items(pairs_, [&](Pair& pair) { echinus::archive(state, pair, count, count); });
    state.array(rooms_);
    state.array(quiet_);
    state.items(contacts_, [&](Contact& contact) {
        echinus::archive(state, contact.pair, count);
        state.flag(contact.has_pushed);
    });
    state.value(searched_count);
    state.value(measured_count);
    if (!state.reads() || !has_window_) return;
    const Workers alone;
    want(true, alone);
    refit_trees(alone);
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

void SelfSurface::keep_gap(float least_gap) {
    reach_.least_gap = least_gap;
    std::fill(rooms_.begin(), rooms_.end(), -1.0F);
    std::fill(quiet_.begin(), quiet_.end(), -1.0F);
}

void SelfSurface::begin_pass(const RigidTransform* frame, const PointArrays& starts, bool is_first) {
    drift_ = drift_ + drifting_;
    drifting_ = {};
    to_frame(frame, starts, starts_);
    is_measured_ = false;
    is_first_pass_ = is_first;
    if (is_first) ++frame_number_;
    for (std::size_t v = 0; v < own_->vertex_count(); ++v)
        if (is_listed_for_pass_[v] != 0) is_listed_for_pass_[v] = kOver;
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
    for (const std::uint32_t v : surface_)
        if (!is_within(starts_[v], v) || !is_within(goals_[v] - drifting_, v)) return false;
    return true;
}

// ---- Pairs

/// Where a vertex is expected when this pass begins or ends, less the drift.
Vec3f SelfSurface::expected(std::uint32_t v, bool at_end) const {
    if (is_listed_for_pass_[v] != 0) return expected_[v] + speeds_[v] * (at_end ? 1.0F : 0.0F);
    return expected_in(v, frame_number_ + (at_end || !is_first_pass_ ? 1 : 0));
}

Vec3f SelfSurface::expected_in(std::uint32_t v, std::uint32_t frame) const {
    return expected_[v] + speeds_[v] * static_cast<float>(static_cast<std::int32_t>(frame - listed_in_[v]));
}

/// Pairs were dropped since a plane separates them widely both at the beginning and at the end of the frames
/// for which they were searched. So it does while their vertices stay near where they are expected.
bool SelfSurface::is_elsewhere(std::uint32_t v) const {
    if (!has_searched_ || is_listed_for_pass_[v] == kOver) return true;
    if (frame_number_ > last_frame_ && speeds_[v] != Vec3f{}) return true;
    const auto is_near = [&](const Vec3f& place, const Vec3f& expected) {
        const Vec3f away = place - expected;
        return dot(away, away) <= reach_.slack * reach_.slack;
    };
    return !(is_near(starts_[v], expected(v, false)) && is_near(goals_[v] - drifting_, expected(v, true)));
}

/// A vertex that hardly moves is expected to stay, however long. In a later pass of a frame, vertices that
/// have not arrived go on while the others stay: what is found then holds for this pass.
void SelfSurface::expect(std::uint32_t v) {
    const Vec3f speed = goals_[v] - drifting_ - starts_[v];
    const bool stays = dot(speed, speed) * (kMostFrames * kMostFrames) <= reach_.slack * reach_.slack;
    expected_.set(v, starts_[v]);
    speeds_.set(v, stays ? Vec3f{} : speed);
    listed_in_[v] = frame_number_;
    is_listed_for_pass_[v] = is_first_pass_ ? 0 : kNow;
}

/// Which pairs are listed depends on what is expected of each vertex.
void SelfSurface::list_pairs(const Workers& workers) {
    std::atomic<bool> any_moved = false;
    workers.for_ranges(surface_.size(), kVerticesPerPiece,
                       [&](std::size_t, std::size_t, std::size_t begin, std::size_t end) {
                           bool has_one_moved = false;
                           for (const std::uint32_t v : std::span(surface_).subspan(begin, end - begin)) {
                               has_moved_[v] = is_elsewhere(v) ? 1 : 0;
                               if (has_moved_[v] == 0) continue;
                               expect(v);
                               has_one_moved = true;
                           }
                           if (has_one_moved) any_moved = true;
                       });
    if (!any_moved) return;
    is_measured_ = false;
    has_searched_ = true;
    set_window(workers);
    search(workers);
}

/// Ways are looked at from the first of the frames to the end of the last one. A vertex that is expected
/// elsewhere since goes a straight way too, which may well be followed backwards.
void SelfSurface::set_window(const Workers& workers) {
    // What is found in a later pass holds for this one, in which the other vertices rest.
    const bool is_new = !is_first_pass_ || !has_window_ || frame_number_ > last_frame_;
    has_window_ = is_first_pass_;
    if (is_new) first_frame_ = frame_number_;
    if (frame_number_ > last_frame_) last_frame_ = frame_number_ + frames_to_list() - 1;
    workers.for_ranges(
        surface_.size(), kVerticesPerPiece,
        [&](std::size_t, std::size_t, std::size_t begin, std::size_t end) {
            for (const std::uint32_t v : std::span(surface_).subspan(begin, end - begin)) {
                if (!is_new && has_moved_[v] == 0) continue;
                from_.set(v, is_first_pass_ ? expected_in(v, first_frame_) : expected(v, false));
                to_.set(v, is_first_pass_ ? expected_in(v, last_frame_ + 1) : expected(v, true));
            }
        });
    want(is_new, workers);
    refit_trees(workers);
    if (is_new) want(false, workers);
}

/// In the trees, what has moved.
void SelfSurface::want(bool all, const Workers& workers) {
    face_tree_.want([&](std::uint32_t f) { return all || has_moved(faces_[f]); }, workers);
    edge_tree_.want([&](std::uint32_t e) { return all || has_moved(edges_[e]); }, workers);
    vertex_tree_.want([&](std::uint32_t i) { return all || has_moved_[surface_[i]] != 0; }, workers);
}

/// To the ways of what is wanted.
void SelfSurface::refit_trees(const Workers& workers) {
    face_tree_.refit(faces_, from_, to_, workers);
    edge_tree_.refit(edges_, from_, to_, workers);
    vertex_tree_.refit(vertices_, from_, to_, workers);
}

std::uint32_t SelfSurface::frames_to_list() const {
    double way = 0;
    for (const std::uint32_t v : surface_)
        way += static_cast<double>(length(goals_[v] - drifting_ - starts_[v]));
    const double most = static_cast<double>(kMostWay * reach_.near) * static_cast<double>(surface_.size());
    const double frames = way * kMostFrames < most ? kMostFrames : most / way;
    return frames >= 1 ? static_cast<std::uint32_t>(frames) : 1; // 1 also where places are no longer finite
}

bool SelfSurface::has_moved(const Element& element) const {
    return (has_moved_[element.vertices[0]] | has_moved_[element.vertices[1]] |
            has_moved_[element.vertices[2]]) != 0;
}

/// For what is near the vertices that have moved. The pairs of the others stay listed.
void SelfSurface::search(const Workers& workers) {
    std::erase_if(pairs_, [&](const Pair& pair) {
        return std::any_of(pair.points.begin(), pair.points.end(),
                           [&](std::uint32_t v) { return has_moved_[v] != 0; });
    });
    const std::size_t piece_count =
        vertex_tree_.piece_count() + face_tree_.piece_count() + edge_tree_.piece_count();
    searches_.resize(workers.count());
    found_.begin(workers, piece_count);
    workers.for_pieces(piece_count, [&](std::size_t worker, std::size_t piece) {
        found_.add(worker, piece, [&](std::vector<Pair>& found) {
            search_piece(piece, searches_[worker]);
            keep_near(searches_[worker], found);
        });
    });
    found_.append_to(pairs_);
    for (const std::uint8_t mask : face_tree_.wanted)
        searched_count += static_cast<std::uint64_t>(std::popcount(mask));
}

/// Pieces of the vertices, then of the faces, then of the edges.
void SelfSurface::search_piece(std::size_t piece, Search& search) const {
    const float reach = reach_.near + 2 * reach_.slack;
    search.near.clear();
    search.candidates.clear();
    if (piece < vertex_tree_.piece_count()) {
        find_near(vertex_tree_, face_tree_, reach, piece, search.near);
        for (const auto& [i, face] : search.near) add_vertex_face(surface_[i], face, search.candidates);
        return;
    }
    piece -= vertex_tree_.piece_count();
    if (piece < face_tree_.piece_count()) {
        find_near(face_tree_, vertex_tree_, reach, piece, search.near);
        for (const auto& [face, i] : search.near)
            if (has_moved_[surface_[i]] == 0) add_vertex_face(surface_[i], face, search.candidates);
        return;
    }
    find_near(edge_tree_, edge_tree_, reach, piece - face_tree_.piece_count(), search.near);
    for (const auto& [a, b] : search.near) add_edge_edge(a, b, search.candidates);
}

void SelfSurface::add_vertex_face(std::uint32_t vertex, std::uint32_t face,
                                  std::vector<Pair>& candidates) const {
    const auto& corners = faces_[face].vertices;
    if (!faces_[face].has(vertex))
        candidates.push_back({{vertex, corners[0], corners[1], corners[2]}, PairKind::VertexFace});
}

void SelfSurface::add_edge_edge(std::uint32_t a, std::uint32_t b, std::vector<Pair>& candidates) const {
    const auto& p = edges_[a].vertices;
    const auto& q = edges_[b].vertices;
    if (p[0] != q[0] && p[0] != q[1] && p[1] != q[0] && p[1] != q[1])
        candidates.push_back({{p[0], p[1], q[0], q[1]}, PairKind::EdgeEdge});
}

/// Of the candidates, those that may come near on their ways, which they go together.
void SelfSurface::keep_near(Search& search, std::vector<Pair>& found) const {
    search.separations.resize(search.candidates.size());
    separations(search.candidates, from_, from_, search.separations);
    for (std::size_t i = 0; i < search.candidates.size(); ++i) {
        const Pair& pair = search.candidates[i];
        const Vec3f normal = search.separations[i].normal;
        const std::size_t own = own_count(pair.kind);
        float least = kUnlimited, most = -kUnlimited;
        for (std::size_t k = 0; k < 4; ++k) {
            const float height = dot(normal, to_[pair.points[k]] - from_[pair.points[0]]);
            least = k < own ? std::min(least, height) : least;
            most = k < own ? most : std::max(most, height);
        }
        const float gap = std::min(search.separations[i].gap, least - most);
        if (gap <= reach_.near + 2 * reach_.slack) found.push_back(pair);
    }
}

/// Gives each vertex the least of `most` and what radius_of(worker, piece, begin, end, give) gives it by
/// give(pair, radius) for its pairs. The least of numbers is the same in whatever order.
template <typename RadiusOf>
void SelfSurface::lessen(std::vector<float>& radii, float most, const Workers& workers,
                         const RadiusOf& radius_of) {
    lessened_.resize(workers.count());
    for (std::vector<float>& of_worker : lessened_) of_worker.assign(radii.size(), most);
    workers.for_ranges(pairs_.size(), kOwnPairsPerPiece,
                       [&](std::size_t worker, std::size_t piece, std::size_t begin, std::size_t end) {
                           std::vector<float>& lessened = lessened_[worker];
                           radius_of(worker, piece, begin, end, [&](std::size_t i, float radius) {
                               for (const std::uint32_t v : pairs_[i].points)
                                   lessened[v] = std::min(lessened[v], radius);
                           });
                       });
    radii.swap(lessened_[0]);
    for (std::size_t worker = 1; worker < workers.count(); ++worker)
        for (std::size_t v = 0; v < radii.size(); ++v) radii[v] = std::min(radii[v], lessened_[worker][v]);
}

/// Gives every vertex a new room where it is.
void SelfSurface::measure(const Workers& workers) {
    if (is_measured_) return;
    is_measured_ = true;
    separations_.resize(pairs_.size());
    measured_count += pairs_.size();
    anchors_ = starts_;
    const float unlisted = usable_gap(reach_.near, reach_.least_gap) / 2;
    lessen(rooms_, unlisted, workers,
           [&](std::size_t, std::size_t, std::size_t begin, std::size_t end, const auto& give) {
               const auto of_piece = std::span(separations_).subspan(begin, end - begin);
               separations(std::span(pairs_).subspan(begin, end - begin), starts_, starts_, of_piece);
               for (std::size_t i = begin; i < end; ++i)
                   give(i, usable_gap(separations_[i].gap, reach_.least_gap) / 2);
           });
    std::fill(quiet_.begin(), quiet_.end(), -1.0F); // the next frame looks for contacts
}

// ---- Contacts

void SelfSurface::look_ahead(const RigidTransform* frame, const PointArrays& goals, const Workers& workers) {
    set_goals(frame, goals);
    if (all_within(quiet_)) return;
    std::fill(is_alert_.begin(), is_alert_.end(), std::uint8_t{0});
    for (const Contact& contact : contacts_)
        if (contact.has_pushed)
            for (const std::uint32_t v : contact.pair.particles) is_alert_[v] = 1;
    contacts_.clear();
    list_pairs(workers);
    measure(workers);
    contacts_found_.begin(workers, Workers::piece_count(pairs_.size(), kOwnPairsPerPiece));
    lessen(quiet_, reach_.near / 2, workers,
           [&](std::size_t worker, std::size_t piece, std::size_t begin, std::size_t end, const auto& give) {
               contacts_found_.add(worker, piece, [&](std::vector<Contact>& found) {
                   for (std::size_t i = begin; i < end; ++i)
                       give(i, consider(pairs_[i], separations_[i], found));
               });
           });
    contacts_found_.append_to(contacts_);
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

/// Does one part of a pair slide along the faces around the other? Two edges need each other where either
/// belongs to a crumpled side.
bool SelfSurface::slides_past(const Pair& pair, const Separation& apart, float thickness) const {
    const std::size_t own = own_count(pair.kind);
    Vec3f way;
    for (std::size_t k = 0; k < 4; ++k) {
        const std::uint32_t v = pair.points[k];
        way += (goals_[v] - starts_[v]) * (k < own ? apart.weights[k] : -apart.weights[k]);
    }
    SlidingLimits limits = kOwnSliding;
    limits.least_height = kLeastHeight * thickness / apart.gap;
    const std::span<const std::uint32_t> points(pair.points);
    const std::span<const float> weights(apart.weights);
    const auto ridge = ridge_of(points.first(own), weights.first(own));
    const auto other = ridge_of(points.subspan(own), weights.subspan(own));
    const Faces around = ridge ? faces_at(*ridge, *own_, starts_, {-apart.normal, -way}, limits) : Faces::Low;
    const Faces around_other =
        other ? faces_at(*other, *own_, starts_, {apart.normal, way}, limits) : Faces::Low;
    const bool are_edges = ridge && other && ridge->a != ridge->b && other->a != other->b;
    if (are_edges && (around == Faces::Crumpled || around_other == Faces::Crumpled)) return false;
    return around == Faces::Passed || around_other == Faces::Passed;
}

/// @return how far each of the pair's vertices may go before it has to be measured again
float SelfSurface::consider(const Pair& pair, const Separation& apart, std::vector<Contact>& contacts) const {
    const float thickness = thickness_of(pair);
    const bool is_alert = std::any_of(pair.points.begin(), pair.points.end(),
                                      [&](std::uint32_t v) { return is_alert_[v] != 0; });
    const float ready = thickness * (1 + (is_alert ? kAlertReadiness : kReadiness));
    if (!(apart.gap < ready + closing(pair, apart))) return (apart.gap - thickness) / 2;
    if (slides_past(pair, apart, thickness)) return kContactReuse * thickness;
    const std::size_t own = own_count(pair.kind);
    Contact& contact = contacts.emplace_back();
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
bool SelfSurface::may_meet(const RigidTransform* frame, const PointArrays& goals, const Workers& workers) {
    set_goals(frame, goals);
    stuck_.clear();
    if (all_within(rooms_)) return false;
    list_pairs(workers);
    measure(workers);
    shares_.assign(own_->vertex_count(), 1);
    whole_goals_ = bases_ = goals_;
    bodies_ = {};
    find_meeting(workers);
    return std::find(meets_.begin(), meets_.end(), std::uint8_t{1}) != meets_.end();
}

std::span<const float> SelfSurface::allowed_shares(const RigidTransform* frame, const Bases& bases,
                                                   const Workers& workers) {
    goals_ = whole_goals_;
    to_frame(frame, bases.places, bases_);
    bodies_ = bases.bodies;
    for (const std::uint32_t v : surface_) {
        if (mobility_[v] == 0)
            bases_.set(v, goals_[v]);
        else if (bodies_[v] == Bases::kStaying)
            bases_.set(v, starts_[v]);
    }
    list_pairs(workers);
    measure(workers);
    shares_.assign(own_->vertex_count(), 1);
    for (int round = 0; shorten_ways(round, workers); ++round) {
        for (std::uint32_t v = 0; v < own_->vertex_count(); ++v)
            if (shares_[v] != 1) goals_.set(v, place_at_share(v));
        list_pairs(workers);
        measure(workers);
    }
    return shares_;
}

Vec3f SelfSurface::place_at_share(std::uint32_t v) const {
    return shares_[v] == 1 ? whole_goals_[v] : bases_[v] + (whole_goals_[v] - bases_[v]) * shares_[v];
}

/// Parts of one rigid body that do not meet do not meet on straight ways to another place of it either, if it
/// turns by less than half a turn: at any time, one affine map, which has an inverse, has taken all of it
/// there. How far apart they end is measured, since places are rounded.
bool SelfSurface::is_led_as_one(std::size_t i) const {
    const Pair& pair = pairs_[i];
    if (bodies_.empty() || bodies_[pair.points[0]] == Bases::kAlone) return false;
    std::array<Vec3f, 4> points;
    for (std::size_t k = 0; k < 4; ++k) {
        if (bodies_[pair.points[k]] != bodies_[pair.points[0]]) return false;
        points[k] = bases_[pair.points[k]];
    }
    return separation(pair.kind, points).gap > kLeastShare * reach_.least_gap;
}

SelfSurface::Ending SelfSurface::ending_of(std::size_t i) const {
    const Pair& pair = pairs_[i];
    const Separation& apart = separations_[i];
    const std::size_t own = own_count(pair.kind);
    const Vec3f origin = starts_[pair.points[0]];
    float least = kUnlimited, most = -kUnlimited, least_base = kUnlimited, most_base = -kUnlimited;
    const Vec3f led = bases_[pair.points[0]] - origin;
    const bool keeps_gap = apart.gap > kLeastShare * reach_.least_gap;
    bool stays = true, is_rigid = keeps_gap;
    for (std::size_t k = 0; k < 4; ++k) {
        const std::uint32_t v = pair.points[k];
        const float height = dot(apart.normal, place_at_share(v) - origin);
        const float base = dot(apart.normal, bases_[v] - origin);
        stays = stays && bases_[v] == starts_[v];
        is_rigid = is_rigid && length(bases_[v] - starts_[v] - led) <= kRigidTolerance * reach_.least_gap;
        least = k < own ? std::min(least, height) : least;
        most = k < own ? most : std::max(most, height);
        least_base = k < own ? std::min(least_base, base) : least_base;
        most_base = k < own ? most_base : std::max(most_base, base);
    }
    is_rigid = is_rigid || (keeps_gap && is_led_as_one(i));
    return {.kept = apart.gap - std::max(usable_gap(apart.gap, reach_.least_gap), 0.0F),
            .at_end = least - most,
            .at_base = stays || is_rigid ? apart.gap : least_base - most_base,
            .stays = stays || is_rigid};
}

/// Of the ways as they are.
void SelfSurface::find_meeting(const Workers& workers) {
    meets_.resize(pairs_.size());
    workers.for_ranges(pairs_.size(), kOwnPairsPerPiece,
                       [&](std::size_t, std::size_t, std::size_t begin, std::size_t end) {
                           for (std::size_t i = begin; i < end; ++i)
                               meets_[i] = is_apart(i, ending_of(i)) ? 0 : 1;
                       });
    was_shortened_.assign(own_->vertex_count(), 0);
}

/// Faces that models press together turn, and so do the planes between them: no plane along one normal may
/// separate them all the way, though they never meet.
bool SelfSurface::stays_apart(const Pair& pair) const {
    std::array<Vec3f, 4> from, to;
    for (std::size_t k = 0; k < 4; ++k) {
        from[k] = starts_[pair.points[k]];
        to[k] = place_at_share(pair.points[k]);
    }
    return separation(pair.kind, to).gap >= kLeastTurningShare * reach_.least_gap &&
           stay_apart(pair.kind, from, to, kLeastShare * reach_.least_gap);
}

/// Shortens the ways of pairs that could meet, one after the other. @return whether there were any
bool SelfSurface::shorten_ways(int round, const Workers& workers) {
    find_meeting(workers);
    bool found = false;
    stuck_.clear();
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
        const Pair& pair = pairs_[i];
        if (meets_[i] == 0 && std::none_of(pair.points.begin(), pair.points.end(),
                                           [&](std::uint32_t v) { return was_shortened_[v] != 0; }))
            continue;
        const Ending ending = ending_of(i);
        if (is_apart(i, ending)) continue;
        const auto& [kept, at_end, at_base, stays] = ending;
        const float share = round < kRounds && at_base > kept
                                ? std::clamp((at_base - kept) / (at_base - at_end), 0.0F, 1.0F) * kAlmost
                                : 0.0F;
        bool can_be_shortened = false;
        for (const std::uint32_t v : pair.points) {
            if (shares_[v] == 0 || mobility_[v] == 0) continue;
            shares_[v] *= share;
            was_shortened_[v] = 1;
            can_be_shortened = true;
        }
        found = found || can_be_shortened;
        if (!can_be_shortened && !stays && !stays_apart(pair)) stuck_.push_back(pair.points);
    }
    return found;
}

} // namespace echinus
