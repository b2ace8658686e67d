#include "simulation/contact/pair_set.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace echinus {

namespace {

constexpr std::size_t kPairsPerPiece = 512;
constexpr std::size_t kBoxesPerPiece = 4096;
/// Pairs are sorted by their gaps in so many steps.
constexpr std::size_t kGapSteps = 64;

PairSet::SweptBox box_of(std::span<const std::uint32_t> points, const PointArrays& from,
                         const PointArrays& to) {
    PairSet::SweptBox box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto along = [&](const PointArrays& places) -> const std::vector<float>& {
            return axis == 0 ? places.x : axis == 1 ? places.y : places.z;
        };
        const std::vector<float>&begin = along(from), &end = along(to);
        box.low_from[axis] = box.high_from[axis] = begin[points[0]];
        box.low_to[axis] = box.high_to[axis] = end[points[0]];
        for (const std::uint32_t p : points.subspan(1)) {
            box.low_from[axis] = std::min(box.low_from[axis], begin[p]);
            box.high_from[axis] = std::max(box.high_from[axis], begin[p]);
            box.low_to[axis] = std::min(box.low_to[axis], end[p]);
            box.high_to[axis] = std::max(box.high_to[axis], end[p]);
        }
    }
    return box;
}

/// Not more than the reach apart, along every axis, at both ends of the displacements on the same side. As
/// numbers, without a branch.
bool come_near(const PairSet::SweptBox& a, const PairSet::SweptBox& b, float reach) {
    int far = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto is_far = [&](float from, float to) { return int{from > reach} & int{to > reach}; };
        far |= is_far(a.low_from[axis] - b.high_from[axis], a.low_to[axis] - b.high_to[axis]) |
               is_far(b.low_from[axis] - a.high_from[axis], b.low_to[axis] - a.high_to[axis]);
    }
    return far == 0;
}

std::size_t edge_count(const Element& element) {
    return element.vertex_count == 3 ? 3 : element.vertex_count - 1U;
}

bool comes_before(const Pair& a, const Pair& b) {
    return a.kind != b.kind ? a.kind < b.kind : a.points < b.points;
}

MovingTree tree_of(const Elements& elements, const PointArrays& places) {
    MovingTree tree(elements.all, places);
    tree.want([](std::uint32_t) { return true; }, Workers(1));
    return tree;
}

} // namespace

PairSet::PairSet(std::shared_ptr<const Elements> own, const PointArrays& own_places,
                 std::shared_ptr<const Elements> obstacle, const PointArrays& obstacle_places)
    : own_(std::move(own)), obstacle_(std::move(obstacle)), own_tree_(tree_of(*own_, own_places)) {
    if (!is_of_itself()) obstacle_tree_ = tree_of(*obstacle_, obstacle_places);
}

PairSet::PairSet(std::shared_ptr<const Elements> own, const PointArrays& places)
    : PairSet(own, places, own, places) {}

void PairSet::find_boxes(const Elements& elements, const PointArrays& from, const PointArrays& to,
                         const Workers& workers, Boxes& boxes) const {
    const auto find = [&](std::vector<SweptBox>& result, std::size_t count, const auto& points_of) {
        result.resize(count);
        workers.for_ranges(count, kBoxesPerPiece,
                           [&](std::size_t, std::size_t, std::size_t begin, std::size_t end) {
                               for (std::size_t i = begin; i < end; ++i)
                                   result[i] = box_of(points_of(i), from, to);
                           });
    };
    find(boxes.vertices, elements.vertex_count(),
         [](std::size_t i) { return std::array{static_cast<std::uint32_t>(i)}; });
    find(boxes.edges, elements.edges.size(), [&](std::size_t i) { return elements.edges[i]; });
    find(boxes.faces, elements.all.size(), [&](std::size_t i) { return elements.all[i].vertices; });
}

void PairSet::list(const Displacements& displacements, const Workers& workers) {
    const auto& [own_from, own_to, obstacle_from, obstacle_to] = displacements;
    own_tree_.want([](std::uint32_t) { return true; }, workers);
    own_tree_.refit(own_->all, own_from, own_to, workers);
    find_boxes(*own_, own_from, own_to, workers, own_boxes_);
    const bool is_known = &obstacle_from == &obstacle_to && !obstacle_boxes_.faces.empty();
    if (!is_of_itself() && !is_known) {
        obstacle_tree_.refit(obstacle_->all, obstacle_from, obstacle_to, workers);
        find_boxes(*obstacle_, obstacle_from, obstacle_to, workers, obstacle_boxes_);
    }
    near_.clear();
    separations_.clear();
    find_near_pairs(workers);
    measure_new(own_from, obstacle_from, workers);
    list_measured(displacements, 0);
}

void PairSet::add_to_list(const Displacements& displacements, std::span<const std::uint8_t> is_other,
                          const Workers& workers) {
    const auto is_affected = [&](const Pair& pair) {
        for (std::size_t k = 0; k < moving_count(pair); ++k)
            if (is_other[pair.points[k]] != 0) return true;
        return false;
    };
    own_tree_.want(
        [&](std::uint32_t element) {
            const Element& e = own_->all[element];
            return (is_other[e.vertices[0]] | is_other[e.vertices[1]] | is_other[e.vertices[2]]) != 0;
        },
        workers);
    own_tree_.refit(own_->all, displacements.own_from, displacements.own_to, workers);
    find_boxes(*own_, displacements.own_from, displacements.own_to, workers, own_boxes_);
    near_.clear();
    separations_.clear();
    find_near_pairs(workers);
    // Of those found, the ones that are not known.
    std::vector<Pair> known;
    std::copy_if(listed_.begin(), listed_.end(), std::back_inserter(known), is_affected);
    std::sort(known.begin(), known.end(), comes_before);
    std::erase_if(near_, [&](const Pair& pair) {
        return !is_affected(pair) || std::binary_search(known.begin(), known.end(), pair, comes_before);
    });
    measure_new(displacements.own_from, displacements.obstacle_from, workers);
    // Behind them those that are listed.
    const std::size_t known_count = listed_.size();
    near_.insert(near_.end(), listed_.begin(), listed_.end());
    for (const float gap : listed_gaps_) separations_.push_back({{}, gap, {}});
    list_measured(displacements, known_count);
}

void PairSet::find_near_pairs(const Workers& workers) {
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
    found_.append_to(near_);
}

/// How far displacements close a pair along its normal.
float PairSet::closing_of(const Pair& pair, const Vec3f& normal, const Displacements& displacements) const {
    std::array<float, 2> most;
    most.fill(-std::numeric_limits<float>::infinity());
    const std::size_t of_own = own_count(pair.kind);
    for (std::size_t k = 0; k < 4; ++k) {
        const std::uint32_t point = pair.points[k];
        const float along =
            k < of_own ? -dot(normal, displacements.own_to[point] - displacements.own_from[point])
                       : dot(normal, displacements.obstacle_to[point] - displacements.obstacle_from[point]);
        most[k < of_own ? 0 : 1] = std::max(most[k < of_own ? 0 : 1], along);
    }
    return most[0] + most[1];
}

/// Takes what was found and measured as the list, the nearest first: then a call that needs only those ends
/// early. Pairs that stay apart along their own normal are left out. @param known_count  of the last ones,
/// which were listed
void PairSet::list_measured(const Displacements& displacements, std::size_t known_count) {
    std::array<std::size_t, kGapSteps + 1> first{};
    float largest = 0;
    for (std::size_t p = 0; p < near_.size(); ++p) {
        Separation& apart = separations_[p];
        if (p + known_count < near_.size() && apart.gap > reach_ &&
            apart.gap - closing_of(near_[p], apart.normal, displacements) > reach_)
            apart.gap = std::numeric_limits<float>::infinity();
        else
            largest = std::max(largest, apart.gap);
    }
    gap_step_ = largest / static_cast<float>(kGapSteps);
    const auto step_of = [&](float gap) {
        const float steps = largest > 0 ? gap / largest * static_cast<float>(kGapSteps) : 0;
        return static_cast<std::size_t>(std::clamp(steps, 0.0F, static_cast<float>(kGapSteps - 1)));
    };
    const auto is_left_out = [](const Separation& apart) {
        return !(apart.gap <= std::numeric_limits<float>::max());
    };
    for (const Separation& apart : separations_)
        if (!is_left_out(apart)) ++first[step_of(apart.gap) + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    listed_.resize(first.back());
    listed_gaps_.resize(first.back());
    for (std::size_t p = 0; p < near_.size(); ++p) {
        if (is_left_out(separations_[p])) continue;
        const std::size_t to = first[step_of(separations_[p].gap)]++;
        listed_[to] = near_[p];
        listed_gaps_[to] = separations_[p].gap;
    }
    near_.clear();
    separations_.clear();
    is_near_.assign(listed_.size(), 0);
}

void PairSet::add_pairs(const std::array<std::uint32_t, 2>& elements, std::vector<Pair>& pairs) const {
    const Element& own = own_->all[elements[0]];
    const Element& other = obstacle_->all[elements[1]];
    const Boxes& others = obstacle_boxes();
    const SweptBox& own_box = own_boxes_.faces[elements[0]];
    const SweptBox& other_box = others.faces[elements[1]];
    if (!come_near(own_box, other_box, reach_)) return;
    if (other.is_face())
        for (std::size_t k = 0; k < own.vertex_count; ++k) {
            const std::uint32_t v = own.vertices[k];
            if (!own.owns_vertex(k) || (is_of_itself() && other.has(v))) continue;
            if (come_near(own_boxes_.vertices[v], other_box, reach_))
                pairs.push_back(
                    {{v, other.vertices[0], other.vertices[1], other.vertices[2]}, PairKind::VertexFace});
        }
    if (own.is_face())
        for (std::size_t k = 0; k < other.vertex_count; ++k) {
            const std::uint32_t v = other.vertices[k];
            if (!other.owns_vertex(k) || (is_of_itself() && own.has(v))) continue;
            if (!come_near(others.vertices[v], own_box, reach_)) continue;
            if (is_of_itself())
                pairs.push_back(
                    {{v, own.vertices[0], own.vertices[1], own.vertices[2]}, PairKind::VertexFace});
            else
                pairs.push_back(
                    {{own.vertices[0], own.vertices[1], own.vertices[2], v}, PairKind::FaceVertex});
        }
    for (std::size_t i = 0; i < edge_count(own); ++i) {
        if (!own.owns_edge(i) || !come_near(own_boxes_.edges[own.edges[i]], other_box, reach_)) continue;
        const Edge edge{own.vertices[i], own.vertices[(i + 1) % 3]};
        for (std::size_t j = 0; j < edge_count(other); ++j) {
            if (!other.owns_edge(j)) continue;
            const Edge across{other.vertices[j], other.vertices[(j + 1) % 3]};
            if (is_of_itself() && (edge[0] == across[0] || edge[0] == across[1] || edge[1] == across[0] ||
                                   edge[1] == across[1]))
                continue;
            if (come_near(own_boxes_.edges[own.edges[i]], others.edges[other.edges[j]], reach_))
                pairs.push_back({{edge[0], edge[1], across[0], across[1]}, PairKind::EdgeEdge});
        }
    }
}

void PairSet::measure(const Course& course, const PointArrays& obstacle, float near, bool is_elsewhere,
                      const Workers& workers) {
    if (is_elsewhere) {
        near_.clear();
        separations_.clear();
        std::fill(is_near_.begin(), is_near_.end(), std::uint8_t{0});
    }
    const auto nearer_at = [&](std::uint32_t v) { return course.strayed[v] + 2 * course.ahead[v]; };
    // No pair is nearer by more than what two vertices could do to it.
    float most = 0;
    for (std::uint32_t v = 0; v < course.strayed.size(); ++v) most = std::max(most, nearer_at(v));
    const float last = near + 2 * (most + gap_step_);
    for (std::size_t p = 0; p < listed_.size() && listed_gaps_[p] <= last; ++p) {
        if (is_near_[p] != 0) continue;
        const Pair& pair = listed_[p];
        std::array<float, 2> nearer{};
        const std::size_t moving = moving_count(pair), of_own = own_count(pair.kind);
        for (std::size_t k = 0; k < moving; ++k) {
            float& of_part = nearer[k < of_own ? 0 : 1];
            of_part = std::max(of_part, nearer_at(pair.points[k]));
        }
        if (!(listed_gaps_[p] - (nearer[0] + nearer[1]) < near)) continue;
        if (is_of_itself() && !(listed_gaps_[p] - nearer_by(pair, course) < near)) continue;
        is_near_[p] = 1;
        near_.push_back(pair);
    }
    measure_new(course.now, obstacle, workers);
}

/// By how much the parts of a pair of itself can have come nearer, at most: by what they do not do together.
float PairSet::nearer_by(const Pair& pair, const Course& course) const {
    float strayed_sq = 0, ahead_sq = 0;
    const auto add = [](float& most_sq, const Vec3f& v) { most_sq = std::max(most_sq, dot(v, v)); };
    const std::size_t of_own = own_count(pair.kind);
    for (std::size_t k = 0; k < of_own; ++k)
        for (std::size_t l = of_own; l < 4; ++l) {
            const std::uint32_t a = pair.points[k], b = pair.points[l];
            const Vec3f now = course.now[a] - course.now[b];
            add(strayed_sq, now - (course.listed[a] - course.listed[b]));
            add(ahead_sq, course.base[a] - course.base[b] - now);
            add(ahead_sq, course.goal[a] - course.goal[b] - now);
        }
    return std::sqrt(strayed_sq) + 2 * std::sqrt(ahead_sq);
}

/// Measures those of `near_` that are not.
void PairSet::measure_new(const PointArrays& own, const PointArrays& obstacle, const Workers& workers) {
    const std::size_t first = separations_.size();
    separations_.resize(near_.size());
    const std::span<const Pair> pairs = std::span(near_).subspan(first);
    const std::span<Separation> result = std::span(separations_).subspan(first);
    workers.for_ranges(pairs.size(), kPairsPerPiece,
                       [&](std::size_t, std::size_t, std::size_t begin, std::size_t end) {
                           echinus::separations(pairs.subspan(begin, end - begin), own, obstacle,
                                                result.subspan(begin, end - begin));
                       });
}

void PairSet::archive(StateArchive& state) {
    listed_gaps_.resize(listed_.size());
    state.items(listed_, [&](Pair& pair) {
        state.choice(pair.kind, PairKind::EdgeEdge);
        for (std::size_t k = 0; k < 4; ++k)
            state.index(pair.points[k], (k < own_count(pair.kind) ? own_ : obstacle_)->vertex_count());
    });
    state.list(listed_gaps_);
    state.value(gap_step_);
    state.require(listed_gaps_.size() == listed_.size());
    near_.clear();
    separations_.clear();
    is_near_.assign(listed_.size(), 0);
}

} // namespace echinus
