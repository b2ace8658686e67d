#include "judges/check_mesh.hpp"

#include "support/point_sets.hpp"

#include <echinus/error.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <utility>

namespace echinus::test {

namespace {

/// The low ten bits of a number, with two zeros between each and the next.
std::uint32_t spread_bits(std::uint32_t bits) {
    bits = (bits | bits << 16U) & 0x030000FFU;
    bits = (bits | bits << 8U) & 0x0300F00FU;
    bits = (bits | bits << 4U) & 0x030C30C3U;
    return (bits | bits << 2U) & 0x09249249U;
}

/// In Morton order, so that neighbours are judged in succession and find their data in the cache, which
/// halves the total time. No answer depends on the order.
void sort_along_curve(std::vector<Vec3f>& points, const MapFrame& frame) {
    const auto cell_of = [&](float coordinate, float centre) {
        const float share = (coordinate - centre) / frame.radius * 0.25F + 0.5F;
        return spread_bits(static_cast<std::uint32_t>(std::clamp(share, 0.0F, 1.0F) * 1023));
    };
    const auto place_on_curve = [&](const Vec3f& p) {
        return cell_of(p.x, frame.centre.x) | cell_of(p.y, frame.centre.y) << 1U |
               cell_of(p.z, frame.centre.z) << 2U;
    };
    std::vector<std::pair<std::uint32_t, std::uint32_t>> order;
    order.reserve(points.size());
    for (std::uint32_t i = 0; i < points.size(); ++i) order.emplace_back(place_on_curve(points[i]), i);
    std::ranges::sort(order);
    std::vector<Vec3f> sorted;
    sorted.reserve(points.size());
    for (const auto& [place, i] : order) sorted.push_back(points[i]);
    points = std::move(sorted);
}

/// Sheets draped over the mesh from three sides.
std::vector<Vec3f> sheets(const TriangleMesh& mesh, std::size_t side) {
    std::vector<Vec3f> points;
    for (const test::Axis up : {test::Axis::X, test::Axis::Y, test::Axis::Z}) {
        const std::vector<Vec3f> sheet = test::cloth_points(mesh, side, side, up);
        points.insert(points.end(), sheet.begin(), sheet.end());
    }
    return points;
}

} // namespace

std::vector<PointSet> point_sets(const TriangleMesh& mesh, const MapFrame& frame, std::size_t count,
                                 std::uint64_t seed) {
    const std::size_t quarter = count / 4;
    const auto side = static_cast<std::size_t>(std::sqrt(static_cast<double>(quarter) / 3));
    const std::size_t rest = count - 2 * quarter - 3 * side * side;
    std::vector<PointSet> sets{
        {"uniform", [=, &mesh] { return test::uniform_points(mesh, quarter, seed); }},
        {"surface", [=, &mesh] { return test::surface_points(mesh, quarter, 0.01, seed + 1); }},
        {"cloth", [=, &mesh] { return sheets(mesh, side); }},
        {"adversarial", [=, &mesh] { return adversarial_points(mesh, frame, rest, seed + 2); }},
    };
    for (PointSet& set : sets)
        set.make = [=, make = set.make] {
            std::vector<Vec3f> points = make();
            sort_along_curve(points, frame);
            return points;
        };
    return sets;
}

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

namespace {

constexpr double kCertainShareLimit = 0.9;

} // namespace

const char* name_of(InsideRule rule) {
    return rule == InsideRule::Nonzero ? "nonzero" : "parity";
}

Score CheckResult::total(std::size_t rule) const {
    Score total;
    for (const SetResult& set : sets) total.merge(set.scores[rule]);
    return total;
}

double CheckResult::certain_share() const {
    if (closed) return 1;
    const Score& uniform = sets.front().scores.front();
    return static_cast<double>(uniform.certain) /
           static_cast<double>(std::max<std::size_t>(1, uniform.points));
}

bool CheckResult::right() const {
    for (std::size_t rule = 0; rule < rules.size(); ++rule)
        if (!total(rule).right(closed)) return false;
    return wrong_corners == 0 && judges_disagree == 0;
}

bool CheckResult::holds() const {
    return right() && certain_share() >= kCertainShareLimit;
}

} // namespace echinus::test
