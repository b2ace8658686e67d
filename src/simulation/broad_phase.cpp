#include "simulation/broad_phase.hpp"

#include "simulation/surfaces/model_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <variant>

namespace echinus {

namespace {

/// Of coordinates: far more than is rounded on the way from one frame to another.
constexpr double kRounding = 1e-6;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

WideBox empty_box() {
    return {{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
}

WideBox box_of(const PointArrays& points, std::size_t count) {
    WideBox box = empty_box();
    const auto range = [&](const std::vector<float>& c, double& low, double& high) {
        float least = c[0], most = c[0];
        for (std::size_t i = 1; i < count; ++i) {
            least = std::min(least, c[i]);
            most = std::max(most, c[i]);
        }
        low = double{least};
        high = double{most};
    };
    range(points.x, box.low.x, box.high.x);
    range(points.y, box.low.y, box.high.y);
    range(points.z, box.low.z, box.high.z);
    return box;
}

double largest(const Vec3d& v) {
    return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
}

/// How far a collider takes a place in the box along at most.
double way_of(const Collider& collider, const WideBox& box, double seconds) {
    if (!collider.moves()) return 0;
    double farthest = 0;
    for (const Vec3d& corner : box.corners())
        farthest = std::max(farthest, length(corner - collider.pose.translation));
    return (length(collider.linear_velocity) + length(collider.angular_velocity) * farthest) * seconds;
}

} // namespace

void WideBox::add(const Vec3d& p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
}

void WideBox::grow(double by) {
    low -= {by, by, by};
    high += {by, by, by};
}

std::array<Vec3d, 8> WideBox::corners() const {
    std::array<Vec3d, 8> result;
    for (unsigned i = 0; i < 8; ++i)
        result[i] = {(i & 1U) != 0 ? high.x : low.x, (i & 2U) != 0 ? high.y : low.y,
                     (i & 4U) != 0 ? high.z : low.z};
    return result;
}

BroadPhase::BroadPhase(const std::vector<Collider>& colliders)
    : models_(colliders.size(), empty_box()), can_be_away_(colliders.size(), 0), away_(colliders.size(), 0),
      start_poses_(colliders.size()) {
    met_late_.reserve(colliders.size());
    for (std::size_t c = 0; c < colliders.size(); ++c) {
        const auto* exact = std::get_if<ExactMap>(&colliders[c].map.kind);
        if (exact == nullptr) continue;
        can_be_away_[c] = 1;
        for (const Vec3f& vertex : model_mesh(exact->view(), colliders[c].scale).vertices)
            models_[c].add(Vec3d(vertex));
    }
}

void BroadPhase::deform(std::size_t collider, const PointArrays& from, const PointArrays& to) {
    if (can_be_away_[collider] == 0) return;
    models_[collider] = empty_box();
    for (const PointArrays* points : {&from, &to}) {
        const WideBox box = box_of(*points, points->x.size() - PointArrays::kPadding);
        models_[collider].add(box.low);
        models_[collider].add(box.high);
    }
}

void BroadPhase::begin_frame(const std::vector<Collider>& colliders, const Particles& particles,
                             double frame_seconds, double keep, std::uint32_t substeps) {
    // What falls on a single one that stands is mostly near.
    if (colliders.size() < 2 &&
        std::none_of(colliders.begin(), colliders.end(), std::mem_fn(&Collider::moves))) {
        std::fill(away_.begin(), away_.end(), std::uint8_t{0});
        return;
    }
    start_ = box_of(particles.positions, particles.count());
    const WideBox before = box_of(particles.previous, particles.count());
    // All go on as the box has moved, and half as far again.
    const double way =
        1.5 * substeps * std::max(largest(start_.low - before.low), largest(start_.high - before.high));
    carry_ = 0;
    for (std::size_t c = 0; c < colliders.size(); ++c) {
        carry_ = std::max(carry_, way_of(colliders[c], start_, frame_seconds));
        start_poses_[c] = colliders[c].pose;
    }
    for (std::size_t c = 0; c < colliders.size(); ++c)
        away_[c] = can_be_away_[c] != 0 &&
                   !touches(c, pose_after(colliders[c], frame_seconds), start_, keep + way + carry_);
}

const std::vector<std::size_t>& BroadPhase::end_frame(const std::vector<Collider>& colliders,
                                                      const Particles& particles) {
    met_late_.clear();
    if (std::find(away_.begin(), away_.end(), std::uint8_t{1}) == away_.end()) return met_late_;
    const WideBox end = box_of(particles.positions, particles.count());
    for (std::size_t c = 0; c < colliders.size(); ++c) {
        if (away_[c] == 0 || !touches(c, colliders[c].pose, end, carry_)) continue;
        away_[c] = 0;
        met_late_.push_back(c);
    }
    return met_late_;
}

void BroadPhase::archive(StateArchive& state) {
    for (WideBox& model : models_) {
        state.value(model.low);
        state.value(model.high);
    }
    for (std::size_t c = 0; c < away_.size(); ++c) {
        state.choice(away_[c], std::uint8_t{1});
        state.require(away_[c] <= can_be_away_[c]);
    }
}

/// Does the model's box touch that of all places between the start and an end, as the model sees them?
bool BroadPhase::touches(std::size_t collider, const RigidTransform& end_pose, const WideBox& end,
                         double by) const {
    WideBox seen = empty_box();
    for (const Vec3d& corner : start_.corners()) seen.add(start_poses_[collider].to_local(corner));
    for (const Vec3d& corner : end.corners()) seen.add(end_pose.to_local(corner));
    const double extent = std::max({largest(seen.low), largest(seen.high), largest(start_.low),
                                    largest(start_.high), largest(end_pose.translation)});
    // Places are rounded to single precision in both frames.
    seen.grow(by + extent * kRounding);
    // Written so that NaN touches.
    const WideBox& model = models_[collider];
    const bool apart = seen.low.x > model.high.x || seen.high.x < model.low.x || seen.low.y > model.high.y ||
                       seen.high.y < model.low.y || seen.low.z > model.high.z || seen.high.z < model.low.z;
    return !apart;
}

} // namespace echinus
