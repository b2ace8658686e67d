#include "simulation/contact/pair_set.hpp"

#include <algorithm>

namespace echinus {

namespace {

constexpr std::size_t kPairsPerPiece = 512;

/// The range of some points along an axis when displacements begin, and when they end.
struct Span {
    float low_from, high_from, low_to, high_to;
};

Span span_of(std::span<const std::uint32_t> points, const std::vector<float>& from,
             const std::vector<float>& to) {
    Span span{from[points[0]], from[points[0]], to[points[0]], to[points[0]]};
    for (const std::uint32_t p : points.subspan(1)) {
        span.low_from = std::min(span.low_from, from[p]);
        span.high_from = std::max(span.high_from, from[p]);
        span.low_to = std::min(span.low_to, to[p]);
        span.high_to = std::max(span.high_to, to[p]);
    }
    return span;
}

/// More than the reach apart at both ends of the displacements, on the same side.
bool stay_apart(const Span& a, const Span& b, float reach) {
    return (a.low_from - b.high_from > reach && a.low_to - b.high_to > reach) ||
           (b.low_from - a.high_from > reach && b.low_to - a.high_to > reach);
}

struct Displaced {
    const PointArrays& from;
    const PointArrays& to;
};

bool come_near(std::span<const std::uint32_t> a, const Displaced& of_a, std::span<const std::uint32_t> b,
               const Displaced& of_b, float reach) {
    for (const auto axis : {&PointArrays::x, &PointArrays::y, &PointArrays::z})
        if (stay_apart(span_of(a, of_a.from.*axis, of_a.to.*axis), span_of(b, of_b.from.*axis, of_b.to.*axis),
                       reach))
            return false;
    return true;
}

std::size_t edge_count(const Element& element) {
    return element.vertex_count == 3 ? 3 : element.vertex_count - 1U;
}

} // namespace

PairSet::PairSet(const Elements& own, const Elements& obstacle) : own_(&own), obstacle_(&obstacle) {}
PairSet::PairSet(const Elements& own) : PairSet(own, own) {}

void PairSet::list(const PointArrays& own_from, const PointArrays& own_to, const PointArrays& obstacle_from,
                   const PointArrays& obstacle_to, const Workers& workers) {
    own_from_ = &own_from;
    own_to_ = &own_to;
    obstacle_from_ = &obstacle_from;
    obstacle_to_ = &obstacle_to;
    const auto refit = [&](MovingTree& tree, const Elements& elements, const PointArrays& from,
                           const PointArrays& to) {
        if (tree.wanted.empty()) {
            tree = MovingTree(elements.all, from);
            tree.want([](std::uint32_t) { return true; }, workers);
        }
        tree.refit(elements.all, from, to, workers);
    };
    refit(own_tree_, *own_, own_from, own_to);
    if (!is_of_itself()) refit(obstacle_tree_, *obstacle_, obstacle_from, obstacle_to);
    near_elements_.resize(workers.count());
    found_.begin(workers, own_tree_.piece_count());
    workers.for_pieces(own_tree_.piece_count(), [&](std::size_t worker, std::size_t piece) {
        auto& near = near_elements_[worker];
        near.clear();
        find_near(own_tree_, is_of_itself() ? own_tree_ : obstacle_tree_, reach_, piece, near);
        found_.add(worker, piece, [&](std::vector<Pair>& pairs) {
            for (const auto& elements : near) add_pairs(elements, pairs);
        });
    });
    pairs_.clear();
    found_.append_to(pairs_);
}

void PairSet::archive(StateArchive& state) {
    state.items(pairs_, [&](Pair& pair) {
        state.choice(pair.kind, PairKind::EdgeEdge);
        for (std::size_t k = 0; k < 4; ++k)
            state.index(pair.points[k], (k < own_count(pair.kind) ? own_ : obstacle_)->vertex_count());
    });
}

void PairSet::add_vertex_face(std::uint32_t vertex, const Element& face, bool is_own_vertex,
                              std::vector<Pair>& pairs) const {
    if (is_of_itself() && face.has(vertex)) return;
    const std::array<std::uint32_t, 1> point{vertex};
    const Displaced own{*own_from_, *own_to_}, obstacle{*obstacle_from_, *obstacle_to_};
    const auto& corners = face.vertices;
    if (is_own_vertex) {
        if (come_near(point, own, corners, obstacle, reach_))
            pairs.push_back({{vertex, corners[0], corners[1], corners[2]}, PairKind::VertexFace});
    } else if (come_near(corners, own, point, obstacle, reach_)) {
        pairs.push_back({{corners[0], corners[1], corners[2], vertex}, PairKind::FaceVertex});
    }
}

void PairSet::add_pairs(const std::array<std::uint32_t, 2>& elements, std::vector<Pair>& pairs) const {
    const Element& own = own_->all[elements[0]];
    const Element& other = obstacle_->all[elements[1]];
    if (other.is_face())
        for (std::size_t k = 0; k < own.vertex_count; ++k)
            if (own.owns_vertex(k)) add_vertex_face(own.vertices[k], other, true, pairs);
    if (own.is_face())
        for (std::size_t k = 0; k < other.vertex_count; ++k)
            if (other.owns_vertex(k)) add_vertex_face(other.vertices[k], own, is_of_itself(), pairs);
    for (std::size_t i = 0; i < edge_count(own); ++i) {
        if (!own.owns_edge(i)) continue;
        const std::array<std::uint32_t, 2> edge{own.vertices[i], own.vertices[(i + 1) % 3]};
        for (std::size_t j = 0; j < edge_count(other); ++j) {
            if (!other.owns_edge(j)) continue;
            const std::array<std::uint32_t, 2> across{other.vertices[j], other.vertices[(j + 1) % 3]};
            if (is_of_itself() && (edge[0] == across[0] || edge[0] == across[1] || edge[1] == across[0] ||
                                   edge[1] == across[1]))
                continue;
            if (come_near(edge, {*own_from_, *own_to_}, across, {*obstacle_from_, *obstacle_to_}, reach_))
                pairs.push_back({{edge[0], edge[1], across[0], across[1]}, PairKind::EdgeEdge});
        }
    }
}

void PairSet::measure(const PointArrays& own, const PointArrays& obstacle, const Workers& workers) {
    separations_.resize(pairs_.size());
    workers.for_ranges(pairs_.size(), kPairsPerPiece,
                       [&](std::size_t, std::size_t, std::size_t begin, std::size_t end) {
                           echinus::separations(std::span(pairs_).subspan(begin, end - begin), own, obstacle,
                                                std::span(separations_).subspan(begin, end - begin));
                       });
}

} // namespace echinus
