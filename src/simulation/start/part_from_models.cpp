#include "simulation/start/part_from_models.hpp"

#include "geometry/union_find.hpp"
#include "simulation/jakobsen/collider_now.hpp"
#include "simulation/start/best_places.hpp"
#include "simulation/start/model_pairs.hpp"
#include "simulation/start/progress.hpp"
#include "simulation/surfaces/model_mesh.hpp"

#include <echinus/exact_map.hpp>
#include <echinus/intersections.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <variant>

namespace echinus {

namespace {

/// Intersecting elements move by a step in each round. A step is half a thickness or this share of an edge.
constexpr int kMostRounds = 200;
constexpr int kPatience = 40;       // a face that is raised along a tip intersects it all the time,
constexpr float kStepGrowth = 1.1F; // in steps that grow meanwhile
constexpr float kStepShare = 1.0F / 16;

/// The largest number of surfaces that a particle may cross on its way out of nested parts.
constexpr int kMostCrossings = 64;

/// The least sum of normals of a part over its area: the normals of a nearly closed part cancel out, and it
/// has no front.
constexpr float kLeastFront = 0.1F;

enum class Way { Nearest, Forwards, Backwards };

Vec3f unit_or_zero(const Vec3f& v) {
    const float size = length(v);
    return size > 0 ? v * (1 / size) : Vec3f{};
}

std::vector<std::uint32_t> joined(std::vector<std::uint32_t> a, const std::vector<std::uint32_t>& b) {
    a.insert(a.end(), b.begin(), b.end());
    std::sort(a.begin(), a.end());
    a.erase(std::unique(a.begin(), a.end()), a.end());
    return a;
}

struct Model {
    ModelPairs pairs;
    Collider collider; ///< with its exact map
    float thickness;
    double reach; ///< in the world; no straight path inside the model is longer

    Model(const Collider& of, std::vector<std::uint8_t> passes, const SimulationOptions& options)
        : pairs(of, std::move(passes)), collider(with_map(of, *map_of_surface(of))) {
        const ColliderNow now(of, of.pose, options);
        thickness = now.thickness;
        const Vec3d& s = of.scale;
        reach = 3.0 * static_cast<double>(now.map.radius) *
                std::max({std::fabs(s.x), std::fabs(s.y), std::fabs(s.z)});
    }

    /// The first position outside on a straight path out, at the thickness.
    std::optional<Vec3f> out_along(Vec3f from, const Vec3f& direction) const {
        for (int i = 0; i < kMostCrossings; ++i) {
            const Vec3f far = from + direction * static_cast<float>(reach);
            const SweepHit hit = sweep(collider, collider.pose, from, far);
            if (!hit.found()) break;
            from = hit.point + direction * thickness;
            if (!contains(collider, from)) return from;
        }
        return std::nullopt;
    }
    Vec3f out_to_nearest(const Vec3f& from) const {
        const Contact nearest = contact(collider, from);
        return nearest.point + nearest.normal * thickness;
    }
};

/// One method of moving out, from the common start.
class Attempt {
  public:
    Attempt(const Elements& elements, const std::vector<float>& inverse_masses,
            const std::vector<Model>& models, const std::vector<Vec3f>& start)
        : elements_(elements), inverse_masses_(inverse_masses), models_(models), directions_(start.size()),
          positions_(start), edge_length_(mean_edge_length(elements, start)) {}

    /// The number of intersecting pairs and of particles inside.
    std::size_t tangle_count() const {
        std::size_t count = inside_count();
        for (const Model& model : models_) {
            const auto [intersecting, touching] = model.pairs.with(mesh_of(everything()));
            count += intersecting.size() + touching.size();
        }
        return count;
    }

    void go(Way way, BestPlaces& best) {
        std::vector<std::uint32_t> active = everything();
        if (way != Way::Nearest) choose_directions(active, way == Way::Forwards ? 1.0F : -1.0F);
        Progress progress(kPatience);
        for (int round = 0; round < kMostRounds; ++round) {
            std::vector<std::uint8_t> moved(positions_.size());
            move_out_of_insides(moved);
            const std::vector<std::uint32_t> tangled =
                push_intersecting(joined(active, elements_around(moved)), moved, best);
            const std::vector<std::uint32_t> changed = elements_around(moved);
            if (changed.empty() || !progress.goes_on(pair_count_)) break;
            active = joined(changed, tangled);
            step_factor_ = progress.is_idle() ? kStepGrowth * step_factor_ : 1;
        }
    }

  private:
    std::vector<std::uint32_t> everything() const {
        std::vector<std::uint32_t> all(elements_.all.size());
        std::iota(all.begin(), all.end(), 0U);
        return all;
    }
    bool pinned(std::size_t particle) const { return inverse_masses_[particle] == 0; }

    TriangleMesh mesh_of(std::span<const std::uint32_t> chosen) const {
        TriangleMesh mesh{positions_, {}};
        for (const std::uint32_t e : chosen) mesh.faces.push_back(elements_.all[e].vertices);
        return mesh;
    }

    /// Gives all particles of a connected part that is inside or intersects a model the part's mean normal.
    void choose_directions(std::span<const std::uint32_t> all, float sign) {
        std::vector<std::uint8_t> tangled(elements_.all.size());
        for (const Model& model : models_) {
            const auto [intersecting, touching] = model.pairs.with(mesh_of(all));
            for (const auto& [e, face] : intersecting) tangled[e] = 1;
            for (const std::uint32_t e : touching) tangled[e] = 1;
            for_each_inside(model, [&](std::size_t v) {
                for (const std::uint32_t e : elements_.at(v)) tangled[e] = 1;
            });
        }
        UnionFind parts(positions_.size());
        for (std::size_t e = 0; e < tangled.size(); ++e)
            if (tangled[e] != 0)
                for (const std::uint32_t v : elements_.all[e].vertices)
                    parts.join(elements_.all[e].vertices[0], v);
        std::vector<Vec3f> normals(positions_.size());
        std::vector<float> areas(positions_.size());
        for (std::size_t e = 0; e < tangled.size(); ++e) {
            if (tangled[e] == 0) continue;
            const auto& [a, b, c] = elements_.all[e].vertices;
            const Vec3f normal = cross(positions_[b] - positions_[a], positions_[c] - positions_[a]);
            normals[parts.find(a)] += normal;
            areas[parts.find(a)] += length(normal);
        }
        for (std::size_t e = 0; e < tangled.size(); ++e) {
            if (tangled[e] == 0) continue;
            for (const std::uint32_t v : elements_.all[e].vertices) {
                const std::uint32_t part = parts.find(v);
                if (length(normals[part]) > kLeastFront * areas[part])
                    directions_[v] = unit_or_zero(normals[part]) * sign;
            }
        }
    }

    template <typename Visit>
    void for_each_inside(const Model& model, const Visit& visit) const {
        if (!model.pairs.has_inside()) return;
        std::vector<std::uint8_t> inside(positions_.size());
        contains_batch(model.collider, std::span(positions_), inside);
        for (std::size_t v = 0; v < positions_.size(); ++v)
            if (inside[v] != 0 && !model.pairs.passes(v)) visit(v);
    }

    std::size_t inside_count() const {
        std::size_t count = 0;
        for (const Model& model : models_) for_each_inside(model, [&](std::size_t) { ++count; });
        return count;
    }

    void move_out_of_insides(std::vector<std::uint8_t>& moved) {
        for (const Model& model : models_)
            for_each_inside(model, [&](std::size_t v) {
                if (pinned(v)) return;
                std::optional<Vec3f> place;
                if (directions_[v] != Vec3f{}) place = model.out_along(positions_[v], directions_[v]);
                positions_[v] = place ? *place : model.out_to_nearest(positions_[v]);
                moved[v] = 1;
            });
    }

    /// @param judged  the elements that may intersect
    /// @return those that do intersect
    std::vector<std::uint32_t> push_intersecting(const std::vector<std::uint32_t>& judged,
                                                 std::vector<std::uint8_t>& moved, BestPlaces& best) {
        std::vector<Vec3f> pushes(positions_.size());
        std::vector<std::uint32_t> tangled;
        pair_count_ = 0;
        float step = 0;
        for (const Model& model : models_) {
            const auto [intersecting, touching] = model.pairs.with(mesh_of(judged));
            const std::size_t count = intersecting.size() + touching.size();
            pair_count_ += count;
            if (count != 0) step = std::max({step, model.thickness / 2, kStepShare * edge_length_});
            const auto push_one = [&](std::uint32_t number) {
                tangled.push_back(judged[number]);
                push(tangled.back(), model, pushes);
            };
            for (std::size_t i = 0; i < intersecting.size(); ++i)
                if (i == 0 || intersecting[i].a != intersecting[i - 1].a) push_one(intersecting[i].a);
            for (const std::uint32_t number : touching) push_one(number);
        }
        best.consider(positions_, pair_count_ + inside_count());
        for (std::size_t v = 0; v < positions_.size(); ++v) {
            if (pushes[v] == Vec3f{} || pinned(v)) continue;
            positions_[v] += unit_or_zero(pushes[v]) * (step * step_factor_);
            moved[v] = 1;
        }
        return joined(tangled, {});
    }

    /// Pushes an element in the direction of its particles, which particles without a direction adopt; if
    /// there is none, away from the surface.
    void push(std::uint32_t number, const Model& model, std::vector<Vec3f>& pushes) {
        const Element& element = elements_.all[number];
        Vec3f direction{};
        for (std::size_t k = 0; k < element.vertex_count; ++k) direction += directions_[element.vertices[k]];
        direction = unit_or_zero(direction);
        const bool has_direction = direction != Vec3f{};
        if (!has_direction) direction = away_from_surface(element, model);
        for (std::size_t k = 0; k < element.vertex_count; ++k) {
            const std::uint32_t v = element.vertices[k];
            if (has_direction && directions_[v] == Vec3f{}) directions_[v] = direction;
            pushes[v] += direction;
        }
    }

    Vec3f away_from_surface(const Element& element, const Model& model) const {
        const auto& [a, b, c] = element.vertices;
        const Vec3f middle = (positions_[a] + positions_[b] + positions_[c]) * (1.0F / 3);
        const float farthest = std::max(
            {length(positions_[a] - middle), length(positions_[b] - middle), length(positions_[c] - middle)});
        return contact(model.collider, middle, farthest).normal;
    }

    std::vector<std::uint32_t> elements_around(const std::vector<std::uint8_t>& particles) const {
        std::vector<std::uint32_t> around;
        for (std::uint32_t e = 0; e < elements_.all.size(); ++e) {
            const auto& vertices = elements_.all[e].vertices;
            if (std::any_of(vertices.begin(), vertices.end(), [&](auto v) { return particles[v] != 0; }))
                around.push_back(e);
        }
        return around;
    }

    const Elements& elements_;
    const std::vector<float>& inverse_masses_;
    const std::vector<Model>& models_;
    std::vector<Vec3f> directions_; ///< [particle] 0 if it has none
    std::vector<Vec3f> positions_;
    float edge_length_;
    float step_factor_ = 1;
    std::size_t pair_count_ = 0; ///< in this round
};

} // namespace

bool part_from_models(const Elements& elements, const Deformable& deformable,
                      const std::vector<Collider>& colliders, const SimulationOptions& options,
                      std::vector<Vec3f>& positions) {
    std::vector<Model> models;
    models.reserve(colliders.size());
    for (std::size_t c = 0; c < colliders.size(); ++c)
        if (map_of_surface(colliders[c]) != nullptr)
            models.emplace_back(colliders[c], let_through(deformable, c), options);
    BestPlaces best(elements, positions);
    const Attempt start(elements, deformable.inverse_masses, models, positions);
    best.consider(positions, start.tangle_count());
    if (best.pair_count() == 0) return false;
    for (const Way way : {Way::Nearest, Way::Forwards, Way::Backwards}) Attempt(start).go(way, best);
    if (best.get() == positions) return false;
    positions = best.get();
    return true;
}

} // namespace echinus
