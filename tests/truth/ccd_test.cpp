// Continuous collision detection judged by others: public queries whose answers were computed by exact
// arithmetic (Wang et al. 2021, github.com/Continuous-Collision-Detection/Sample-Queries). The unit tests are
// in this repository, the scenes of Erleben beside it.

#include "simulation/contact/contact_side.hpp"
#include "simulation/contact/safe_displacements.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

using namespace echinus;
namespace fs = std::filesystem;

namespace {

using Points = std::array<Vec3f, 4>;

/// A vertex and a face, or two edges, that go straight from one place to another.
struct Query {
    Points from, to;
    bool collides = false;
};

/// Eight lines each: three rationals as numerator and denominator, and the answer. Edges and a vertex with
/// its face are both given as four points.
std::vector<Query> read_queries(const fs::path& file) {
    std::ifstream in(file);
    std::vector<Query> queries;
    std::string line;
    for (std::size_t row = 0; std::getline(in, line); ++row) {
        std::replace(line.begin(), line.end(), ',', ' ');
        std::istringstream fields(line);
        std::array<double, 6> rational{};
        for (double& number : rational) fields >> number;
        bool collides = false;
        EXPECT_TRUE(fields >> collides) << file << " line " << row + 1;
        if (row % 8 == 0) queries.emplace_back();
        Query& query = queries.back();
        (row % 8 < 4 ? query.from : query.to)[row % 4] =
            Vec3f(Vec3d{rational[0] / rational[1], rational[2] / rational[3], rational[4] / rational[5]});
        query.collides = collides;
    }
    EXPECT_FALSE(queries.empty()) << file;
    return queries;
}

/// How a step deals with a query.
enum class Outcome : std::uint8_t {
    Goes,    ///< both parts reach their goals
    Stopped, ///< they are stopped, or pushed aside
    Refused, ///< they touch where they begin: no simulation starts there, unless it untangles them
};

Outcome answer(PairKind kind, const Query& query) {
    const std::vector<Triangle> faces{{1, 2, 3}};
    const std::vector<Edge> edges{{0, 1}, {2, 3}};
    const bool is_face = kind == PairKind::VertexFace;
    const auto elements = std::make_shared<const Elements>(
        4, is_face ? std::span<const Triangle>(faces) : std::span<const Triangle>{},
        is_face ? std::span<const Edge>{} : std::span<const Edge>(edges));
    PointArrays from;
    from.load(query.from);
    std::vector<ContactSide> sides;
    ContactSide& side = sides.emplace_back(elements, from);
    side.thickness = 1; // so that a sixteenth of each gap remains, the most that any thickness leaves
    side.extent = largest_coordinate(from, 4);
    side.least_gap = side.extent * threshold::kLeastGap;
    side.pairs.set_reach(1);
    side.set_safe(from);
    const std::vector<Vec3d> goals(query.to.begin(), query.to.end());
    const Workers workers;
    side.list(goals, workers);
    side.measure_towards(goals, workers);
    const std::vector<std::uint8_t> is_held(4, 0);
    SafeDisplacements displacements(sides, goals, {is_held, false, {}, 1}, workers);
    const Places ends = displacements.find();
    if (displacements.unresolved_count() > 0) return Outcome::Refused;
    return std::equal(ends.begin(), ends.end(), goals.begin()) ? Outcome::Goes : Outcome::Stopped;
}

/// The distance of the parts at a time from 0 to 1.
double distance_at(PairKind kind, const Query& query, double time) {
    std::array<Vec3d, 4> points;
    for (std::size_t k = 0; k < 4; ++k)
        points[k] = Vec3d(query.from[k]) + (Vec3d(query.to[k]) - Vec3d(query.from[k])) * time;
    const std::array<double, 4> weights = nearest_points(kind, points);
    Vec3d between;
    for (std::size_t k = 0; k < 4; ++k)
        between += points[k] * (k < own_count(kind) ? weights[k] : -weights[k]);
    return length(between);
}

/// Whether a step that keeps a sixteenth of the first distance, and more than rounding, has to stop the parts
/// on the way. The distance changes no faster than both parts move, so a time span in which it stays above
/// that need not be divided.
bool comes_too_near(PairKind kind, const Query& query) {
    double extent = 0, fastest = 0;
    for (std::size_t k = 0; k < 4; ++k) {
        const Vec3f& p = query.from[k];
        extent = std::max({extent, std::abs(double{p.x}), std::abs(double{p.y}), std::abs(double{p.z})});
        fastest = std::max(fastest, length(Vec3d(query.to[k]) - Vec3d(p)));
    }
    const double kept =
        std::max(distance_at(kind, query, 0) * threshold::kLeastOfGap, extent * threshold::kLeastGap);
    std::vector<std::array<double, 2>> spans{{0, 1}};
    while (!spans.empty()) {
        const auto [begin, end] = spans.back();
        spans.pop_back();
        const double middle = (begin + end) / 2, distance = distance_at(kind, query, middle);
        if (distance < kept) return true;
        if (distance - 2 * fastest * (middle - begin) > kept || !(begin < middle && middle < end)) continue;
        spans.push_back({begin, middle});
        spans.push_back({middle, end});
    }
    return false;
}

/// How many queries there are, how many of them collide, and how many of these are not stopped; and of those
/// that are free, how many are stopped although they need not be.
struct Counts {
    int all = 0, collide = 0, missed = 0, refused = 0, too_near = 0, stopped = 0;
    int free() const { return all - collide - too_near; }
};

/// Of the queries of one kind in a set, which are printed.
Counts count_answers(const fs::path& set, const char* folder, PairKind kind) {
    Counts counts;
    for (const fs::directory_entry& file : fs::directory_iterator(set / folder))
        for (const Query& query : read_queries(file.path())) {
            const Outcome outcome = answer(kind, query);
            ++counts.all;
            if (outcome == Outcome::Refused) ++counts.refused;
            if (query.collides) {
                ++counts.collide;
                if (outcome == Outcome::Goes) ++counts.missed;
            } else if (comes_too_near(kind, query)) {
                ++counts.too_near;
            } else if (outcome == Outcome::Stopped) {
                ++counts.stopped;
            }
        }
    std::printf("| %s | %s | %d | %d | %d | %d | %d | %d | %.1f %% |\n", set.filename().string().c_str(),
                folder, counts.all, counts.refused, counts.collide, counts.missed, counts.too_near,
                counts.stopped, 100.0 * counts.stopped / counts.free());
    return counts;
}

/// How much of the queries that need not be stopped may be stopped.
constexpr double kMostStopped = 0.05;

void expect_answers(const fs::path& set) {
    for (const bool is_face : {true, false}) {
        const char* const folder = is_face ? "vertex-face" : "edge-edge";
        const Counts counts = count_answers(set, folder, is_face ? PairKind::VertexFace : PairKind::EdgeEdge);
        EXPECT_EQ(counts.missed, 0) << set / folder;
        EXPECT_LE(counts.stopped, kMostStopped * counts.free()) << set / folder;
    }
}

/// In the order of their names.
std::vector<fs::path> sets_in(const fs::path& folder) {
    std::vector<fs::path> sets;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
        if (entry.is_directory()) sets.push_back(entry.path());
    std::sort(sets.begin(), sets.end());
    return sets;
}

} // namespace

TEST(PublicCollisionQueries, AreStoppedIfTheyCollideAndSeldomElse) {
    for (const fs::path& set : sets_in(fs::path(ECHINUS_TRUTH) / "ccd")) expect_answers(set);
}

TEST(PublicCollisionQueries, AreStoppedIfTheyCollideAndSeldomElseInAllScenes) {
    const fs::path folder = fs::path(ECHINUS_SHARED) / "truth/ccd";
    if (!fs::exists(folder)) GTEST_SKIP() << "the queries are not at " << folder;
    for (const fs::path& set : sets_in(folder)) expect_answers(set);
}
