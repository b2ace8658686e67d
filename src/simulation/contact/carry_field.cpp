#include "simulation/contact/carry_field.hpp"

#include "collider/frame_change.hpp"
#include "simulation/surfaces/model_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace echinus {

namespace {

/// The field fades over so many times the longest displacement: it then closes at most a quarter of a gap.
constexpr double kFade = 4;

bool same_pose(const RigidTransform& a, const RigidTransform& b) {
    return a.translation == b.translation && a.rotation.w == b.rotation.w && a.rotation.x == b.rotation.x &&
           a.rotation.y == b.rotation.y && a.rotation.z == b.rotation.z;
}

} // namespace

double CarryField::longest_displacement(const Collider& before, const Collider& after) {
    if (same_pose(before.pose, after.pose)) return 0;
    const ExactMap* const map = map_of_surface(before);
    if (map == nullptr) return 0;
    const ExactMapView view = map->view();
    const Vec3d scale = before.scale;
    const double largest = std::max({std::abs(scale.x), std::abs(scale.y), std::abs(scale.z)});
    const Vec3d centre = times(Vec3d(view.centre), scale);
    const Rotation turn = after.pose.rotation * before.pose.rotation.inverse();
    const double sine = length(Vec3d{turn.x, turn.y, turn.z});
    return length(after.pose.to_world(centre) - before.pose.to_world(centre)) +
           2 * sine * largest * double{view.radius};
}

CarryField::CarryField(const std::vector<Collider>& before, const std::vector<Collider>& after, double touch)
    : before_(before), after_(after), touch_(touch), reach_(touch) {
    for (std::size_t c = 0; c < before.size(); ++c) {
        const double longest = longest_displacement(before[c], after[c]);
        moves_ = moves_ || longest > 0;
        reach_ = std::max(reach_, touch + kFade * longest);
    }
}

Vec3d CarryField::displacement_at(const Vec3f& point) const {
    Vec3d sum;
    double weights = 0, nearest = std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < before_.size(); ++c) {
        const Contact found = contact(before_[c], point, static_cast<float>(reach_));
        if (!found.found()) continue;
        const double distance = std::max(double{std::fabs(found.depth)}, std::numeric_limits<double>::min());
        nearest = std::min(nearest, distance);
        const Vec3d material =
            before_[c].pose.rotation.inverse().apply(Vec3d(point) - before_[c].pose.translation);
        const double weight = 1 / distance;
        sum += (after_[c].pose.to_world(material) - Vec3d(point)) * weight;
        weights += weight;
    }
    if (!(nearest < reach_)) return {};
    const double fading = nearest <= touch_ ? 1 : (reach_ - nearest) / (reach_ - touch_);
    return sum * (fading / weights);
}

void CarryField::carry(PointArrays& points, std::span<const std::uint8_t> is_held,
                       const Workers& workers) const {
    if (!moves_) return;
    constexpr std::size_t kPointsPerPiece = 256;
    workers.for_ranges(is_held.size(), kPointsPerPiece,
                       [&](std::size_t, std::size_t, std::size_t begin, std::size_t end) {
                           for (std::size_t i = begin; i < end; ++i)
                               if (is_held[i] == 0)
                                   points.set(i, Vec3f(Vec3d(points[i]) + displacement_at(points[i])));
                       });
}

} // namespace echinus
