// Energies against differences of themselves, the linear solver against what it solves.

#include "mechanics/elastic_model.hpp"
#include "mechanics/implicit_step.hpp"
#include "mechanics/linear/conjugate_gradients.hpp"
#include "support/random_points.hpp"

#include <echinus/soft_body.hpp>
#include <echinus/tetrahedra.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace echinus::test {
namespace {

constexpr double kDamping = 0.02, kStepSeconds = 1.0 / 60;

Vec3d random_vector(Random& random, double size) {
    const auto part = [&] { return double{uniform(random, -1, 1)} * size; };
    const double x = part(), y = part();
    return {x, y, part()};
}

/// A sheet of count x count particles and a metre, of which every second hinge has an angle at rest.
ElasticParts sheet_parts(std::uint32_t count, bool is_curved, double bending_stiffness = 1e-3) {
    ElasticParts parts;
    parts.masses.assign(std::size_t{count} * count, 0.2 / (count * count));
    for (std::uint32_t row = 0; row < count; ++row)
        for (std::uint32_t column = 0; column < count; ++column)
            parts.rest_places.push_back(Vec3d(column, row, 0) * (1.0 / (count - 1)));
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        ElasticTriangle triangle{};
        triangle.particles = {a, b, c};
        std::array<std::array<double, 2>, 3> corners{};
        for (std::size_t k = 0; k < 3; ++k)
            corners[k] = {parts.rest_places[triangle.particles[k]].x,
                          parts.rest_places[triangle.particles[k]].y};
        EXPECT_GT(set_rest_shape(triangle, corners), 0);
        triangle.warp_stiffness = 1000;
        triangle.weft_stiffness = 700;
        triangle.coupling = 200;
        triangle.shear_stiffness = 300;
        triangle.damping = kDamping;
        parts.triangles.push_back(triangle);
    };
    const auto add_hinge = [&](const std::array<std::uint32_t, 4>& particles) {
        ElasticHinge hinge{};
        hinge.particles = particles;
        hinge.rest_angle = is_curved && parts.hinges.size() % 2 == 0 ? 0.3F : 0.0F;
        hinge.damping = kDamping;
        std::array<Vec3d, 4> rest;
        for (std::size_t k = 0; k < 4; ++k) rest[k] = parts.rest_places[particles[k]];
        set_rest_shape(hinge, rest, bending_stiffness);
        parts.hinges.push_back(hinge);
    };
    for (std::uint32_t row = 0; row + 1 < count; ++row)
        for (std::uint32_t column = 0; column + 1 < count; ++column) {
            const std::uint32_t a = row * count + column;
            add(a, a + 1, a + count + 1);
            add(a, a + count + 1, a + count);
            add_hinge({a, a + count + 1, a + count, a + 1});
        }
    return parts;
}

ElasticParts parts_of(const Deformable& body) {
    ElasticParts parts;
    for (std::size_t i = 0; i < body.particle_count(); ++i) {
        parts.rest_places.emplace_back(body.positions[i]);
        parts.masses.push_back(1 / double{body.inverse_masses[i]});
    }
    parts.tetrahedra = body.tetrahedra;
    return parts;
}

/// Springs and a body of tetrahedra.
ElasticParts body_parts() {
    ElasticParts parts = parts_of(make_soft_body(make_solid_box({0.2, 0.2, 0.2}, {2, 2, 2}),
                                                 {.young_modulus = 1e4, .damping = kDamping}));
    parts.springs = {{0, 5, 0.05F, 300, kDamping}, {3, 9, 0.3F, 200, 0}};
    return parts;
}

/// Two states of a model: where a step begins, and where it is looked at.
struct Trial {
    explicit Trial(const ElasticParts& parts, std::uint32_t seed, double size)
        : model(parts), matrix(model.pattern()) {
        Random random(seed);
        places = parts.rest_places;
        for (Vec3d& place : places) place += random_vector(random, size);
        model.find_entries(matrix);
        model.begin_step(places, kStepSeconds);
        for (Vec3d& place : places) place += random_vector(random, size);
        for (std::size_t i = 0; i < places.size(); ++i) direction.push_back(random_vector(random, 1));
    }
    std::vector<Vec3d> moved(double by) const {
        std::vector<Vec3d> result = places;
        for (std::size_t i = 0; i < result.size(); ++i) result[i] += direction[i] * by;
        return result;
    }
    std::vector<Vec3d> gradient_at(Places at) const {
        std::vector<Vec3d> gradient(at.size());
        model.add_derivatives(at, gradient, nullptr, workers);
        return gradient;
    }
    double slope_of(const std::vector<Vec3d>& gradient) const {
        double sum = 0;
        for (std::size_t i = 0; i < gradient.size(); ++i) sum += dot(gradient[i], direction[i]);
        return sum;
    }

    ElasticModel model;
    BlockMatrix matrix;
    Workers workers;
    std::vector<Vec3d> places, direction;
};

std::vector<ElasticParts> all_parts() {
    return {sheet_parts(5, false), sheet_parts(5, true), body_parts()};
}

TEST(Mechanics, TheGradientIsTheDerivativeOfTheEnergy) {
    for (const ElasticParts& parts : all_parts())
        for (std::uint32_t seed = 1; seed < 8; ++seed) {
            const Trial trial(parts, seed, 0.02);
            constexpr double kDifference = 1e-6;
            const double expected = (trial.model.energy(trial.moved(kDifference), trial.workers) -
                                     trial.model.energy(trial.moved(-kDifference), trial.workers)) /
                                    (2 * kDifference);
            const double slope = trial.slope_of(trial.gradient_at(trial.places));
            EXPECT_NEAR(slope / expected, 1, 1e-5) << seed;
        }
}

TEST(Mechanics, TheForcesOfAPressureAreTheDerivativeOfItsWorkAndBalance) {
    // The boundary of a tetrahedron, far from the origin.
    Pressure pressure({{{0, 2, 1}, 300}, {{0, 1, 3}, 300}, {{1, 2, 3}, 300}, {{2, 0, 3}, 300}}, 4);
    Random random(5);
    std::vector<Vec3d> places{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, direction;
    for (Vec3d& place : places) place += Vec3d{1e4, 0, 0} + random_vector(random, 0.1);
    for (std::size_t i = 0; i < places.size(); ++i) direction.push_back(random_vector(random, 1));
    pressure.begin_step(places);
    const Workers workers;
    const auto energy_at = [&](double by) {
        std::vector<Vec3d> moved = places;
        for (std::size_t i = 0; i < moved.size(); ++i) moved[i] += direction[i] * by;
        return pressure.energy(moved, workers);
    };
    std::vector<Vec3d> gradient(places.size());
    pressure.add_gradient(places, gradient, workers);
    double slope = 0;
    Vec3d force, torque;
    for (std::size_t i = 0; i < places.size(); ++i) {
        slope += dot(gradient[i], direction[i]);
        force += gradient[i];
        torque += cross(places[i] - places[0], gradient[i]);
    }
    EXPECT_NEAR(slope, (energy_at(1e-5) - energy_at(-1e-5)) / 2e-5, 1e-4 * std::abs(slope));
    EXPECT_LT(length(force), 1e-9);
    EXPECT_LT(length(torque), 1e-9);
    const double volume = dot(places[1] - places[0], cross(places[2] - places[0], places[3] - places[0])) / 6;
    EXPECT_NEAR(pressure.energy(places, workers), -300 * volume, 1e-6);
}

TEST(Mechanics, TheGradientWithTheHessianIsTheSame) {
    for (const ElasticParts& parts : all_parts()) {
        Trial trial(parts, 3, 0.02);
        std::vector<Vec3d> gradient(trial.places.size());
        trial.matrix.clear();
        trial.model.add_derivatives(trial.places, gradient, &trial.matrix, trial.workers);
        EXPECT_EQ(gradient, trial.gradient_at(trial.places));
    }
}

TEST(Mechanics, TheHessianIsSymmetricAndLeavesOnlyOutWhatIsNegative) {
    for (const ElasticParts& parts : all_parts())
        for (std::uint32_t seed = 1; seed < 8; ++seed) {
            Trial trial(parts, seed, 0.02);
            std::vector<Vec3d> gradient(trial.places.size());
            trial.matrix.clear();
            trial.model.add_derivatives(trial.places, gradient, &trial.matrix, trial.workers);
            std::vector<Float4> along, across, product(trial.places.size()), other(trial.places.size());
            Random random(seed + 100);
            for (const Vec3d& d : trial.direction) {
                along.emplace_back(d);
                across.emplace_back(random_vector(random, 1));
            }
            trial.matrix.multiply(along, product, trial.workers);
            trial.matrix.multiply(across, other, trial.workers);
            double curvature = 0, one_way = 0, other_way = 0;
            for (std::size_t i = 0; i < along.size(); ++i) {
                curvature += double{dot(along[i], product[i])};
                one_way += double{dot(across[i], product[i])};
                other_way += double{dot(along[i], other[i])};
            }
            EXPECT_NEAR(one_way, other_way, 1e-4 * curvature);
            constexpr double kDifference = 1e-6;
            const double exact = (trial.slope_of(trial.gradient_at(trial.moved(kDifference))) -
                                  trial.slope_of(trial.gradient_at(trial.moved(-kDifference)))) /
                                 (2 * kDifference);
            EXPECT_GT(curvature, 0);
            EXPECT_GE(curvature, exact * (1 - 0.02)) << seed;
        }
}

TEST(Mechanics, AtRestTheHessianIsExact) {
    for (const ElasticParts& parts : {sheet_parts(5, false), body_parts()}) {
        ElasticParts unloaded = parts;
        unloaded.springs.clear();
        Trial trial(unloaded, 1, 0);
        std::vector<Vec3d> gradient(trial.places.size());
        trial.matrix.clear();
        trial.model.add_derivatives(trial.places, gradient, &trial.matrix, trial.workers);
        std::vector<Float4> along, product(trial.places.size());
        for (const Vec3d& d : trial.direction) along.emplace_back(d);
        trial.matrix.multiply(along, product, trial.workers);
        constexpr double kDifference = 1e-6;
        const auto after = trial.gradient_at(trial.moved(kDifference));
        const auto before = trial.gradient_at(trial.moved(-kDifference));
        double error = 0, size = 0;
        for (std::size_t i = 0; i < product.size(); ++i) {
            const Vec3d exact = (after[i] - before[i]) * (0.5 / kDifference);
            error = std::max(error, length(product[i].to_double() - exact));
            size = std::max(size, length(exact));
        }
        EXPECT_LT(error, 1e-3 * size);
    }
}

TEST(Mechanics, ARigidMotionChangesNoEnergy) {
    for (const ElasticParts& parts : all_parts()) {
        ElasticModel model(parts);
        const Workers workers;
        const Rotation turn = Rotation::about({1, 2, 3}, 0.7);
        std::vector<Vec3d> places;
        for (const Vec3d& place : parts.rest_places) places.push_back(turn.apply(place) + Vec3d{1, -2, 3});
        model.begin_step(parts.rest_places, kStepSeconds);
        const double before = model.energy(parts.rest_places, workers);
        EXPECT_NEAR(model.energy(places, workers), before, 1e-6 * (1 + before)); // nor is it damped
        model.begin_step(places, kStepSeconds);
        EXPECT_NEAR(model.energy(places, workers), before, 1e-6 * (1 + before));
    }
}

TEST(Mechanics, CoarseDisplacementsThatAreLinearInThePlaneAreKeptByInterpolation) {
    const ElasticParts parts = sheet_parts(17, false);
    const BlockMatrix pattern = ElasticModel(parts).pattern();
    const Coarsening coarsening = coarsen(pattern.blocks, parts.rest_places);
    EXPECT_LT(coarsening.coarse_count(), pattern.row_count() / 5);
    const auto linear = [](const Vec3d& p) { return 2 + 3 * p.x - p.y; };
    double worst = 0, mean = 0;
    for (std::size_t node = 0; node < pattern.row_count(); ++node) {
        double sum = 0, weights = 0;
        for (std::uint32_t p = coarsening.parents.first[node]; p < coarsening.parents.first[node + 1]; ++p) {
            sum += double{coarsening.parents.values[p]} *
                   linear(coarsening.coarse_places[coarsening.parents.columns[p]]);
            weights += double{coarsening.parents.values[p]};
        }
        EXPECT_NEAR(weights, 1, 0.05) << node; // small ones are left out
        worst = std::max(worst, std::abs(sum - linear(parts.rest_places[node])));
        mean += std::abs(sum - linear(parts.rest_places[node])) / static_cast<double>(pattern.row_count());
    }
    EXPECT_LT(mean, 0.02);
    EXPECT_LT(worst, 0.2);
}

/// The linear system of a step from rest, with any right side.
struct RandomSystem {
    RandomSystem(const ElasticParts& parts, std::uint32_t seed)
        : matrix(ElasticModel(parts).pattern()), multigrid(matrix, parts.rest_places),
          is_held(parts.masses.size()) {
        ElasticModel model(parts);
        model.find_entries(matrix);
        std::vector<Vec3d> gradient(parts.masses.size());
        model.begin_step(parts.rest_places, kStepSeconds);
        model.add_derivatives(parts.rest_places, gradient, &matrix, workers);
        Random random(seed);
        for (std::size_t i = 0; i < parts.masses.size(); ++i) {
            matrix.blocks.values[matrix.diagonal[i]].add_identity(
                static_cast<float>(parts.masses[i] / (kStepSeconds * kStepSeconds)));
            right.emplace_back(random_vector(random, 1));
        }
        multigrid.set(matrix, is_held, workers);
    }
    struct Result {
        std::vector<Float4> solution;
        std::uint32_t iterations;
    };
    Result solve(std::uint32_t most, double tolerance) {
        Result result{std::vector<Float4>(right.size()), 0};
        ConjugateGradients solver;
        result.iterations = solver.solve(matrix, multigrid, right, result.solution, most, tolerance, workers);
        return result;
    }
    /// Largest difference of two solutions, over the largest of one.
    static double difference(std::span<const Float4> a, std::span<const Float4> b) {
        double error = 0, size = 0;
        for (std::size_t i = 0; i < a.size(); ++i) {
            error = std::max(error, length((a[i] - b[i]).to_double()));
            size = std::max(size, length(b[i].to_double()));
        }
        return error / size;
    }

    Workers workers;
    BlockMatrix matrix;
    Multigrid multigrid;
    std::vector<std::uint8_t> is_held;
    std::vector<Float4> right;
};

TEST(Mechanics, MultigridSolvesASheetInAFewIterationsAtEveryResolution) {
    for (const std::uint32_t count : {17U, 33U, 65U}) {
        RandomSystem system(sheet_parts(count, false, 1e-5), count);
        const RandomSystem::Result found = system.solve(100, 1e-3);
        EXPECT_LE(found.iterations, 10u) << count;
        EXPECT_LT(RandomSystem::difference(found.solution, system.solve(1000, 1e-6).solution), 0.01) << count;
    }
}

TEST(Mechanics, MultigridLeadsToTheSolutionOverSeveralSlabs) {
    // 4225 rows of a sheet that is stiff for its weight, and 1845 of a body that is hardly compressible.
    const Deformable body = make_soft_body(make_solid_box({1, 0.1, 0.2}, {40, 4, 8}),
                                           {.young_modulus = 5e6, .poisson_ratio = 0.49});
    for (const ElasticParts& parts : {sheet_parts(65, false), parts_of(body)}) {
        RandomSystem system(parts, 1);
        const RandomSystem::Result found = system.solve(150, 1e-3);
        EXPECT_LT(found.iterations, 150u);
        std::vector<Float4> product(found.solution.size());
        system.matrix.multiply(found.solution, product, system.workers);
        EXPECT_LT(RandomSystem::difference(product, system.right), 0.1);
    }
}

/// How far the centres of mass of two loose sheets end from where they would fall alone, after a step of
/// which each linear system has been solved by a single iteration.
double error_of_fall() {
    ElasticParts parts = sheet_parts(9, true);
    const ElasticParts other = parts;
    const auto count = static_cast<std::uint32_t>(parts.masses.size());
    parts.masses.insert(parts.masses.end(), other.masses.begin(), other.masses.end());
    for (const Vec3d& place : other.rest_places) parts.rest_places.push_back(place + Vec3d{0, 0, 1});
    for (ElasticTriangle triangle : other.triangles) {
        for (std::uint32_t& particle : triangle.particles) particle += count;
        parts.triangles.push_back(triangle);
    }
    ImplicitStep step(parts);
    Motion motion(2 * count);
    Random random(3);
    for (std::size_t i = 0; i < 2 * count; ++i) {
        motion.places[i] = parts.rest_places[i];
        motion.velocities[i] = random_vector(random, 1);
    }
    const Vec3d fall{0, 0, -9.81};
    const std::vector<Vec3d> accelerations(2 * count, fall);
    const std::vector<std::uint8_t> is_held(2 * count);
    step.begin(motion, accelerations, is_held, kStepSeconds);
    std::vector<Vec3d> places = motion.places;
    step.solve(places, nullptr, {.newton_steps = 2, .linear_iterations = 1}, Workers(1));
    double most = 0;
    for (std::size_t body = 0; body < 2; ++body) {
        Vec3d off;
        for (std::size_t i = body * count; i < (body + 1) * count; ++i)
            off += places[i] - motion.places[i] - (motion.velocities[i] + fall * kStepSeconds) * kStepSeconds;
        most = std::max(most, length(off) / count);
    }
    return most;
}

TEST(Mechanics, ASystemThatIsHardlySolvedKeepsTheMomentumOfEachBody) {
    EXPECT_LT(error_of_fall(), 1e-8);
}

TEST(Mechanics, CholeskySolvesAndPassesOverWhatIsSingular) {
    Cholesky<double> factor;
    factor.factorise(2, std::array{4.0, 0.0, 2.0, 3.0});
    std::array<double, 2> x{10, 8};
    factor.solve(x);
    EXPECT_NEAR(x[0], 1.75, 1e-12);
    EXPECT_NEAR(x[1], 1.5, 1e-12);
    factor.factorise(2, std::array{1.0, 0.0, 1.0, 1.0}); // of rank 1
    x = {1, 1};
    factor.solve(x);
    EXPECT_TRUE(std::isfinite(x[0]) && std::isfinite(x[1]));
}

} // namespace
} // namespace echinus::test
