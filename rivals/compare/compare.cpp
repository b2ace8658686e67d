#include "rivals/compare/compare.hpp"

#include "rivals/compare/clock.hpp"

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

constexpr std::size_t kFewestPoints = 100;

// ---- What is true ----

struct JudgedSet {
    std::string name;
    std::vector<Vec3f> points;
    Truth truth;
};

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
    add("U", uniform_points(mesh, options.point_count));
    add("S", surface_points(mesh, options.point_count));
    add("C", cloth_points(mesh, side, side, options.up));
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

// ---- What is built ----

struct Competitor {
    Built structure;
    Figures figures;
};

/// Builds a structure, several times over when that is quick.
Competitor build_timed(const SystemType& system, const Recipe& recipe) {
    constexpr double kEnough = 0.1; // seconds
    constexpr std::size_t kMost = 5;
    Competitor result;
    std::vector<double> times;
    for (double sum = 0; times.empty() || (sum < kEnough && times.size() < kMost); sum += times.back()) {
        result.structure.reset();
        const double start = process_seconds();
        result.structure = recipe.build();
        times.push_back(process_seconds() - start);
    }
    result.figures = {&system,
                      result.structure->byte_count(),
                      std::string(result.structure->counted()),
                      {},
                      1e3 * (median_of(times) + recipe.shared_seconds),
                      {}};
    return result;
}

/// A system around the mesh that is compared.
struct Participant {
    const SystemType* system;
    std::unique_ptr<Sizes> sizes;
};

/// Does a system say that it cannot have this size, or this mesh, which others can?
bool is_refusal(const Error& error) {
    return error.code() == ErrorCode::InvalidOptions || error.code() == ErrorCode::InvalidMesh;
}

std::vector<Participant> participants_of(const TriangleMesh& mesh, const CompareOptions& options,
                                         std::vector<Refusal>& refusals) {
    std::vector<const SystemType*> chosen;
    for (const std::string& name : options.systems)
        if (const SystemType& system = system_named(name); std::ranges::find(chosen, &system) == chosen.end())
            chosen.push_back(&system);
    if (chosen.empty())
        for (const SystemType& system : all_systems())
            if (system.available()) chosen.push_back(&system);
    std::vector<Participant> participants;
    for (const SystemType* system : chosen) {
        const Progress progress = [&options, system](std::string_view stage, double share) {
            if (options.report_progress)
                options.report_progress(std::string(system->title) + ": " + std::string(stage), share);
        };
        try {
            participants.push_back({system, system->on(mesh, options.system, progress)});
        } catch (const Error& error) {
            if (error.code() != ErrorCode::InvalidMesh) throw; // options are the caller's mistake
            refusals.push_back({system, error.what()});
        }
    }
    return participants;
}

// ---- What is measured ----

struct Effort {
    int passes;
    double enough_seconds; ///< who took so long in all passes is asked no more
};
constexpr Effort kForTable{5, 1};
constexpr Effort kForCurves{3, 0.5};
/// Seconds. Who seems to take longer for a set is asked for parts of it; by a trial in small calls, at which
/// systems that gain by the number of particles in a call look slower than they are.
constexpr double kPatience = 30;

/// All competitors, asked for a set.
/// @param ask  void (const System&, Part of the set)
template <typename Ask>
std::vector<Racer> racers_for(const std::vector<Competitor>& competitors, std::size_t point_count,
                              const Ask& ask) {
    std::vector<Racer> racers;
    for (const Competitor& competitor : competitors) {
        const auto run = [&ask, structure = competitor.structure.get()](Part part) { ask(*structure, part); };
        racers.push_back({run, parts_for(run, point_count, kPatience)});
    }
    return racers;
}

std::vector<Pace> race(const std::vector<Racer>& racers, const Effort& effort,
                       const std::function<void(double)>& report_progress) {
    TurnOptions turns;
    turns.passes = effort.passes;
    turns.enough_seconds = effort.enough_seconds;
    turns.report_progress = report_progress;
    return take_turns(racers, turns);
}

/// Sides as contains_batch() told them, ways out as contacts_batch() did.
Answers answers_of(const std::vector<Part>& parts, const std::vector<std::uint8_t>& inside,
                   const std::vector<Contact>& contacts) {
    Answers answers;
    for (const Part& part : parts)
        for (std::size_t i = part.begin; i < part.end; ++i) {
            const bool found = contacts[i].inside;
            answers.asked.push_back(static_cast<std::uint32_t>(i));
            answers.inside.push_back(inside[i]);
            answers.depth.push_back(found ? contacts[i].depth : 0);
            answers.normal.push_back(found ? contacts[i].normal : Vec3f{});
        }
    return answers;
}

void measure(const JudgedSet& set, double radius, const Effort& effort,
             const std::function<void(double)>& report_progress, std::vector<Competitor>& competitors) {
    const std::size_t count = set.points.size();
    std::vector<std::uint8_t> inside(count);
    std::vector<Contact> contacts(count);
    const auto of = [](auto& all, Part part) { return std::span(all).subspan(part.begin, part.size()); };
    const auto ask_sides = [&](const rivals::System& structure, Part part) {
        structure.contains_batch(of(set.points, part), of(inside, part));
    };
    const auto ask_contacts = [&](const rivals::System& structure, Part part) {
        structure.contacts_batch(of(set.points, part), of(contacts, part));
    };
    const std::vector<Pace> sides = race(racers_for(competitors, count, ask_sides), effort,
                                         [&](double fraction) { report_progress(fraction / 2); });
    const std::vector<Racer> racers = racers_for(competitors, count, ask_contacts);
    const std::vector<Pace> ways_out =
        race(racers, effort, [&](double fraction) { report_progress((1 + fraction) / 2); });
    for (std::size_t k = 0; k < competitors.size(); ++k) {
        for (const Part& part : racers[k].parts) { // the last who wrote was another
            ask_sides(*competitors[k].structure, part);
            ask_contacts(*competitors[k].structure, part);
        }
        const Answers answers = answers_of(racers[k].parts, inside, contacts);
        competitors[k].figures.sets.push_back(
            {set.name, sides[k], ways_out[k], errors_of(set.truth, radius, answers, kUndecided)});
    }
}

// ---- All of it ----

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

std::vector<Competitor> build_all(std::vector<Participant>& participants, const CompareOptions& options,
                                  std::vector<Refusal>& refusals) {
    std::vector<Competitor> competitors;
    std::vector<Participant> built;
    for (Participant& participant : participants) {
        const SystemType& system = *participant.system;
        Stage(options, "building: " + std::string(system.title))(0);
        std::string reason = "it comes in this size only";
        try {
            competitors.push_back(build_timed(system, participant.sizes->within(options.byte_budget)));
        } catch (const Error& error) {
            if (!is_refusal(error)) throw;
            reason = error.what();
            const std::optional<Recipe> usual =
                error.code() == ErrorCode::InvalidOptions ? participant.sizes->usual() : std::nullopt;
            if (!usual) {
                refusals.push_back({&system, reason});
                continue;
            }
            competitors.push_back(build_timed(system, *usual));
        }
        if (competitors.back().figures.byte_count > options.byte_budget)
            competitors.back().figures.excess = reason;
        built.push_back(std::move(participant));
    }
    participants = std::move(built);
    if (competitors.empty())
        throw Error(ErrorCode::InvalidOptions, "no system fits; " + refusals.front().reason);
    return competitors;
}

/// In ascending order.
std::vector<std::size_t> budgets_of(const CompareOptions& options) {
    std::vector<std::size_t> budgets;
    std::size_t budget =
        std::min(options.byte_budget * CompareOptions::kTopOfCurve, CompareOptions::kMostBytes);
    for (std::size_t k = 0; k < options.curve_length; ++k, budget /= 2) budgets.push_back(budget);
    std::ranges::reverse(budgets);
    return budgets;
}

/// A system in all the sizes that it can be had in.
std::vector<Competitor> build_sizes(Participant& participant, const CompareOptions& options) {
    std::vector<Competitor> sizes;
    for (const std::size_t budget : budgets_of(options)) {
        try {
            Competitor size = build_timed(*participant.system, participant.sizes->within(budget));
            // Of one size, or at its limit.
            if (!sizes.empty() && size.figures.byte_count == sizes.back().figures.byte_count) continue;
            sizes.push_back(std::move(size));
        } catch (const Error& error) {
            if (!is_refusal(error)) throw; // too small a budget
        }
    }
    if (sizes.empty())
        if (const std::optional<Recipe> usual = participant.sizes->usual())
            sizes.push_back(build_timed(*participant.system, *usual));
    return sizes;
}

std::vector<std::vector<Figures>> measure_curves(std::vector<Participant>& participants, const JudgedSet& set,
                                                 double radius, const CompareOptions& options) {
    std::vector<std::vector<Figures>> curves;
    for (Participant& participant : participants) {
        const Stage stage(options, "curve: " + std::string(participant.system->title));
        stage(0);
        std::vector<Competitor> sizes = build_sizes(participant, options);
        measure(set, radius, kForCurves, stage, sizes);
        curves.emplace_back();
        for (Competitor& size : sizes) curves.back().push_back(std::move(size.figures));
    }
    return curves;
}

void require_usable(const CompareOptions& options) {
    if (options.byte_budget == 0 || options.byte_budget > CompareOptions::kMostBytes)
        throw Error(ErrorCode::InvalidOptions, "the byte budget is " + std::to_string(options.byte_budget) +
                                                   ", outside [1, " +
                                                   std::to_string(CompareOptions::kMostBytes) + "]");
    if (options.point_count < kFewestPoints)
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
    std::vector<Participant> participants = participants_of(mesh, options, result.refusals);
    Stage(options, "judging the particles")(0);
    const std::vector<JudgedSet> sets = make_sets(mesh, options);
    result.parts_overlap = parts_overlap(mesh, sets);
    std::vector<Competitor> competitors = build_all(participants, options, result.refusals);
    for (const JudgedSet& set : sets) {
        result.set_names.push_back(set.name);
        measure(set, result.radius, kForTable, Stage(options, "asking about " + set.name), competitors);
    }
    for (Competitor& competitor : competitors) result.systems.push_back(std::move(competitor.figures));
    if (options.curve_length > 0)
        result.curves = measure_curves(participants, sets[kNearSurface], result.radius, options);
    return result;
}

} // namespace echinus::comparison
