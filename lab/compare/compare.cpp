#include "compare/compare.hpp"

#include "compare/turns.hpp"

#include <echinus/error.hpp>
#include <echinus/exact_map.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

namespace echinus::comparison {

namespace {

constexpr std::size_t kMinPoints = 100;

// ---- Truth ----

Vec3f way_out_of(const Vec3f& point, const Contact& nearest) {
    const Vec3f way = nearest.point - point;
    const float distance = length(way);
    return distance > 0 ? way * (1 / distance) : nearest.normal;
}

Truth truth_of(const ExactMap& judge, const std::vector<Vec3f>& points) {
    std::vector<Contact> nearest(points.size());
    contacts_batch(judge.view(), points, std::numeric_limits<float>::infinity(), nearest, 0);
    Truth truth;
    for (std::size_t i = 0; i < points.size(); ++i) {
        truth.inside.push_back(nearest[i].inside ? 1 : 0);
        truth.distance.push_back(std::fabs(nearest[i].depth));
        truth.way_out.push_back(way_out_of(points[i], nearest[i]));
    }
    return truth;
}

/// The place in make_sets() of the particles beside the surface, about which the curves are.
constexpr std::size_t kNearSurface = 1;

std::vector<JudgedSet> make_sets(const TriangleMesh& mesh, const CompareOptions& options) {
    const auto side = static_cast<std::size_t>(std::sqrt(static_cast<double>(options.point_count)));
    const ExactMap judge = ExactMap::build(mesh);
    std::vector<JudgedSet> sets;
    const auto add = [&](const char* name, std::vector<Vec3f> points) {
        Truth truth = truth_of(judge, points);
        sets.push_back({name, std::move(points), std::move(truth)});
    };
    add("U", test::uniform_points(mesh, options.point_count));
    add("S", test::surface_points(mesh, options.point_count));
    add("C", test::cloth_points(mesh, side, side, options.up));
    return sets;
}

/// Does it matter whether crossings or windings are counted?
bool parts_overlap(const TriangleMesh& mesh, const std::vector<JudgedSet>& sets) {
    const ExactMap by_parity = ExactMap::build(mesh, {.rule = InsideRule::Parity});
    return std::ranges::any_of(sets, [&](const JudgedSet& set) {
        std::vector<std::uint8_t> inside(set.points.size());
        contains_batch(by_parity.view(), set.points, inside, 0);
        return inside != set.truth.inside;
    });
}

// ---- Building ----

struct BuiltSystem {
    Built system;
    Figures figures;
};

BuiltSystem build_with_figures(const SystemType& type, const Builder& builder) {
    auto [system, ms] = build_timed(builder);
    Figures figures{&type, system->byte_count(), std::string(system->counted()), {}, ms, {}};
    return {std::move(system), std::move(figures)};
}

/// A system around the mesh that is compared.
struct SystemOnMesh {
    const SystemType* system;
    std::unique_ptr<Sizes> sizes;
};

/// Does a system refuse this size or this mesh, while others may accept it?
bool is_refusal(const Error& error) {
    return error.code() == ErrorCode::InvalidOptions || error.code() == ErrorCode::InvalidMesh;
}

std::vector<SystemOnMesh> systems_on(const TriangleMesh& mesh, const CompareOptions& options,
                                     std::vector<Refusal>& refusals) {
    std::vector<const SystemType*> chosen;
    for (const std::string& name : options.systems) {
        const SystemType& system = system_named(name);
        if (std::ranges::find(chosen, &system) != chosen.end())
            throw Error(ErrorCode::InvalidOptions, "the system '" + name + "' is named twice");
        chosen.push_back(&system);
    }
    if (chosen.empty())
        for (const SystemType& system : all_systems())
            if (system.available()) chosen.push_back(&system);
    std::vector<SystemOnMesh> on_mesh;
    for (const SystemType* system : chosen) {
        const Progress progress = [&options, system](std::string_view stage, double share) {
            if (options.report_progress)
                options.report_progress(std::string(system->title) + ": " + std::string(stage), share);
        };
        try {
            on_mesh.push_back({system, system->on(mesh, options.system, progress)});
        } catch (const Error& error) {
            if (error.code() != ErrorCode::InvalidMesh) throw; // options are the caller's mistake
            refusals.push_back({system, error.what()});
        }
    }
    return on_mesh;
}

// ---- Measuring ----

constexpr Effort kForTable{.passes = 5, .enough_seconds = 1, .undecided = kUndecided};
constexpr Effort kForCurves{.passes = 3, .enough_seconds = 0.5, .undecided = kUndecided};

void measure_all(const JudgedSet& set, double radius, const Effort& effort,
                 const std::function<void(double)>& report_progress, std::vector<BuiltSystem>& built) {
    std::vector<const rivals::System*> systems;
    for (const BuiltSystem& one : built) systems.push_back(one.system.get());
    std::vector<SetFigures> figures = measure(systems, set, radius, effort, report_progress);
    for (std::size_t k = 0; k < built.size(); ++k) built[k].figures.sets.push_back(std::move(figures[k]));
}

// ---- Everything ----

/// Work for which one bar is shown.
class Stage {
  public:
    Stage(const CompareOptions& options, std::string what) : options_(options), what_(std::move(what)) {}

    void operator()(double fraction) const {
        if (options_.report_progress) options_.report_progress(what_, fraction);
    }

  private:
    const CompareOptions& options_;
    std::string what_;
};

std::vector<BuiltSystem> build_all(std::vector<SystemOnMesh>& on_mesh, const CompareOptions& options,
                                   std::vector<Refusal>& refusals) {
    std::vector<BuiltSystem> built_systems;
    std::vector<SystemOnMesh> built;
    for (SystemOnMesh& one : on_mesh) {
        const SystemType& system = *one.system;
        Stage(options, "building: " + std::string(system.title))(0);
        std::string reason = "its size is fixed";
        try {
            built_systems.push_back(build_with_figures(system, one.sizes->within(options.byte_budget)));
        } catch (const Error& error) {
            if (!is_refusal(error)) throw;
            reason = error.what();
            const std::optional<Builder> usual =
                error.code() == ErrorCode::InvalidOptions ? one.sizes->usual() : std::nullopt;
            if (!usual) {
                refusals.push_back({&system, reason});
                continue;
            }
            built_systems.push_back(build_with_figures(system, *usual));
        }
        if (built_systems.back().figures.byte_count > options.byte_budget)
            built_systems.back().figures.excess = reason;
        built.push_back(std::move(one));
    }
    on_mesh = std::move(built);
    if (built_systems.empty())
        throw Error(ErrorCode::InvalidOptions, "no system fits; " + refusals.front().reason);
    return built_systems;
}

/// In ascending order.
std::vector<std::size_t> budgets_of(const CompareOptions& options) {
    std::vector<std::size_t> budgets;
    std::size_t budget =
        std::min(options.byte_budget * CompareOptions::kTopOfCurve, CompareOptions::kMaxBytes);
    for (std::size_t k = 0; k < options.curve_length; ++k, budget /= 2) budgets.push_back(budget);
    std::ranges::reverse(budgets);
    return budgets;
}

/// A system in all its available sizes.
std::vector<BuiltSystem> build_sizes(SystemOnMesh& one, const CompareOptions& options) {
    std::vector<BuiltSystem> sizes;
    for (const std::size_t budget : budgets_of(options)) {
        try {
            BuiltSystem size = build_with_figures(*one.system, one.sizes->within(budget));
            // Of one size, or at its limit.
            if (!sizes.empty() && size.figures.byte_count == sizes.back().figures.byte_count) continue;
            sizes.push_back(std::move(size));
        } catch (const Error& error) {
            if (!is_refusal(error)) throw; // too small a budget
        }
    }
    if (sizes.empty())
        if (const std::optional<Builder> usual = one.sizes->usual())
            sizes.push_back(build_with_figures(*one.system, *usual));
    return sizes;
}

std::vector<std::vector<Figures>> measure_curves(std::vector<SystemOnMesh>& on_mesh, const JudgedSet& set,
                                                 double radius, const CompareOptions& options) {
    std::vector<std::vector<Figures>> curves;
    for (SystemOnMesh& one : on_mesh) {
        const Stage stage(options, "curve: " + std::string(one.system->title));
        stage(0);
        std::vector<BuiltSystem> sizes = build_sizes(one, options);
        measure_all(set, radius, kForCurves, stage, sizes);
        curves.emplace_back();
        for (BuiltSystem& size : sizes) curves.back().push_back(std::move(size.figures));
    }
    return curves;
}

void require_usable(const CompareOptions& options) {
    if (options.byte_budget == 0 || options.byte_budget > CompareOptions::kMaxBytes)
        throw Error(ErrorCode::InvalidOptions, "the byte budget is " + std::to_string(options.byte_budget) +
                                                   ", outside [1, " +
                                                   std::to_string(CompareOptions::kMaxBytes) + "]");
    if (options.point_count < kMinPoints)
        throw Error(ErrorCode::InvalidOptions,
                    "point_count is " + std::to_string(options.point_count) + ", below 100");
}

void require_solid(const MeshReport& report) {
    if (!report.closed)
        throw Error(ErrorCode::InvalidMesh, "the mesh is not closed, so inside is not defined: a comparison "
                                            "needs a closed mesh; `echinus info` shows where it is open");
    if (report.degenerate_faces.count == report.face_count)
        throw Error(ErrorCode::InvalidMesh, "no face of the mesh has an area");
}

} // namespace

Comparison compare(const TriangleMesh& mesh, const CompareOptions& options) {
    require_usable(options);
    const MeshReport report = inspect(mesh);
    require_solid(report);
    Comparison result{mesh.faces.size(), report.bounding_sphere.radius, {}, {}, {}, false, {}};
    std::vector<SystemOnMesh> on_mesh = systems_on(mesh, options, result.refusals);
    Stage(options, "judging the particles")(0);
    const std::vector<JudgedSet> sets = make_sets(mesh, options);
    result.parts_overlap = parts_overlap(mesh, sets);
    std::vector<BuiltSystem> built_systems = build_all(on_mesh, options, result.refusals);
    for (const JudgedSet& set : sets) {
        result.set_names.push_back(set.name);
        measure_all(set, result.radius, kForTable, Stage(options, "asking about " + set.name), built_systems);
    }
    for (BuiltSystem& one : built_systems) result.systems.push_back(std::move(one.figures));
    if (options.curve_length > 0)
        result.curves = measure_curves(on_mesh, sets[kNearSurface], result.radius, options);
    return result;
}

} // namespace echinus::comparison
