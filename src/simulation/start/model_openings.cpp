#include "simulation/start/model_openings.hpp"

#include "simulation/start/thresholds.hpp"
#include "simulation/surfaces/model_mesh.hpp"

#include <echinus/exact_map.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace echinus {

namespace {

Vec3d area_normal(const std::array<Vec3f, 3>& t) {
    return cross(Vec3d(t[1]) - Vec3d(t[0]), Vec3d(t[2]) - Vec3d(t[0]));
}

float extent_of(const Collider& collider) {
    const Vec3d& s = collider.scale;
    const double scale = std::max({std::fabs(s.x), std::fabs(s.y), std::fabs(s.z)});
    return static_cast<float>(3 * double{map_of_surface(collider)->view().radius} * scale);
}

} // namespace

ModelOpenings::ModelOpenings(const Elements& elements, const Collider& collider,
                             std::vector<std::uint8_t> passes, float gap, float edge_length, ExitSide side)
    : elements_(elements), pairs_(collider, std::move(passes)),
      collider_(with_map(collider, *map_of_surface(collider))), gap_(gap), edge_length_(edge_length),
      extent_(extent_of(collider)), directions_(elements, side), inside_(elements.vertex_count()),
      nearest_(elements.vertex_count()) {}

ModelOpenings::ModelOpenings(const Elements& elements, const InnerLayer& layer, float gap, float edge_length,
                             ExitSide side)
    : ModelOpenings(elements, layer.collider(), {}, gap, edge_length, side) {
    layer_ = &layer;
}

std::size_t ModelOpenings::add(std::span<const Vec3f> positions, std::vector<Opening>& openings) {
    const std::size_t inside_count = find_inside(positions);
    add_particles(positions, openings);
    const ModelPairs::Found found = pairs_.with(surface_of(elements_, positions));
    lift_faces(positions, found, openings);
    return inside_count + found.intersecting.size() + found.touching.size();
}

/// An open surface has no inside, unless it is a layer.
std::size_t ModelOpenings::find_inside(std::span<const Vec3f> positions) {
    if (layer_ == nullptr && !pairs_.has_inside()) return 0;
    const float guarded = threshold::kGuarded * edge_length_;
    contacts_batch(collider_, positions, layer_ != nullptr ? extent_ : guarded, nearest_);
    std::size_t count = 0;
    for (std::size_t v = 0; v < positions.size(); ++v) {
        if (layer_ != nullptr) nearest_[v] = layer_->contact_of(positions[v], nearest_[v]);
        if (pairs_.passes(v) || -nearest_[v].depth > guarded) nearest_[v] = {};
        inside_[v] = nearest_[v].inside ? 1 : 0;
        count += inside_[v];
    }
    directions_.choose(positions, inside_, nearest_);
    return count;
}

/// Each particle inside moves to the nearest point of the surface, or to the one in the direction that it
/// ought to take. Those outside that are near the surface stay there.
void ModelOpenings::add_particles(std::span<const Vec3f> positions, std::vector<Opening>& openings) {
    const double stride = double{threshold::kDepthStride} * double{edge_length_};
    depths_ = 0;
    for (std::uint32_t v = 0; v < positions.size(); ++v) {
        if (!nearest_[v].found()) continue;
        Vec3f normal = nearest_[v].normal, goal = nearest_[v].point + normal * gap_;
        if (inside_[v] != 0 && dot(directions_.of(v), normal) < threshold::kOpposed)
            if (const std::optional<Vec3f> exit = exit_along(positions[v], directions_.of(v))) {
                normal = directions_.of(v);
                goal = *exit;
            }
        const Vec3d direction(normal);
        const double now = dot(direction, Vec3d(positions[v])), least = dot(direction, Vec3d(goal));
        depths_ += std::max(least - now, 0.0);
        openings.push_back({{v}, {1}, direction, std::min(least, now + stride), 0});
    }
}

Contact ModelOpenings::nearest_point(const Vec3f& from, float margin) const {
    const Contact nearest = contact(collider_, from, margin);
    return layer_ != nullptr ? layer_->contact_of(from, nearest) : nearest;
}

bool ModelOpenings::is_inside(const Vec3f& point) const {
    return layer_ != nullptr ? nearest_point(point, extent_).inside : contains(collider_, point);
}

/// The first point outside on a straight path, at the gap.
std::optional<Vec3f> ModelOpenings::exit_along(Vec3f from, const Vec3f& direction) const {
    for (int i = 0; i < threshold::kMostSurfacesCrossed; ++i) {
        const SweepHit hit = sweep(collider_, collider_.pose, from, from + direction * extent_);
        if (!hit.found()) break;
        from = hit.point + direction * gap_;
        if (!is_inside(from)) return from;
    }
    return std::nullopt;
}

/// Lifts each face without a corner inside beyond the parts of the model that come through it.
void ModelOpenings::lift_faces(std::span<const Vec3f> positions, const ModelPairs::Found& found,
                               std::vector<Opening>& openings) const {
    constexpr double kLow = -std::numeric_limits<double>::infinity();
    const std::vector<Vec3d> directions = lift_directions(positions, found);
    for (std::size_t i = 0; i < found.intersecting.size();) {
        const std::uint32_t element = found.intersecting[i].a;
        double height = kLow;
        for (; i < found.intersecting.size() && found.intersecting[i].a == element; ++i)
            for (const Vec3f& corner : pairs_.face(found.intersecting[i].b))
                height = std::max(height, dot(directions[element], Vec3d(corner)));
        const auto& [a, b, c] = elements_.all[element].vertices;
        if (inside_[a] == 0 && inside_[b] == 0 && inside_[c] == 0)
            openings.push_back(lift(positions, element, directions[element], height));
    }
    for (const std::uint32_t element : found.touching)
        openings.push_back(lift(positions, element, directions[element], kLow));
}

/// @param height  in the direction, of that which the middle of the element has to pass
Opening ModelOpenings::lift(std::span<const Vec3f> positions, std::uint32_t element, const Vec3d& direction,
                            double height) const {
    Opening opening{{}, {}, direction, 0, 0};
    double now = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        opening.particles[k] = elements_.all[element].vertices[k];
        opening.weights[k] = 1.0 / 3;
        now += dot(direction, Vec3d(positions[opening.particles[k]])) / 3;
    }
    const double stride = double{threshold::kStride} * double{edge_length_};
    opening.least = now + std::min(std::max(height - now, 0.0) + double{gap_}, stride);
    return opening;
}

/// [element] The mean normal of the model's faces that intersect an element and its neighbours, weighted by
/// their areas: the normals around a tip that comes through faces add up to its axis. Those around a rod
/// cancel out; then the elements leave along their own normals, beyond the nearer end of the rod.
std::vector<Vec3d> ModelOpenings::lift_directions(std::span<const Vec3f> positions,
                                                  const ModelPairs::Found& found) const {
    std::vector<std::uint32_t> lifted;
    std::vector<Protrusion> protrusions;
    for (std::size_t i = 0; i < found.intersecting.size();) {
        const std::size_t first = i;
        const std::uint32_t element = found.intersecting[first].a;
        while (i < found.intersecting.size() && found.intersecting[i].a == element) ++i;
        lifted.push_back(element);
        protrusions.push_back(
            protrusion_through(positions, std::span(found.intersecting).subspan(first, i - first)));
    }
    for (const std::uint32_t element : found.touching) {
        const auto& [a, b, c] = elements_.all[element].vertices;
        const Vec3f middle = (positions[a] + positions[b] + positions[c]) * (1.0F / 3);
        const float farthest = std::max(
            {length(positions[a] - middle), length(positions[b] - middle), length(positions[c] - middle)});
        const Vec3d normal(nearest_point(middle, farthest).normal);
        lifted.push_back(element);
        protrusions.push_back({normal, normal, 1});
    }
    std::vector<Protrusion> sums(positions.size());
    for (int round = 0; round < threshold::kSmoothingsOfLifts; ++round) {
        std::fill(sums.begin(), sums.end(), Protrusion{});
        for (std::size_t i = 0; i < lifted.size(); ++i)
            for (const std::uint32_t v : elements_.all[lifted[i]].vertices) sums[v] += protrusions[i];
        for (std::size_t i = 0; i < lifted.size(); ++i) {
            protrusions[i] = {};
            for (const std::uint32_t v : elements_.all[lifted[i]].vertices) protrusions[i] += sums[v];
        }
    }
    std::vector<Vec3d> directions(elements_.all.size());
    for (std::size_t i = 0; i < lifted.size(); ++i) {
        const Protrusion& protrusion = protrusions[i];
        const bool has_axis = length(protrusion.normals) >= threshold::kLeastAxis * protrusion.area;
        directions[lifted[i]] = unit_or_zero(has_axis ? protrusion.normals : protrusion.nearer_end);
    }
    return directions;
}

/// @param pairs  those of one element
ModelOpenings::Protrusion ModelOpenings::protrusion_through(std::span<const Vec3f> positions,
                                                            std::span<const FacePair> pairs) const {
    const auto& [a, b, c] = elements_.all[pairs.front().a].vertices;
    const Vec3d own = unit_or_zero(area_normal({positions[a], positions[b], positions[c]}));
    Protrusion protrusion;
    double above = 0, below = 0;
    for (const FacePair& pair : pairs) {
        const std::array<Vec3f, 3> face = pairs_.face(pair.b);
        protrusion.normals += area_normal(face);
        protrusion.area += length(area_normal(face));
        for (const Vec3f& corner : face) {
            const double height = dot(own, Vec3d(corner) - Vec3d(positions[a]));
            above = std::max(above, height);
            below = std::max(below, -height);
        }
    }
    protrusion.nearer_end = (above <= below ? own : -own) * protrusion.area;
    return protrusion;
}

} // namespace echinus
