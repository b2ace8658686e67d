// A classified grid is right about every particle, by CGAL's exact predicates.

#include "directions/lattice.hpp"
#include "judges/exact_judge.hpp"
#include "judges/nasty_meshes.hpp"
#include "rivals/classified_grid/classified_grid.hpp"
#include "support/point_sets.hpp"

#include <gtest/gtest.h>

using namespace echinus;

TEST(ClassifiedGridOracle, IsRightAboutSignsAndDepths) {
    for (const auto& [name, mesh] : test::generated_meshes()) {
        const test::ExactJudge judge(mesh);
        const LatticeMesh lattice = snap_to_lattice(mesh);
        std::vector<Vec3f> points = test::surface_points(mesh, 3000, 0.01);
        for (const Vec3f& p : test::uniform_points(mesh, 3000)) points.push_back(p);
        for (const Vec3f& p : test::surface_points(mesh, 3000, 1e-5)) points.push_back(p);
        for (const std::size_t budget : {100'000U, 400'000U}) {
            const auto grid = rivals::ClassifiedGrid::build(mesh, budget);
            std::vector<std::uint8_t> inside(points.size());
            grid.contains_batch(points, inside);
            std::vector<Contact> contacts(points.size());
            grid.contacts_batch(points, 3 * lattice.radius, contacts);
            const double tolerance = 4 * lattice.frame.step; // snapping may change sides and depths by this
                                                             // much
            for (std::size_t i = 0; i < points.size(); ++i) {
                const double distance = judge.distance(Vec3d(points[i]));
                if (distance > tolerance)
                    ASSERT_EQ(inside[i] != 0, judge.inside(points[i])) << name << " " << i;
                ASSERT_NEAR(contacts[i].depth, inside[i] ? distance : -distance, tolerance)
                    << name << " " << i;
            }
        }
    }
}
