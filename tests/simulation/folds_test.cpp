// Folds: constraints that hold the angle between two faces.

#include "simulation/folds.hpp"
#include "support/cloth_meshes.hpp"
#include "support/instruction_sets.hpp"
#include "support/random_points.hpp"

#include <echinus/simulation.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

using namespace echinus;

namespace {

constexpr double kPi64 = std::numbers::pi;

/// Two faces with the common edge from the origin to (1, 0, 0), as high as is said, the second turned up by
/// the angle towards the front of the first.
Deformable pair_of_faces(double angle_rad, double rest_angle_rad, double height_c = 1, double height_d = 1) {
    Deformable pair;
    const double y = -height_d * std::cos(angle_rad), z = height_d * std::sin(angle_rad);
    pair.positions = {{0, 0, 0},
                      {1, 0, 0},
                      {0.3F, float(height_c), 0},
                      {0.6F, static_cast<float>(y), static_cast<float>(z)}};
    pair.previous_positions = pair.positions;
    pair.inverse_masses = {1, 1, 1, 1};
    pair.faces = {{0, 1, 2}, {1, 0, 3}};
    pair.folds = {
        {0, 1, 2, 3, static_cast<float>(rest_angle_rad), static_cast<float>((height_c + height_d) / 2)}};
    return pair;
}

float angle_of_pair(std::span<const Vec3f> p) {
    return fold_angle(p[0], p[1], p[2], p[3]);
}

Deformable rumpled_cloth(std::uint32_t columns, std::uint32_t rows, float size = 0.1F) {
    const TriangleMesh flat = test::sheet_mesh(columns, rows);
    return make_cloth(test::rumpled(flat, size), {.rest_vertices = flat.vertices});
}

/// Positions after as many relaxations of the folds alone.
std::vector<Vec3f> relaxed(const Deformable& cloth, const SimulationOptions& options, int count) {
    FoldArrays folds = weighted_folds(cloth, options);
    PointArrays positions, remainders;
    positions.load(cloth.positions);
    remainders.resize(cloth.particle_count());
    const bool keeps_remainders = options.solver == SolverKind::Xpbd;
    for (int i = 0; i < count; ++i) relax(folds, positions, keeps_remainders ? &remainders : nullptr);
    std::vector<Vec3f> result(cloth.particle_count());
    positions.store(result);
    return result;
}

/// Sums over all particles.
struct Momentum {
    Vec3d linear, angular;
};

/// Of the motion from where the cloth is to these positions, about the origin.
Momentum momentum_of(const Deformable& cloth, const std::vector<Vec3f>& moved) {
    Momentum sum;
    for (std::size_t i = 0; i < moved.size(); ++i) {
        const Vec3d from(cloth.positions[i]);
        const Vec3d share = (Vec3d(moved[i]) - from) * (1 / double{cloth.inverse_masses[i]});
        sum.linear += share;
        sum.angular += cross(from, share);
    }
    return sum;
}

} // namespace

TEST(FoldAngle, IsThatByWhichTheSecondFaceIsTurnedTowardsTheFrontOfTheFirst) {
    for (int degrees = -179; degrees <= 179; ++degrees) {
        const double angle_rad = degrees * kPi64 / 180;
        EXPECT_NEAR(angle_of_pair(pair_of_faces(angle_rad, 0, 0.7, 1.3).positions), angle_rad, 1e-6);
    }
    EXPECT_EQ(angle_of_pair(pair_of_faces(0, 0).positions), 0);
    EXPECT_NEAR(std::fabs(angle_of_pair(pair_of_faces(kPi64, 0).positions)), kPi64, 1e-6);
}

TEST(FoldAngle, IsTheSameFromEitherFaceAndForEitherEndOfTheEdge) {
    test::Random random(1);
    for (int i = 0; i < 100; ++i) {
        const Vec3f a = test::in_cube(random, 1), b = test::in_cube(random, 1), c = test::in_cube(random, 1),
                    d = test::in_cube(random, 1);
        EXPECT_NEAR(fold_angle(a, b, c, d), fold_angle(b, a, d, c), 1e-5);
        EXPECT_NEAR(fold_angle(a, b, c, d), -fold_angle(b, a, c, d), 1e-5); // both faces turned round
    }
}

TEST(FoldAngle, IsZeroWhereAFaceHasNoArea) {
    EXPECT_EQ(fold_angle({0, 0, 0}, {1, 0, 0}, {0.5F, 0, 0}, {0, 1, 1}), 0);
    EXPECT_EQ(fold_angle({0, 0, 0}, {0, 0, 0}, {0.5F, 0, 0}, {0, 1, 1}), 0);
}

TEST(Fold, ReturnsToItsRestAngleFromAnyOther) {
    for (const double rest : {0.0, 0.5, -2.0, 3.0})
        for (int degrees = -180; degrees <= 180; degrees += 15) {
            const Deformable pair = pair_of_faces(degrees * kPi64 / 180, rest, 0.8, 1.1);
            const std::vector<Vec3f> end = relaxed(pair, {.stiffness = {1, 1, 1}}, 60);
            EXPECT_NEAR(angle_of_pair(end), rest, 1e-4) << "from " << degrees << " degrees";
        }
}

TEST(Fold, TurnsBackThroughTheFlatStateAndNeverThroughItself) {
    const Deformable pair = pair_of_faces(-3, 2);
    float before = -3;
    for (int count = 1; count < 20; ++count) {
        const float angle = angle_of_pair(relaxed(pair, {.stiffness = {1, 1, 1}}, count));
        EXPECT_GE(angle, before - 1e-4F);
        EXPECT_LE(angle, 2.3F); // an overshoot of the curved way that is taken straight
        before = std::min(angle, 2.0F);
    }
}

TEST(Fold, OfStiffnessBelowOneRemovesThatShareOfASmallError) {
    const std::vector<Vec3f> end = relaxed(pair_of_faces(0.01, 0), {.stiffness = {1, 1, 0.3}}, 1);
    EXPECT_NEAR(angle_of_pair(end), 0.007, 1e-5);
}

TEST(Fold, ThatIsFlatStaysToTheBit) {
    for (const double height : {0.5, 1.0, 0.01}) {
        const Deformable pair = pair_of_faces(0, 0, height, 1);
        EXPECT_EQ(relaxed(pair, {}, 10), pair.positions);
    }
}

TEST(Fold, LeavesFacesWithoutAreaAlone) {
    Deformable pair = pair_of_faces(1, 0);
    pair.positions[2] = {0.5F, 0, 0};
    EXPECT_EQ(relaxed(pair, {}, 3), pair.positions);
    pair.positions[2] = pair.positions[0];
    EXPECT_EQ(relaxed(pair, {}, 3), pair.positions);
    pair.positions[1] = pair.positions[0];
    EXPECT_EQ(relaxed(pair, {}, 3), pair.positions);
}

TEST(Fold, MovesNoParticleFarHoweverThinItsFacesAre) {
    test::Random random(7);
    for (int i = 0; i < 2000; ++i) {
        Deformable pair = pair_of_faces(0, 0);
        for (Vec3f& p : pair.positions) p = test::in_cube(random, 1);
        const float thin = std::pow(10.0F, -test::uniform(random, 0, 30));
        pair.positions[2] = pair.positions[0] + (pair.positions[1] - pair.positions[0]) * 0.4F +
                            (pair.positions[2] - pair.positions[0]) * thin;
        const std::vector<Vec3f> end = relaxed(pair, {.stiffness = {1, 1, 1}}, 1);
        for (std::size_t k = 0; k < 4; ++k) EXPECT_LT(length(end[k] - pair.positions[k]), 2) << thin;
    }
}

TEST(Fold, LeavesAnEndWhoseOtherParticlesArePinnedOnOneLineWhereItIs) {
    // Whatever the end of the edge does, both faces lie in one plane: the angle tells it nothing.
    test::Random random(7);
    for (const bool is_spring : {false, true})
        for (int trial = 0; trial < 200; ++trial) {
            const Vec3f along = test::in_cube(random, 0.1F),
                        at = test::in_cube(random, trial % 2 == 0 ? 0 : 50);
            Vec3f across = test::in_cube(random, 0.1F);
            // Upright over the line, as in a grid, or not.
            if (trial % 3 == 0) across += along * (-dot(across, along) / dot(along, along));
            Deformable fan;
            fan.positions = {at + across, at, at - along, at + along};
            fan.previous_positions = fan.positions;
            fan.inverse_masses = {1, 0, 0, 0};
            fan.faces = {{0, 1, 2}, {1, 0, 3}};
            const float height = length(cross(across, along)) / length(across);
            if (!(height > 0.01F)) continue;
            fan.folds = {{0, 1, 2, 3, 0, height}};
            const SimulationOptions options{.solver = is_spring ? SolverKind::Xpbd : SolverKind::Verlet};
            const Vec3f end = relaxed(fan, options, 20)[0];
            EXPECT_LT(length(end - fan.positions[0]), 0.001F) << trial;
        }
}

TEST(Folds, OfACurtainThatHangsByItsEdgeLeaveItAtRest) {
    // Every second pinned vertex has a free one below it that is joined to three pinned ones in a line.
    constexpr std::uint32_t kCount = 11;
    TriangleMesh mesh = test::sheet_mesh(kCount, kCount);
    mesh.faces.clear();
    for (std::uint32_t row = 0; row + 1 < kCount; ++row)
        for (std::uint32_t column = 0; column + 1 < kCount; ++column) {
            const std::uint32_t a = row * kCount + column, b = a + 1, c = b + kCount, d = a + kCount;
            if ((row + column) % 2 == 0)
                mesh.faces.insert(mesh.faces.end(), {{a, b, c}, {a, c, d}});
            else
                mesh.faces.insert(mesh.faces.end(), {{a, b, d}, {b, c, d}});
        }
    for (Vec3f& v : mesh.vertices) v = {0.8F * v.x, 0.6F * v.x, -v.y}; // upright, and flat but for rounding
    for (const bool is_spring : {false, true}) {
        Deformable curtain = make_cloth(mesh, {});
        for (std::uint32_t column = 0; column < kCount; ++column) curtain.inverse_masses[column] = 0;
        SimulationOptions options;
        if (is_spring) options = {.solver = SolverKind::Xpbd, .iteration_count = 1, .substep_count = 10};
        Simulation simulation(curtain, {}, options);
        for (int frame = 0; frame < 60; ++frame) simulation.step();
        for (std::size_t i = 0; i < curtain.positions.size(); ++i)
            EXPECT_LT(length(simulation.positions()[i] - curtain.positions[i]), 0.05F) << i;
    }
}

TEST(Folds, ConserveLinearAndAngularMomentum) {
    Deformable cloth = rumpled_cloth(12, 9);
    for (std::size_t i = 0; i < cloth.particle_count(); ++i)
        cloth.inverse_masses[i] = 1 / static_cast<float>(1 + i % 5);
    for (const SimulationOptions& options :
         {SimulationOptions{}, SimulationOptions{.solver = SolverKind::Xpbd, .compliance = {0, 0, 1e-5}}}) {
        const std::vector<Vec3f> moved = relaxed(cloth, options, 1);
        double way = 0;
        for (std::size_t i = 0; i < moved.size(); ++i) way += length(moved[i] - cloth.positions[i]);
        EXPECT_GT(way, 0.1);
        const Momentum momentum = momentum_of(cloth, moved);
        EXPECT_LT(length(momentum.linear), 1e-5 * way);
        // To first order only, for one fold; the next ones start from where it has moved the particles.
        const std::vector<Vec3f> one = [&] {
            Deformable single = cloth;
            single.folds.resize(1);
            return relaxed(single, options, 1);
        }();
        double way_of_one = 0;
        for (std::size_t i = 0; i < one.size(); ++i) way_of_one += length(one[i] - cloth.positions[i]);
        EXPECT_GT(way_of_one, 1e-3);
        EXPECT_LT(length(momentum_of(cloth, one).angular), 1e-5 * way_of_one);
    }
}

TEST(Folds, AsSpringsGiveWayToATorqueByTheirComplianceWhateverTheNumberOfSteps) {
    constexpr double kGravity = 10, kCompliance = 1e-3, kHeight = 0.5;
    for (const std::uint32_t substeps : {4U, 16U}) {
        Deformable flap = pair_of_faces(0, 0, 1.5, kHeight);
        flap.inverse_masses = {0, 0, 0, 1};
        for (const std::uint32_t end : {0U, 1U}) // so that the corner stays at its height over the edge
            flap.sticks.push_back(
                {end, 3, length(flap.positions[3] - flap.positions[end]), StickKind::Structural});
        Simulation simulation(flap, {},
                              {.solver = SolverKind::Xpbd,
                               .iteration_count = 2,
                               .substep_count = substeps,
                               .gravity = {0, 0, -kGravity},
                               .drag = 0.05,
                               .compliance = {0, 0, kCompliance}});
        for (int i = 0; i < 2000; ++i) simulation.step();
        // The torque of the weight over the lever's square is the error over the compliance.
        const double lever = (1.5 + kHeight) / 2;
        const double expected = -kGravity * kHeight * kCompliance / (lever * lever);
        EXPECT_NEAR(angle_of_pair(simulation.positions()), expected, 0.02 * std::fabs(expected));
    }
}

TEST(Folds, RelaxToTheSameBitsUnderEachInstructionSet) {
    for (const SimulationOptions& options :
         {SimulationOptions{}, SimulationOptions{.solver = SolverKind::Xpbd, .compliance = {0, 0, 1e-5}}})
        for (std::uint32_t columns = 2; columns < 40; columns += 3) {
            Deformable cloth = rumpled_cloth(columns, 7, 0.2F);
            cloth.inverse_masses[1] = 0;
            std::vector<std::vector<Vec3f>> results;
            test::under_each_instruction_set(
                [&](std::string_view) { results.push_back(relaxed(cloth, options, 3)); });
            for (const auto& result : results) EXPECT_EQ(result, results.front());
            EXPECT_NE(results.front(), cloth.positions);
        }
}

TEST(Folds, OfAMeshStandInLongRunsWithoutACommonParticle) {
    const Deformable cloth = rumpled_cloth(60, 60);
    const FoldArrays folds = weighted_folds(cloth, {});
    std::size_t next = 0;
    for (const ConstraintRun& run : folds.schedule.runs) {
        EXPECT_EQ(run.first, next);
        next += run.count;
        std::set<std::uint32_t> particles;
        for (std::size_t i = run.first; i < next; ++i)
            for (const std::uint32_t particle : {folds.a[i], folds.b[i], folds.c[i], folds.d[i]})
                EXPECT_TRUE(particles.insert(particle).second);
    }
    EXPECT_EQ(next, folds.count());
    EXPECT_LT(folds.schedule.runs.size(), folds.count() / 12); // packs have 16
}
