#include "simulation/surfaces/surface_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace echinus {

namespace {

constexpr float kBoundless = std::numeric_limits<float>::infinity();

/// Where nothing is near, the tree is asked for a clearance up to so many times the reach of the lists, or
/// the way of a vertex that goes farther than that.
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
    list_reaches_.assign(own_->all.size(), -kBoundless);
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
    for (Listing& listing : listings_) listing.found.clear();
    listed_.resize(own_->all.size());
    if (opponent_.ways != nullptr)
        list_on_their_ways(workers);
    else
        workers.for_ranges(listing_.size(), kListsPerPiece,
                           [&](std::size_t worker, std::size_t, std::size_t begin, std::size_t end) {
                               for (std::size_t i = begin; i < end; ++i) list(listing_[i], worker);
                           });
    listed_count += listing_.size();
    for (const std::uint32_t element : listing_) {
        lists_.clear(element);
        for (const Measured& found : just_listed(element)) lists_.add(element, found.pair);
    }
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

void SurfacePairs::note_place(std::uint32_t element) {
    for (std::size_t k = 0; k < 3; ++k)
        element_listed_at_[element][k] = (*starts_)[own_->all[element].vertices[k]];
}

/// Notes where an element is whose list is made. @return whether what is known of its distance is enough
bool SurfacePairs::is_far(std::uint32_t element) {
    note_place(element);
    const float clearance = clearance_of(own_->all[element]) - 2 * opponent_.most;
    list_reaches_[element] = std::max(clearance, reach_.listed);
    return clearance > reach_.listed;
}

void SurfacePairs::list(std::uint32_t element, std::size_t worker) {
    Listing& listing = listings_[worker];
    listed_[element] = {worker, listing.found.size(), 0};
    if (is_far(element)) return;
    const Ways own = ways_of(element);
    bool touches = false;
    listing.near.clear();
    opponent_.tree->visit_touching(own.reached, [&](std::uint32_t other) {
        touches = true;
        list_pairs(own, other, listing.near);
    });
    keep_near(element, listing);
    if (!touches)
        list_reaches_[element] = std::max(reach_.listed, distance_to(element, kFarReach * reach_.listed));
}

/// Beside an opponent that deforms all lists are made in each frame: group by group, and what two elements
/// have in common of their ways does not bring them together.
void SurfacePairs::list_on_their_ways(const Workers& workers) {
    if (own_ways_.wanted.empty()) {
        own_ways_ = MovingTree(own_->all, *starts_);
        places_in_tree_.resize(own_->all.size());
        const auto order = own_ways_.from.order();
        for (std::uint32_t i = 0; i < order.size(); ++i) places_in_tree_[order[i]] = i;
    }
    is_wanted_.assign(own_->all.size(), 0);
    for (const std::uint32_t element : listing_) {
        listed_[element] = {};
        is_wanted_[element] = is_far(element) ? 0 : 1;
    }
    own_ways_.want([&](std::uint32_t element) { return is_wanted_[element] != 0; }, workers);
    own_ways_.refit(own_->all, *starts_, *bases_, workers);
    workers.for_pieces(own_ways_.piece_count(), [&](std::size_t worker, std::size_t piece) {
        list_piece(piece, listings_[worker], worker);
    });
}

/// What is listed does not depend on the groups of the tree, which are of any frame: an element is compared
/// with the opponent's, and with groups of them, in their order.
void SurfacePairs::list_piece(std::size_t piece, Listing& listing, std::size_t worker) {
    constexpr std::size_t kElements = MovingTree::kGroupsPerPiece * ElementTree::kWidth;
    const std::size_t first = piece * kElements;
    const auto order = own_ways_.from.order();
    listing.near_elements.clear();
    find_near(own_ways_, *opponent_.ways, reach_.listed, piece, listing.near_elements);
    std::array<std::uint32_t, kElements + 1> ends{};
    for (const auto& [own, other] : listing.near_elements) ++ends[places_in_tree_[own] - first + 1];
    for (std::size_t i = 0; i < kElements; ++i) ends[i + 1] += ends[i];
    listing.others.resize(listing.near_elements.size());
    for (const auto& [own, other] : listing.near_elements)
        listing.others[ends[places_in_tree_[own] - first]++] = other;
    std::size_t begin = 0;
    for (std::size_t i = 0; i < std::min(kElements, order.size() - first); ++i) {
        const std::uint32_t element = order[first + i];
        if (is_wanted_[element] == 0) continue;
        listed_[element] = {worker, listing.found.size(), 0};
        if (begin == ends[i]) continue;
        const Ways own = ways_of(element);
        listing.near.clear();
        for (; begin < ends[i]; ++begin) list_pairs(own, listing.others[begin], listing.near);
        keep_near(element, listing);
    }
}

/// A lower bound of how far it is from an element's way to the opponent's.
float SurfacePairs::distance_to(std::uint32_t element, float most) const {
    Box box = ways_of(element).reached;
    box.grow(-reach_.listed);
    return opponent_.tree->distance(box, most);
}

/// Looks as far as its way is long, and farther, around a vertex that leaves its room where nothing is
/// listed: that little is known is no reason to hold it. @return whether that helps
bool SurfacePairs::look_farther(std::uint32_t vertex, const Vec3f& goal) {
    const float way = length(goal - (*bases_)[vertex]);
    bool helps = false;
    for (const std::uint32_t element : own_->at(vertex)) {
        if (!lists_.of(element).empty() || bound_of(element) > way) continue;
        const float distance = distance_to(element, kFarReach * std::max(way, reach_.listed));
        if (!(distance > list_reaches_[element] - moved_since_listed(element))) continue;
        note_place(element);
        list_reaches_[element] = distance;
        helps = true;
    }
    return helps;
}

SurfacePairs::Ways SurfacePairs::ways_of(std::uint32_t element) const {
    Ways ways{&own_->all[element], {}, {}};
    for (std::size_t k = 0; k < 3; ++k)
        ways.points[k] = box_of_way(*starts_, *bases_, ways.element->vertices[k]);
    ways.reached = box_of_both(box_of_both(ways.points[0], ways.points[1]), ways.points[2]);
    ways.reached.grow(reach_.listed);
    return ways;
}

void SurfacePairs::list_pairs(const Ways& ways, std::uint32_t other_number, std::vector<Pair>& near) const {
    const Element& own = *ways.element;
    const Element& other = opponent_.elements->all[other_number];
    const PointArrays& other_ends = opponent_.ends != nullptr ? *opponent_.ends : *opponent_.positions;
    const std::array<Box, 3>& a = ways.points;
    std::array<Box, 3> b;
    for (std::size_t k = 0; k < 3; ++k)
        b[k] = box_of_way(*opponent_.positions, other_ends, other.vertices[k]);
    const Box other_box = box_of_both(box_of_both(b[0], b[1]), b[2]);
    if (!is_near(ways.reached, other_box)) return;
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
            if (other.owns_vertex(k) && is_near(b[k], ways.reached))
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
void SurfacePairs::keep_near(std::uint32_t element, Listing& listing) {
    listing.separations.resize(listing.near.size());
    separations(listing.near, *starts_, *opponent_.positions, listing.separations);
    for (std::size_t i = 0; i < listing.near.size(); ++i) {
        const Separation& apart = listing.separations[i];
        float gap = apart.gap;
        if (opponent_.ends != nullptr) gap -= std::max(closing(listing.near[i], apart.normal), 0.0F);
        if (!(gap > reach_.listed)) listing.found.push_back({listing.near[i], apart});
    }
    listed_[element].count = listing.found.size() - listed_[element].first;
}

/// The pairs of the elements to be measured, and how far apart they are now: those that were just listed have
/// been measured for that.
void SurfacePairs::gather_measured(const Workers& workers) {
    keep_lists(workers);
    measured_.clear();
    measured_elements_.clear();
    to_measure_.clear();
    auto next_listed = listing_.begin(); // in the order of those to be measured
    for (const std::uint32_t element : measuring_) {
        const Element& own = own_->all[element];
        const float bound = bound_of(element);
        for (std::size_t k = 0; k < own.vertex_count; ++k) shrink(own.vertices[k], bound, bound);
        if (next_listed != listing_.end() && *next_listed == element) {
            ++next_listed;
            const std::span<const Measured> found = just_listed(element);
            measured_.insert(measured_.end(), found.begin(), found.end());
        } else {
            for (const Pair& pair : lists_.of(element)) {
                to_measure_.push_back(static_cast<std::uint32_t>(measured_.size()));
                measured_.push_back({pair, {}});
            }
        }
        measured_elements_.resize(measured_.size(), element);
    }
    measure(workers);
}

void SurfacePairs::measure(const Workers& workers) {
    workers.for_ranges(to_measure_.size(), kPairsPerPiece,
                       [&](std::size_t worker, std::size_t, std::size_t begin, std::size_t end) {
                           Listing& listing = listings_[worker];
                           listing.near.clear();
                           for (std::size_t i = begin; i < end; ++i)
                               listing.near.push_back(measured_[to_measure_[i]].pair);
                           listing.separations.resize(end - begin);
                           separations(listing.near, *starts_, *opponent_.positions, listing.separations);
                           for (std::size_t i = begin; i < end; ++i)
                               measured_[to_measure_[i]].apart = listing.separations[i - begin];
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
    float most = -kBoundless;
    for (std::size_t k = own_count(pair.kind); k < 4; ++k)
        most = std::max(
            most, dot(normal, (*opponent_.ends)[pair.points[k]] - (*opponent_.positions)[pair.points[k]]));
    return most;
}

/// By how much the gap of a pair shrinks along the normal while its own part goes to the bases.
float SurfacePairs::closing(const Pair& pair, const Vec3f& normal) const {
    float least = kBoundless;
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
    rooms_[vertex] = quiet_[vertex] = kBoundless;
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
    measure_collected([](std::uint32_t, const Pair&, const Separation&) { return -kBoundless; }, workers);
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
            if (renewed_in_[v] == frame_ && !look_farther(v, goals[v]))
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

Shares SurfacePairs::allowed(std::uint32_t vertex, const Vec3f& from, const Vec3f& to, float rounding) const {
    const Vec3f start = (*starts_)[vertex], base = (*bases_)[vertex];
    Shares shares;
    float bound = kBoundless;
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
            float above = kBoundless;
            for (std::size_t k = 0; k < own_count(pair.kind); ++k)
                above = std::min(above, dot(apart.normal, points[k] - start));
            const float allowed_way = std::max(usable(apart.gap), 0.0F) - above - advance(pair, apart.normal);
            float at_from = dot(apart.normal, from - start) + allowed_way;
            if (at_from < 0 && at_from >= -rounding) at_from = 0; // it may stay, and come no nearer
            shares.keep_not_negative(at_from, dot(apart.normal, to - start) + allowed_way);
        }
    }
    shares.keep_in_ball(from - base, to - from, bound);
    return shares;
}

} // namespace echinus
