#include "commands/simulation_result.hpp"

#include "commands/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <variant>
#include <vector>

using namespace echinus;

namespace {

/// Counts the elements that have less than a twentieth of their volume at rest, or are inside out.
std::size_t count_crushed(const Deformable& deformable) {
    constexpr double kCrushed = 0.05;
    const auto determinant = [](const Vec3d& a, const Vec3d& b, const Vec3d& c) {
        return dot(a, cross(b, c));
    };
    return static_cast<std::size_t>(
        std::ranges::count_if(deformable.tetrahedra, [&](const ElasticTetrahedron& tetrahedron) {
            const auto& [a, b, c, d] = tetrahedron.particles;
            const auto edge = [&, first = a](std::uint32_t corner) {
                return Vec3d(deformable.positions[corner]) - Vec3d(deformable.positions[first]);
            };
            const auto& [at_b, at_c, at_d] = tetrahedron.gradients;
            const double share =
                determinant(edge(b), edge(c), edge(d)) * determinant(Vec3d(at_b), Vec3d(at_c), Vec3d(at_d));
            return share < kCrushed;
        }));
}

struct Rates {
    double integration_ms, constraints_ms, collision_ms, total_ms;
    double queries_per_frame, map_queries_per_frame, ns_per_query, frames_per_second;
    double truncated_per_frame;
};

Rates rates_of(const Simulation& simulation) {
    const SimulationProfile& profile = simulation.profile();
    const double frames = std::max(1.0, static_cast<double>(simulation.frame()));
    const double seconds =
        profile.integration_seconds + profile.constraint_seconds + profile.collision_seconds;
    const auto queries = static_cast<double>(profile.query_count);
    return {.integration_ms = profile.integration_seconds * 1e3 / frames,
            .constraints_ms = profile.constraint_seconds * 1e3 / frames,
            .collision_ms = profile.collision_seconds * 1e3 / frames,
            .total_ms = seconds * 1e3 / frames,
            .queries_per_frame = queries / frames,
            .map_queries_per_frame = static_cast<double>(profile.map_query_count) / frames,
            .ns_per_query = queries > 0 ? profile.collision_seconds * 1e9 / queries : 0,
            .frames_per_second = seconds > 0 ? frames / seconds : 0,
            .truncated_per_frame = static_cast<double>(profile.truncated_count) / frames};
}

bool is_exact(const Simulation& simulation) {
    return std::holds_alternative<ExactMap>(simulation.colliders().front().map.kind);
}

const char* kind_of(const Simulation& simulation) {
    return is_exact(simulation) ? "exact" : "distance";
}

const char* solver_of(const SimulationOptions& options) {
    return options.kind() == SolverKind::Newton ? "newton" : "jakobsen";
}

const char* collision_of(const SimulationOptions& options) {
    return options.layers_collide()     ? "surfaces_and_self"
           : options.surfaces_collide() ? "surfaces"
                                        : "particles";
}

/// The largest number of iterations in a frame.
std::uint32_t most_iterations_of(const SimulationOptions& options) {
    const auto* newton = std::get_if<NewtonOptions>(&options.solver);
    return newton != nullptr ? newton->step_count : options.jakobsen().iteration_count;
}

Json json_of(const Vec3d& v) {
    return {v.x, v.y, v.z};
}

Json json_of(const Load& load) {
    return {{"force", json_of(load.force)}, {"torque", json_of(load.torque)}};
}

Json json_of(const std::vector<SavedLoad>& loads) {
    Json list = Json::array();
    for (const auto& [frame, load] : loads) {
        Json saved{{"frame", frame}};
        saved.add("force", json_of(load.force));
        saved.add("torque", json_of(load.torque));
        list.push_back(saved);
    }
    return list;
}

Json json_of(const std::vector<SavedPose>& poses) {
    Json list = Json::array();
    for (const auto& [frame, pose] : poses) {
        const Rotation& r = pose.rotation;
        list.push_back({{"frame", frame},
                        {"translation", json_of(pose.translation)},
                        {"rotation", {r.w, r.x, r.y, r.z}}});
    }
    return list;
}

Json json_of(const ContactGap& gap) {
    if (gap.particle_count == 0) return {{"particles", 0}, {"mean", nullptr}, {"least", nullptr}};
    return {{"particles", gap.particle_count}, {"mean", gap.mean}, {"least", gap.least}};
}

Json json_of(const std::optional<Strain>& strain) {
    if (!strain) return {{"mean", nullptr}, {"percentile_99", nullptr}, {"largest", nullptr}};
    return {{"mean", strain->mean}, {"percentile_99", strain->percentile_99}, {"largest", strain->largest}};
}

Json json_of(const WorstFrame& worst) {
    Json frame = nullptr;
    if (worst.pair_count != 0) frame = worst.frame;
    return {{"pairs", worst.pair_count}, {"frame", frame}};
}

Json json_of(const std::optional<WorstFrames>& worst) {
    if (!worst) return nullptr;
    return {{"judged", worst->judged_count},
            {"intersecting_pairs", json_of(worst->with_models)},
            {"self_intersecting_pairs", json_of(worst->own)}};
}

/// The first and the last of each run of particles that a collider lets through.
Json runs_of(const std::vector<std::uint8_t>& passes) {
    Json runs = Json::array();
    for (std::size_t first = 0; first < passes.size(); ++first) {
        if (passes[first] == 0) continue;
        std::size_t last = first;
        while (last + 1 < passes.size() && passes[last + 1] != 0) ++last;
        runs.push_back(std::vector{first, last});
        first = last;
    }
    return runs;
}

Json json_of(const ColliderResult& collider, const std::vector<std::uint8_t>& passes) {
    Json result{{"mesh", collider.mesh_name},
                {"faces", collider.model.face_count},
                {"vertices", collider.model.vertex_count},
                {"radius", collider.radius},
                {"poses", json_of(collider.poses)}};
    if (!collider.cache_name.empty()) result.add("cache", collider.cache_name);
    if (!passes.empty()) result.add("lets_through", runs_of(passes));
    return result;
}

Json json_of(const std::vector<ColliderResult>& colliders, const Simulation& simulation) {
    Json list = Json::array();
    for (std::size_t c = 0; c < colliders.size(); ++c) {
        Json collider = json_of(colliders[c], let_through(simulation.deformable(), c));
        const bool are_measured = simulation.options().kind() == SolverKind::Newton;
        collider.add("load", are_measured ? json_of(simulation.load_on(c)) : Json(nullptr));
        collider.add("loads", are_measured ? json_of(colliders[c].loads) : Json(nullptr));
        list.push_back(std::move(collider));
    }
    return list;
}

/// The radius R of the largest collider.
double radius_of(const std::vector<ColliderResult>& colliders) {
    double radius = 0;
    for (const ColliderResult& collider : colliders) radius = std::max(radius, collider.radius);
    return radius;
}

std::string percent(double share) {
    return fmt::format("{:.2f} %", share * 100);
}

} // namespace

Json to_json(const SimulationResult& result) {
    const Simulation& simulation = result.simulation;
    const SimulationOptions& options = simulation.options();
    const Deformable& deformable = simulation.deformable();
    const Rates rates = rates_of(simulation);
    Json strain = json_of(material_strain(deformable));
    strain.add("edges", json_of(edge_strain(deformable)));
    const double radius = radius_of(result.colliders);
    const ColliderResult& first = result.colliders.front();
    const double thickness = options.thickness.value();
    Json rest_frame = nullptr;
    if (simulation.at_rest()) rest_frame = simulation.frame();
    return {
        {"scene", result.scene_name},
        {"particles", deformable.particle_count()},
        {"constraints", deformable.constraints.size()},
        {"tetrahedra", {{"count", deformable.tetrahedra.size()}, {"crushed", count_crushed(deformable)}}},
        {"solver", solver_of(options)},
        {"iterations", most_iterations_of(options)},
        {"time_step", options.time_step},
        {"frames", simulation.frame()},
        {"frames_to_rest", rest_frame},
        {"ms_per_frame",
         {{"integration", rates.integration_ms},
          {"constraints", rates.constraints_ms},
          {"collision", rates.collision_ms},
          {"total", rates.total_ms}}},
        {"queries_per_frame", rates.queries_per_frame},
        {"ns_per_query", rates.ns_per_query},
        {"map_queries_per_frame", rates.map_queries_per_frame},
        {"frames_per_second", rates.frames_per_second},
        {"map_kind", kind_of(simulation)},
        {"lost_count", simulation.profile().lost_count},
        {"rescued_count", simulation.profile().rescued_count},
        {"collision", collision_of(options)},
        {"truncated", {{"mean", rates.truncated_per_frame}, {"most", result.most_truncated}}},
        {"unresolved", simulation.profile().unresolved_count},
        {"inside_at_rest", result.verdict.inside_count},
        {"deepest", {{"absolute", result.verdict.deepest}, {"in_radii", result.verdict.deepest / radius}}},
        {"intersecting_pairs", result.verdict.pairs.with_models},
        {"self_intersecting_pairs", result.verdict.pairs.own},
        {"worst_frames", json_of(result.worst)},
        {"contact_gap", json_of(result.verdict.gap)},
        {"strain", strain},
        {"largest_speed", simulation.largest_speed()},
        {"thickness", thickness},
        {"thickness_in_radii", thickness / radius},
        {"gravity", json_of(options.gravity)},
        {"model",
         {{"faces", first.model.face_count},
          {"vertices", first.model.vertex_count},
          {"radius", first.radius}}},
        {"collider", {{"mesh", first.mesh_name}, {"poses", json_of(first.poses)}}},
        {"colliders", json_of(result.colliders, simulation)},
        {"state_hash", fmt::format("{:016x}", simulation.state_hash())},
    };
}

namespace {

std::string text_of_solver(const SimulationOptions& options) {
    const char* const form = options.kind() == SolverKind::Newton
                                 ? "newton, at most {} steps of Newton's method per frame"
                                 : "jakobsen, {} relaxations per frame";
    return fmt::format(fmt::runtime(form), most_iterations_of(options));
}

std::string text_of(const std::optional<Strain>& strain) {
    if (!strain) return "none, since there is no material";
    return percent(strain->mean) + " mean, " + percent(strain->percentile_99) + " 99th percentile, " +
           percent(strain->largest) + " largest";
}

} // namespace

std::string to_text(const SimulationResult& result) {
    const Simulation& simulation = result.simulation;
    const Rates rates = rates_of(simulation);
    const std::size_t particle_count = simulation.deformable().particle_count();
    const double radius = radius_of(result.colliders);
    std::string text = result.scene_name + "\n";
    const auto add = [&](const char* label, const std::string& value) {
        text += fmt::format("  {:<24}{}\n", label, value);
    };
    add("particles, constraints",
        fmt::format("{}, {}", particle_count, simulation.deformable().constraints.size()));
    if (const Deformable& body = simulation.deformable(); !body.tetrahedra.empty())
        add("tetrahedra",
            fmt::format("{}, {} flat or inverted at the end", body.tetrahedra.size(), count_crushed(body)));
    add("solver", text_of_solver(simulation.options()));
    add("frames", fmt::format("{}, {}", simulation.frame(),
                              simulation.at_rest() ? "at rest" : "not at rest: frame limit reached"));
    add("ms per frame",
        fmt::format("{:.2f} = {:.2f} integration + {:.2f} constraints + {:.2f} collision", rates.total_ms,
                    rates.integration_ms, rates.constraints_ms, rates.collision_ms));
    add("frames per second", fmt::format("{:.0f}, on one core", rates.frames_per_second));
    add("queries", fmt::format("{:.0f} per frame, {:.1f} ns each; {:.0f} answered by the map",
                               rates.queries_per_frame, rates.ns_per_query, rates.map_queries_per_frame));
    if (is_exact(simulation))
        add("particles lost", fmt::format("{}; rescued {} times", simulation.profile().lost_count,
                                          simulation.profile().rescued_count));
    if (simulation.options().surfaces_collide())
        add("vertices truncated",
            fmt::format("{:.2f} per frame, {} at most; {} unresolved pairs", rates.truncated_per_frame,
                        result.most_truncated, simulation.profile().unresolved_count));
    add("particles inside", fmt::format("{} ({}), by winding number", result.verdict.inside_count,
                                        percent(static_cast<double>(result.verdict.inside_count) /
                                                static_cast<double>(particle_count))));
    add("deepest", fmt::format("{:.5f} = {:.5f} R", result.verdict.deepest, result.verdict.deepest / radius));
    const double thickness = simulation.options().thickness.value();
    add("thickness", fmt::format("{:.5f} = {:.5f} R", thickness, thickness / radius));
    if (const ContactGap& gap = result.verdict.gap; gap.particle_count != 0)
        add("contact gap", fmt::format("{:.3f} thicknesses on average, {:.3f} at least; {} particles",
                                       gap.mean / thickness, gap.least / thickness, gap.particle_count));
    const char* const models = result.colliders.size() == 1 ? "the model" : "the models";
    add("intersecting faces",
        fmt::format("{} pairs with {}, {} of the cloth's own", result.verdict.pairs.with_models, models,
                    result.verdict.pairs.own));
    if (result.worst)
        add("in the worst frame",
            fmt::format("{} with {}, {} of its own, in {} frames", result.worst->with_models.pair_count,
                        models, result.worst->own.pair_count, result.worst->judged_count));
    add("strain", text_of(material_strain(simulation.deformable())));
    add("state hash", fmt::format("{:016x}", simulation.state_hash()));
    return text;
}
