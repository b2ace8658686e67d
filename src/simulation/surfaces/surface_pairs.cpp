#include "simulation/surfaces/surface_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace echinus {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Where nothing is near, the tree is asked for a clearance up to so many times the reach of the lists.
constexpr float kFarReach = 4;

constexpr float kRounding = 1.0F / (1 << 20);

constexpr std::size_t kElementsPerPiece = 512, kListsPerPiece = 32, kPairsPerPiece = 512;

bool is_near(const Box& a, const Box& b) {
    return a.low[0] <= b.high[0] && a.high[0] >= b.low[0] && a.low[1] <= b.high[1] && a.high[1] >= b.low[1] &&
           a.low[2] <= b.high[2] && a.high[2] >= b.low[2];
}

Box box_of_way(const PointArrays& from, const PointArrays& to, std::uint32_t vertex) {
    const Vec3f a = from[vertex], b = to[vertex];
    return {{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)},
            {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}};
}

} // namespace

SurfacePairs::SurfacePairs(const Elements& own, const PairReach& reach)
    : own_(&own), reach_(reach), lists_(own.all.size()), renewed_in_(own.vertex_count()),
      measured_in_(own.all.size()) {
    const std::size_t vertex_count = own.vertex_count();
    anchors_.resize(vertex_count);
    element_listed_at_.resize(own.all.size());
    for (auto* list : {&woken_, &leaving_}) list->reserve(vertex_count);
    measuring_.reserve(own.all.size());
    reset();
}

void SurfacePairs::reset() {
    rooms_.assign(own_->vertex_count(), -1);
    quiet_.assign(own_->vertex_count(), -1);
    list_reaches_.assign(own_->all.size(), -kInfinity);
    for (std::size_t e = 0; e < own_->all.size(); ++e) lists_.clear(e);
}

void SurfacePairs::archive(StateArchive& state, std::size_t opponent_count) {
    state.value(reach_.least_gap);
    lists_.archive(state, own_->vertex_count(), opponent_count);
    state.array(list_reaches_);
    state.array(element_listed_at_);
    state.points(anchors_);
    state.array(rooms_);
    state.array(quiet_);
    state.flag(was_for_one_frame_);
    state.value(frame_);
    state.array(renewed_in_);
    state.array(measured_in_);
    state.value(wake_);
    state.value(measured_count);
    state.value(listed_count);
}

// ---- Lists

void SurfacePairs::begin(const Opponent& opponent, const PointArrays& starts, const PointArrays& bases,
                         std::span<const float> clearances) {
    if (opponent.ends != nullptr || was_for_one_frame_) reset();
    was_for_one_frame_ = opponent.ends != nullptr;
    opponent_ = opponent;
    starts_ = &starts;
    bases_ = &bases;
    clearances_ = clearances;
    ++frame_;
}

/// How far the vertices of an element have moved since its list was made.
float SurfacePairs::moved_since_listed(std::uint32_t element) const {
    float moved_sq = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3f way = (*starts_)[own_->all[element].vertices[k]] - element_listed_at_[element][k];
        moved_sq = std::max(moved_sq, dot(way, way));
    }
    return std::sqrt(moved_sq) * (1 + kRounding);
}

/// Does it no longer reach far enough?
bool SurfacePairs::is_list_outdated(std::uint32_t element) const {
    return !(list_reaches_[element] - moved_since_listed(element) >= reach_.listed - reach_.slack);
}

/// The list of an element beside a model is made anew when it is needed and outdated.
void SurfacePairs::keep_lists(const Workers& workers) {
    outdated_.begin(workers, Workers::piece_count(measuring_.size(), kElementsPerPiece));
    workers.for_ranges(measuring_.size(), kElementsPerPiece,
                       [&](std::size_t worker, std::size_t piece, std::size_t begin, std::size_t end) {
                           outdated_.add(worker, piece, [&](std::vector<std::uint32_t>& outdated) {
                               for (std::size_t i = begin; i < end; ++i)
                                   if (is_list_outdated(measuring_[i])) outdated.push_back(measuring_[i]);
                           });
                       });
    listing_.clear();
    outdated_.append_to(listing_);
    listings_.resize(workers.count());
    found_counts_.resize(listing_.size());
    found_.begin(workers, Workers::piece_count(listing_.size(), kListsPerPiece));
    workers.for_ranges(listing_.size(), kListsPerPiece,
                       [&](std::size_t worker, std::size_t piece, std::size_t begin, std::size_t end) {
                           found_.add(worker, piece, [&](std::vector<Pair>& found) {
                               for (std::size_t i = begin; i < end; ++i) {
                                   const std::size_t before = found.size();
                                   list(listing_[i], listings_[worker], found);
                                   found_counts_[i] = static_cast<std::uint32_t>(found.size() - before);
                               }
                           });
                       });
    listed_count += listing_.size();
    for (const std::uint32_t element : listing_) lists_.clear(element);
    std::size_t i = 0, left = listing_.empty() ? 0 : found_counts_[0];
    found_.for_each([&](const Pair& pair) {
        while (left == 0) left = found_counts_[++i];
        --left;
        lists_.add(listing_[i], pair);
    });
}

/// Every point of an element lies within its longest edge of each of its vertices.
float SurfacePairs::clearance_of(const Element& element) const {
    if (clearances_.empty()) return 0;
    std::array<Vec3f, 3> p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = (*starts_)[element.vertices[k]];
    const float longest = std::max({length(p[0] - p[1]), length(p[1] - p[2]), length(p[2] - p[0])});
    float best = 0;
    for (std::size_t k = 0; k < element.vertex_count; ++k)
        best = std::max(best, clearances_[element.vertices[k]] - longest);
    return best * (1 - kRounding);
}

/// @param found  pairs are added here
void SurfacePairs::list(std::uint32_t element, Listing& listing, std::vector<Pair>& found) {
    for (std::size_t k = 0; k < 3; ++k)
        element_listed_at_[element][k] = (*starts_)[own_->all[element].vertices[k]];
    const float clearance = clearance_of(own_->all[element]) - 2 * opponent_.most;
    if (clearance > reach_.listed) {
        list_reaches_[element] = clearance;
        return;
    }
    Box box = box_of_both(box_of(own_->all[element], *starts_), box_of(own_->all[element], *bases_));
    box.grow(reach_.listed);
    listing.near.clear();
    bool touches = false;
    opponent_.tree->visit_touching(box, [&](std::uint32_t other) {
        touches = true;
        list_pairs(element, other, listing.near);
    });
    keep_near(listing, found);
    list_reaches_[element] = reach_.listed;
    if (!touches) {
        box.grow(-reach_.listed);
        list_reaches_[element] =
            std::max(reach_.listed, opponent_.tree->distance(box, kFarReach * reach_.listed));
    }
}

void SurfacePairs::list_pairs(std::uint32_t own_number, std::uint32_t other_number,
                              std::vector<Pair>& near) const {
    const Element& own = own_->all[own_number];
    const Element& other = opponent_.elements->all[other_number];
    // Each point's way, a box.
    const PointArrays& other_ends = opponent_.ends != nullptr ? *opponent_.ends : *opponent_.positions;
    std::array<Box, 3> a, b;
    for (std::size_t k = 0; k < 3; ++k) {
        a[k] = box_of_way(*starts_, *bases_, own.vertices[k]);
        b[k] = box_of_way(*opponent_.positions, other_ends, other.vertices[k]);
    }
    Box own_box = box_of_both(box_of_both(a[0], a[1]), a[2]);
    const Box other_box = box_of_both(box_of_both(b[0], b[1]), b[2]);
    own_box.grow(reach_.listed);
    if (!is_near(own_box, other_box)) return;
    if (other.is_face()) {
        Box reached = other_box;
        reached.grow(reach_.listed);
        for (std::size_t k = 0; k < own.vertex_count; ++k)
            if (own.owns_vertex(k) && is_near(a[k], reached))
                near.push_back({{own.vertices[k], other.vertices[0], other.vertices[1], other.vertices[2]},
                                PairKind::VertexFace});
    }
    if (own.is_face())
        for (std::size_t k = 0; k < other.vertex_count; ++k)
            if (other.owns_vertex(k) && is_near(b[k], own_box))
                near.push_back({{own.vertices[0], own.vertices[1], own.vertices[2], other.vertices[k]},
                                PairKind::FaceVertex});
    const auto edge_count = [](const Element& e) { return e.vertex_count == 3 ? 3U : e.vertex_count - 1U; };
    for (std::size_t i = 0; i < edge_count(own); ++i) {
        if (!own.owns_edge(i)) continue;
        const std::size_t i_next = (i + 1) % 3;
        Box edge_box = box_of_both(a[i], a[i_next]);
        edge_box.grow(reach_.listed);
        for (std::size_t j = 0; j < edge_count(other); ++j) {
            if (!other.owns_edge(j)) continue;
            const std::size_t j_next = (j + 1) % 3;
            const std::array<std::uint32_t, 4> points{own.vertices[i], own.vertices[i_next],
                                                      other.vertices[j], other.vertices[j_next]};
            if (is_near(edge_box, box_of_both(b[j], b[j_next]))) near.push_back({points, PairKind::EdgeEdge});
        }
    }
}

/// Of the pairs whose boxes are near, those that are near, or get so on the way to the bases.
void SurfacePairs::keep_near(Listing& listing, std::vector<Pair>& found) const {
    listing.separations.resize(listing.near.size());
    separations(listing.near, *starts_, *opponent_.positions, listing.separations);
    for (std::size_t i = 0; i < listing.near.size(); ++i) {
        const Separation& apart = listing.separations[i];
        float gap = apart.gap;
        if (opponent_.ends != nullptr) gap -= std::max(closing(listing.near[i], apart.normal), 0.0F);
        if (!(gap > reach_.listed)) found.push_back(listing.near[i]);
    }
}

/// The pairs of the elements to be measured, and how far apart they are now.
void SurfacePairs::gather_measured(const Workers& workers) {
    keep_lists(workers);
    measured_pairs_.clear();
    measured_elements_.clear();
    for (const std::uint32_t element : measuring_) {
        const Element& own = own_->all[element];
        const float bound = bound_of(element);
        for (std::size_t k = 0; k < own.vertex_count; ++k) shrink(own.vertices[k], bound, bound);
        const std::span<const Pair> pairs = lists_.of(element);
        measured_pairs_.insert(measured_pairs_.end(), pairs.begin(), pairs.end());
        measured_elements_.insert(measured_elements_.end(), pairs.size(), element);
    }
    separations_.resize(measured_pairs_.size());
    workers.for_ranges(measured_pairs_.size(), kPairsPerPiece,
                       [&](std::size_t, std::size_t, std::size_t begin, std::size_t end) {
                           separations(std::span(measured_pairs_).subspan(begin, end - begin), *starts_,
                                       *opponent_.positions,
                                       std::span(separations_).subspan(begin, end - begin));
                       });
}

// ---- Rooms

std::array<Vec3f, 4> SurfacePairs::points_of(const Pair& pair) const {
    std::array<Vec3f, 4> points;
    const std::size_t own = own_count(pair.kind);
    for (std::size_t k = 0; k < 4; ++k)
        points[k] = k < own ? (*starts_)[pair.points[k]] : (*opponent_.positions)[pair.points[k]];
    return points;
}

/// How far the opponent's part of a pair comes along the normal.
float SurfacePairs::advance(const Pair& pair, const Vec3f& normal) const {
    if (opponent_.ends == nullptr) return 0;
    float most = -kInfinity;
    for (std::size_t k = own_count(pair.kind); k < 4; ++k)
        most = std::max(
            most, dot(normal, (*opponent_.ends)[pair.points[k]] - (*opponent_.positions)[pair.points[k]]));
    return most;
}

/// By how much the gap of a pair shrinks along the normal while its own part goes to the bases.
float SurfacePairs::closing(const Pair& pair, const Vec3f& normal) const {
    float least = kInfinity;
    for (std::size_t k = 0; k < own_count(pair.kind); ++k)
        least = std::min(least, dot(normal, (*bases_)[pair.points[k]] - (*starts_)[pair.points[k]]));
    return advance(pair, normal) - least;
}

/// How far the vertices of an element may go by what is not listed.
float SurfacePairs::bound_of(std::uint32_t element) const {
    return list_reaches_[element] - moved_since_listed(element) - reach_.least_gap;
}

bool SurfacePairs::is_beyond(std::uint32_t vertex, const Vec3f& goal, float radius) const {
    const Vec3f way = goal - anchors_[vertex];
    return !(dot(way, way) <= radius * std::fabs(radius));
}

void SurfacePairs::wake(std::uint32_t vertex) {
    anchors_.set(vertex, (*bases_)[vertex]);
    rooms_[vertex] = quiet_[vertex] = kInfinity;
    renewed_in_[vertex] = frame_;
    woken_.push_back(vertex);
}

void SurfacePairs::collect_measured() {
    ++wake_;
    measuring_.clear();
    for (const std::uint32_t v : woken_)
        for (const std::uint32_t element : own_->at(v))
            if (std::exchange(measured_in_[element], wake_) != wake_) measuring_.push_back(element);
    woken_.clear();
}

/// Not to look for contacts: it is too late for them in this frame, so the next one does.
void SurfacePairs::measure_woken(const Workers& workers) {
    collect_measured();
    measure_collected([](std::uint32_t, const Pair&, const Separation&) { return -kInfinity; }, workers);
}

void SurfacePairs::shrink(std::uint32_t vertex, float room, float quiet) {
    if (!(room < rooms_[vertex] || quiet < quiet_[vertex])) return;
    const float used = length((*bases_)[vertex] - anchors_[vertex]);
    rooms_[vertex] = std::min(rooms_[vertex], room - used);
    quiet_[vertex] = std::min(quiet_[vertex], quiet - used);
}

std::span<const std::uint32_t> SurfacePairs::find_leaving(const PointArrays& goals, const Workers& workers) {
    for (;;) {
        leaving_.clear();
        for (std::uint32_t v = 0; v < own_->vertex_count(); ++v) {
            if (!is_beyond(v, goals[v], rooms_[v])) continue;
            // In a later pass, after the opponent has deformed, most vertices have arrived: they rest, and so
            // need no room.
            if (rooms_[v] == -1 && opponent_.ends == nullptr && goals[v] == (*starts_)[v]) continue;
            if (renewed_in_[v] == frame_)
                leaving_.push_back(v);
            else
                wake(v);
        }
        if (woken_.empty()) break;
        measure_woken(workers);
    }
    // Their next way may lead back in from outside.
    for (const std::uint32_t v : leaving_) rooms_[v] = quiet_[v] = -1;
    return leaving_;
}

bool SurfacePairs::renew(std::uint32_t vertex, const Workers& workers) {
    if (renewed_in_[vertex] == frame_) return false;
    wake(vertex);
    measure_woken(workers);
    return true;
}

Shares SurfacePairs::allowed(std::uint32_t vertex, const Vec3f& from, const Vec3f& to) const {
    const Vec3f start = (*starts_)[vertex], base = (*bases_)[vertex];
    Shares shares;
    float bound = kInfinity;
    for (const std::uint32_t element : own_->at(vertex)) {
        bound = std::min(bound, bound_of(element));
        for (const Pair& pair : lists_.of(element)) {
            const auto own = pair.points.begin() + static_cast<std::ptrdiff_t>(own_count(pair.kind));
            if (std::find(pair.points.begin(), own, vertex) == own) continue;
            const auto points = points_of(pair);
            const Separation apart = separation(pair.kind, points);
            // What deforms would have to be followed exactly.
            if (!(apart.gap > 0)) return opponent_.ends != nullptr ? Shares{1, 0} : Shares{0, 0};
            // How far above the plane at the end of the pair's own part the vertex begins.
            float above = kInfinity;
            for (std::size_t k = 0; k < own_count(pair.kind); ++k)
                above = std::min(above, dot(apart.normal, points[k] - start));
            const float allowed_way = std::max(usable(apart.gap), 0.0F) - above - advance(pair, apart.normal);
            shares.keep_not_negative(dot(apart.normal, from - start) + allowed_way,
                                     dot(apart.normal, to - start) + allowed_way);
        }
    }
    shares.keep_in_ball(from - base, to - from, bound);
    return shares;
}

} // namespace echinus
