#include "simulation/contact/pair_set.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace echinus {

namespace {

constexpr std::size_t kPairsPerPiece = 512;
/// The number of classes into which pairs are sorted by their gaps.
constexpr std::size_t kGapSteps = 64;

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

void PairSet::list(const Displacements& displacements, std::span<const std::uint8_t> is_other,
                   bool starts_there, const Workers& workers) {
    const auto& [own_from, own_to, obstacle_from, obstacle_to] = displacements;
    const auto is_affected = [&](const Pair& pair) {
        for (std::size_t k = 0; k < moving_count(pair); ++k)
            if (is_other[pair.points[k]] != 0) return true;
        return false;
    };
    own_tree_.want([](std::uint32_t) { return true; }, workers);
    own_tree_.refit(own_->all, own_from, own_to, workers);
    own_tree_.want(
        [&](std::uint32_t element) {
            const Element& e = own_->all[element];
            return (is_other[e.vertices[0]] | is_other[e.vertices[1]] | is_other[e.vertices[2]]) != 0;
        },
        workers);
    if (!is_of_itself() && !obstacle_stands_) {
        obstacle_tree_.refit(obstacle_->all, obstacle_from, obstacle_to, workers);
        obstacle_stands_ = &obstacle_from == &obstacle_to;
    }
    find_pairs(displacements, workers);
    ScratchVector<Pair> known(workers.scratch());
    if (starts_there) {
        std::copy_if(listed_.begin(), listed_.end(), std::back_inserter(known), is_affected);
        std::sort(known.begin(), known.end(), comes_before);
    }
    std::erase_if(near_, [&](const Pair& pair) {
        return !is_affected(pair) || std::binary_search(known.begin(), known.end(), pair, comes_before);
    });
    measure_new(own_from, obstacle_from, workers);
    // They are followed by the pairs that stay.
    const std::size_t found_count = near_.size();
    for (std::size_t p = 0; p < listed_.size(); ++p) {
        if (!starts_there && is_affected(listed_[p])) continue;
        near_.push_back(listed_[p]);
        if (starts_there) separations_.push_back({{}, listed_gaps_[p], {}});
    }
    if (!starts_there) measure_new(own_from, obstacle_from, workers);
    list_measured(displacements, starts_there ? near_.size() - found_count : 0);
}

void PairSet::find_pairs(const Displacements& displacements, const Workers& workers) {
    near_.clear();
    separations_.clear();
    const MovingElements own{*own_, displacements.own_from, displacements.own_to},
        obstacle{*obstacle_, displacements.obstacle_from, displacements.obstacle_to};
    near_elements_.resize(workers.count());
    found_.begin(workers, own_tree_.piece_count());
    workers.for_pieces(own_tree_.piece_count(), [&](std::size_t worker, std::size_t piece) {
        auto& near = near_elements_[worker];
        near.clear();
        find_near(own_tree_, is_of_itself() ? own_tree_ : obstacle_tree_, reach_, piece, near);
        found_.add(worker, piece,
                   [&](std::vector<Pair>& pairs) { find_near_pairs(near, own, obstacle, reach_, pairs); });
    });
    found_.append_to(near_);
}

float closing_of(const Pair& pair, const Vec3f& normal, const PairSet::Displacements& displacements) {
    const auto& [own_from, own_to, obstacle_from, obstacle_to] = displacements;
    constexpr float kNothing = -std::numeric_limits<float>::infinity();
    const auto along = [&](const PointArrays& from, const PointArrays& to, std::uint32_t point) {
        return dot(normal, to[point] - from[point]);
    };
    const std::size_t of_own = own_count(pair.kind);
    float most_own = kNothing, most_of_obstacle = kNothing;
    for (std::size_t k = 0; k < of_own; ++k)
        most_own = std::max(most_own, -along(own_from, own_to, pair.points[k]));
    if (&obstacle_from == &obstacle_to) return most_own;
    for (std::size_t k = of_own; k < 4; ++k)
        most_of_obstacle = std::max(most_of_obstacle, along(obstacle_from, obstacle_to, pair.points[k]));
    return most_own + most_of_obstacle;
}

/// Makes the pairs that were found and measured the list, the nearest first, so that a call that needs only
/// these ends early. Pairs that stay apart along their own normal are left out. @param kept_count  the number
/// of last pairs, which stay in any case
void PairSet::list_measured(const Displacements& displacements, std::size_t kept_count) {
    std::array<std::size_t, kGapSteps + 1> first{};
    float largest = 0;
    for (std::size_t p = 0; p < near_.size(); ++p) {
        Separation& apart = separations_[p];
        if (p + kept_count < near_.size() && apart.gap > reach_ &&
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

void PairSet::measure(const Course& course, const PointArrays& obstacle, float near, bool is_elsewhere,
                      const Workers& workers) {
    if (is_elsewhere) {
        near_.clear();
        separations_.clear();
        std::fill(is_near_.begin(), is_near_.end(), std::uint8_t{0});
    }
    const auto nearer_at = [&](std::uint32_t v) { return course.strayed[v] + 2 * course.ahead[v]; };
    // No pair comes nearer by more than twice the most that a single vertex can contribute.
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

/// The most by which the two parts of a pair of the surface with itself can have come nearer: only their
/// relative motion counts.
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

/// Measures the pairs of `near_` that are not measured yet.
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
