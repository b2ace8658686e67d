#include "judges/check_mesh.hpp"

#include "judges/check_points.hpp"

#include <echinus/error.hpp>

#include <algorithm>
#include <chrono>
#include <iterator>

namespace echinus::test {

namespace {

std::vector<ExactMap> build_maps(const TriangleMesh& mesh, const CheckOptions& options,
                                 std::span<const InsideRule> rules) {
    std::vector<ExactMap> maps;
    for (const InsideRule rule : rules) {
        ExactMapOptions map_options = options.map;
        map_options.rule = rule;
        maps.push_back(ExactMap::build(mesh, map_options));
    }
    return maps;
}

/// Parity is not defined where the surface is open.
std::vector<InsideRule> rules_with_meaning(const std::string& name, const TriangleMesh& mesh,
                                           std::vector<InsideRule> rules) {
    if (!inspect(weld(mesh)).closed) std::erase(rules, InsideRule::Parity);
    if (rules.empty())
        throw Error(ErrorCode::InvalidOptions,
                    name + " is not closed, so that parity has no meaning; use --rule nonzero");
    return rules;
}

/// Progress of one set among several.
std::function<void(std::size_t)> share_of(const CheckOptions& options, std::size_t set, std::size_t set_count,
                                          std::size_t point_count) {
    if (!options.report_progress) return {};
    return [=, &options](std::size_t done) {
        const double share = static_cast<double>(done) / static_cast<double>(point_count);
        options.report_progress((static_cast<double>(set) + share) / static_cast<double>(set_count));
    };
}

/// Larger than the distance of any particle of our sets from the surface.
float margin_around(const ExactMapView& map) {
    return 4 * map.radius;
}

} // namespace

Defendant defendant_of(const ExactMap& map) {
    return {map.view().rule, [&map](std::span<const Vec3f> points, Answers& answers) {
                answers.inside.resize(points.size());
                answers.contacts.resize(points.size());
                contains_batch(map, points, answers.inside);
                contacts_batch(map, points, margin_around(map), answers.contacts);
            }};
}

CheckResult check_mesh(const std::string& name, const TriangleMesh& mesh, const CheckOptions& options) {
    const auto start = std::chrono::steady_clock::now();
    CheckResult result;
    result.rules = rules_with_meaning(name, mesh, options.rules);
    const std::vector<ExactMap> maps = build_maps(mesh, options, result.rules);
    std::vector<Defendant> defendants;
    std::ranges::transform(maps, std::back_inserter(defendants), defendant_of);
    const ExactMapView& map = maps.front().view();
    const AccuracyJudge judge(mesh, map);

    result.mesh = name;
    result.face_count = mesh.faces.size();
    result.closed = judge.closed();
    result.divisions = map.divisions;
    result.byte_count = map.byte_count();
    result.seed = options.seed;
    result.wrong_corners = judge.wrong_corners();
    const std::vector<PointSet> sets =
        point_sets(mesh, {map.centre, map.radius, map.divisions}, options.points, options.seed);
    for (std::size_t i = 0; i < sets.size(); ++i) {
        const std::vector<Vec3f> points = sets[i].make();
        const Verdicts verdicts = judge_points(judge, points, defendants, options.thread_count,
                                               share_of(options, i, sets.size(), points.size()));
        result.sets.push_back({sets[i].name, verdicts.scores});
        result.compared_with_cgal += verdicts.compared_with_cgal;
        result.judges_disagree += verdicts.judges_disagree;
    }
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

} // namespace echinus::test
