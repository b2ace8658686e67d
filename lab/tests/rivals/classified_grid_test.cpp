#include "directions/lattice.hpp"
#include "rivals/classified_grid/classified_grid.hpp"
#include "support/expectations.hpp"
#include "support/instruction_sets.hpp"
#include "support/meshes.hpp"
#include "support/point_sets.hpp"
#include "support/random_points.hpp"

#include <echinus/exact_map.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

using namespace echinus;
using rivals::ClassifiedGrid;
using test::joined;
using test::translated;
using test::turned_inside_out;

namespace {

std::vector<TriangleMesh> closed_meshes() {
    const TriangleMesh sphere = make_sphere(1, 24, 12);
    const TriangleMesh small = make_sphere(0.5, 16, 8);
    const TriangleMesh box = make_box({1, 1, 1}, 2);
    return {
        make_torus(1, 0.4, 30, 12),
        make_box({2, 1, 0.5}, 3),
        joined({sphere, small}),                               // nested
        joined({sphere, turned_inside_out(small)}),            // a cavity
        joined({box, translated(box, {0.5F, 0.25F, 0.125F})}), // overlapping
        joined({box, translated(turned_inside_out(box), {0.5F, 0.25F, 0.125F})}),
        turned_inside_out(sphere),
        joined({box, box}),
        make_box({1, 1e-4, 1e-4}),
        joined({make_box({1, 1, 1}, 2), translated(make_box({1, 1e-7, 1e-7}), {1.5F, 0, 0})}),
    };
}

/// On the surface and beside it by a few lattice steps, at vertices, uniform, and on walls between cells.
std::vector<Vec3f> hard_points(const TriangleMesh& mesh, std::int32_t cell_steps) {
    const LatticeMesh lattice = snap_to_lattice(mesh);
    std::vector<Vec3f> points = test::surface_points(mesh, 2000, 0.01);
    const auto add = [&](const std::vector<Vec3f>& more) {
        points.insert(points.end(), more.begin(), more.end());
    };
    add(test::surface_points(mesh, 2000, 1e-6));
    add(test::uniform_points(mesh, 2000));
    add(mesh.vertices);
    std::int64_t low = kLatticeExtent; // of the grid, as build() has it
    for (const LatticePoint& v : lattice.vertices) low = std::min(low, v.x);
    test::Random random(7);
    std::uniform_int_distribution<std::int64_t> near_wall(-2, 2);
    const std::size_t count = points.size();
    for (std::size_t i = 0; i < count; ++i) {
        LatticePoint p = lattice.snap(points[i]);
        p.x = low - 4 + (p.x - low) / cell_steps * cell_steps + near_wall(random);
        points.push_back(Vec3f(lattice.frame.to_local(Vec3d(p))));
    }
    return points;
}

/// Coarse, middling and fine.
constexpr std::int32_t kCellSizes[] = {1 << 21, 300'001, 77'777, 20'000};

} // namespace

TEST(ClassifiedGrid, GivesTheAnswersOfTheExactMapOnEveryInstructionSet) {
    for (const TriangleMesh& mesh : closed_meshes()) {
        const ExactMap map = ExactMap::build(mesh);
        for (const std::int32_t size : kCellSizes) {
            const ClassifiedGrid grid = ClassifiedGrid::build_with_cells(mesh, size);
            const std::vector<Vec3f> points = hard_points(mesh, grid.cell_steps());
            test::under_each_instruction_set([&](std::string_view name) {
                std::vector<std::uint8_t> inside(points.size(), 2);
                grid.contains_batch(points, inside);
                for (std::size_t i = 0; i < points.size(); ++i)
                    ASSERT_EQ(inside[i], contains(map, points[i]) ? 1 : 0)
                        << name << ", cells of " << size << ", point " << i;
            });
        }
    }
}

TEST(ClassifiedGrid, DecidesPlacesOnTheLatticeOfTheMesh) {
    // Many of these lie on faces, edges and vertices, and so do the centres of cells.
    const TriangleMesh mesh = joined({make_box({2, 2, 2}, 4), translated(make_box({2, 2, 2}, 2), {1, 1, 1})});
    const ExactMap map = ExactMap::build(mesh);
    std::vector<Vec3f> points;
    for (int x = -10; x <= 20; ++x)
        for (int y = -10; y <= 20; ++y)
            for (int z = -10; z <= 20; ++z)
                points.push_back(Vec3f(Vec3d(double(x), double(y), double(z)) * 0.125));
    for (const std::int32_t size : {1 << 21, 65'536, 37'000, 10'000}) {
        const ClassifiedGrid grid = ClassifiedGrid::build_with_cells(mesh, size);
        test::under_each_instruction_set([&](std::string_view name) {
            std::vector<std::uint8_t> inside(points.size(), 2);
            grid.contains_batch(points, inside);
            for (std::size_t i = 0; i < points.size(); ++i)
                ASSERT_EQ(inside[i], contains(map, points[i]) ? 1 : 0) << name << ", point " << i;
        });
    }
}

TEST(ClassifiedGrid, AnswersBatchesOfEveryLengthLikeSingleParticles) {
    const TriangleMesh mesh = make_torus(1, 0.4, 30, 12);
    const ClassifiedGrid grid = ClassifiedGrid::build(mesh, 60'000);
    const std::vector<Vec3f> points = test::surface_points(mesh, 40);
    test::under_each_instruction_set([&](std::string_view name) {
        for (std::size_t first = 0; first < 3; ++first)
            for (std::size_t n = 0; first + n <= points.size(); ++n) {
                std::vector<std::uint8_t> inside(n + 1, 7);
                grid.contains_batch(std::span(points).subspan(first, n), std::span(inside).first(n));
                for (std::size_t i = 0; i < n; ++i)
                    ASSERT_EQ(inside[i], grid.contains(points[first + i])) << name << " " << n;
                ASSERT_EQ(inside[n], 7);
            }
    });
}

TEST(ClassifiedGrid, FindsTheNearestPointOfTheWholeSurface) {
    for (const TriangleMesh& mesh : closed_meshes()) {
        const LatticeMesh lattice = snap_to_lattice(mesh);
        const auto radius = double{lattice.radius};
        std::vector<Vec3f> points = test::surface_points(mesh, 150, 0.05);
        for (const Vec3f& p : test::uniform_points(mesh, 150)) points.push_back(p);
        points.push_back(mesh.vertices[0]);
        points.push_back(lattice.centre);
        points.push_back({9, 8, 7});
        std::vector<double> distances;
        for (const Vec3f& p : points) distances.push_back(unsigned_distance(mesh, Vec3d(p)));
        for (const std::int32_t size : kCellSizes) {
            const ClassifiedGrid grid = ClassifiedGrid::build_with_cells(mesh, size);
            test::under_each_instruction_set([&](std::string_view name) {
                for (const double margin : {0.0, 0.02 * radius, 100 * radius}) {
                    std::vector<Contact> contacts(points.size());
                    grid.contacts_batch(points, static_cast<float>(margin), contacts);
                    for (std::size_t i = 0; i < points.size(); ++i) {
                        const Contact& c = contacts[i];
                        const Vec3d p(points[i]);
                        const double distance = distances[i];
                        const double tolerance = 1e-5 * std::max(radius, length(p));
                        ASSERT_EQ(c.inside, grid.contains(points[i])) << name;
                        if (std::fabs(distance - margin) > tolerance)
                            ASSERT_EQ(c.found(), c.inside || distance < margin) << name << " " << i;
                        if (!c.found()) continue;
                        ASSERT_NEAR(c.depth, c.inside ? distance : -distance, tolerance) << name << " " << i;
                        ASSERT_NEAR(length(Vec3d(c.normal)), 1, 1e-5) << name;
                        ASSERT_NEAR(length(p + Vec3d(c.normal) * double{c.depth} - Vec3d(c.point)), 0,
                                    2 * tolerance)
                            << name << " " << i;
                        ASSERT_LT(c.face, mesh.faces.size());
                        const auto& [a, b, d] = mesh.faces[c.face];
                        const TriangleMesh alone{{mesh.vertices[a], mesh.vertices[b], mesh.vertices[d]},
                                                 {{0, 1, 2}}};
                        ASSERT_NEAR(unsigned_distance(alone, Vec3d(c.point)), 0, tolerance) << name;
                        ASSERT_NEAR(unsigned_distance(alone, p), distance, tolerance) << name;
                    }
                }
            });
        }
    }
}

TEST(ClassifiedGrid, HasANormalOutOfTheSolidOnTheSurface) {
    for (const TriangleMesh& mesh : {make_box({2, 2, 2}), turned_inside_out(make_box({2, 2, 2}))}) {
        const ClassifiedGrid grid = ClassifiedGrid::build(mesh, 20'000);
        const std::vector<Vec3f> points{{0.3F, 0.2F, 1}, {0.3F, 1, 1}, {1, -1, 1}};
        const float half = std::sqrt(0.5F);
        const float third = std::sqrt(1.0F / 3);
        const std::vector<Vec3f> normals{{0, 0, 1}, {0, half, half}, {third, -third, third}};
        test::under_each_instruction_set([&](std::string_view name) {
            std::vector<Contact> contacts(points.size());
            grid.contacts_batch(points, 1e-3F, contacts);
            for (std::size_t i = 0; i < points.size(); ++i)
                EXPECT_NEAR(length(contacts[i].normal - normals[i]), 0, 1e-4F) << name << " " << i;
        });
    }
}

TEST(ClassifiedGrid, TakesNaNAndInfinityAndWhatIsFarAwayForOutside) {
    const ClassifiedGrid grid = ClassifiedGrid::build(make_box({2, 2, 2}), 20'000);
    std::vector<Vec3f> points;
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                            -std::numeric_limits<float>::infinity(), std::numeric_limits<float>::max(), 1e9F})
        for (const Vec3f& p : {Vec3f{bad, 0, 0}, Vec3f{0, bad, 0}, Vec3f{0, 0, bad}, Vec3f{bad, bad, bad}})
            points.push_back(p);
    points.push_back({0, 0, 0});
    test::under_each_instruction_set([&](std::string_view name) {
        std::vector<std::uint8_t> inside(points.size(), 2);
        grid.contains_batch(points, inside);
        std::vector<Contact> contacts(points.size());
        grid.contacts_batch(points, 1, contacts);
        for (std::size_t i = 0; i + 1 < points.size(); ++i) {
            EXPECT_EQ(inside[i], 0) << name << " " << i;
            EXPECT_FALSE(contacts[i].found()) << name << " " << i;
        }
        EXPECT_EQ(inside.back(), 1) << name;
        EXPECT_NEAR(contacts.back().depth, 1, 1e-5F) << name;
    });
}

TEST(ClassifiedGrid, RefusesWhatItCannotDo) {
    const TriangleMesh mesh = make_torus(1, 0.4, 60, 24);
    TriangleMesh open = mesh;
    open.faces.pop_back();
    const auto refuses = [](ErrorCode code, const std::string& words, const auto& call) {
        test::expect_error(code, words, call);
    };
    refuses(ErrorCode::InvalidMesh, "open", [&] { (void)ClassifiedGrid::build(open, 1'000'000); });
    refuses(ErrorCode::InvalidOptions, "budget", [&] { (void)ClassifiedGrid::build(mesh, 20'000); });
    for (const std::int32_t steps : {0, 100})
        refuses(ErrorCode::InvalidOptions, "too many",
                [&] { (void)ClassifiedGrid::build_with_cells(mesh, steps); });
}
