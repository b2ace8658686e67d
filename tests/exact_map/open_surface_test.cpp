#include "support/random_points.hpp"

#include <echinus/exact_map.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

using namespace echinus;

namespace {

TriangleMesh without_faces(TriangleMesh mesh, std::size_t first, std::size_t count) {
    const auto begin = mesh.faces.begin() + static_cast<std::ptrdiff_t>(first);
    mesh.faces.erase(begin, begin + static_cast<std::ptrdiff_t>(count));
    return mesh;
}

/// The part of a sphere above a height: a bowl.
TriangleMesh bowl(double height) {
    TriangleMesh mesh = make_sphere(1, 24, 12);
    std::erase_if(mesh.faces, [&](const Triangle& face) {
        return double{mesh.vertices[face[0]].z} + mesh.vertices[face[1]].z + mesh.vertices[face[2]].z <
               3 * height;
    });
    return mesh;
}

} // namespace

TEST(ExactMapOfAnOpenSurface, AnswersByTheGeneralisedWindingNumber) {
    test::Random random(3);
    const TriangleMesh meshes[] = {
        without_faces(make_box({2, 1, 1}, 3), 5, 1),
        without_faces(make_torus(1, 0.4, 30, 12), 100, 40),
        bowl(-0.5),
        bowl(0.3),
        without_faces(make_box({1, 1, 1}), 0, 11), // a single triangle
    };
    for (const TriangleMesh& mesh : meshes)
        for (std::uint32_t divisions : {0U, 1U, 12U}) {
            const ExactMap map = ExactMap::build(mesh, {.divisions = divisions});
            ASSERT_FALSE(map.view().border.empty());
            for (int n = 0; n < 3000; ++n) {
                const Vec3f p = test::in_sphere(random, 1.2F * map.view().radius) + map.view().centre;
                const double winding = std::fabs(winding_number(mesh, Vec3d(p)));
                if (std::fabs(winding - 0.5) < 1e-4) continue; // snapping decides
                if (unsigned_distance(mesh, Vec3d(p)) < 1e-5 * map.view().radius) continue;
                const Containment found = classify(map, p);
                ASSERT_EQ(found.inside, winding > 0.5)
                    << "winding number " << winding << ", certain " << found.certain;
                ASSERT_EQ(contains(map, p), found.inside);
                ASSERT_EQ(contact(map, p, 10).certain, found.certain);
            }
        }
}

TEST(ExactMapOfAnOpenSurface, IsNeverWrongAndCertainWhereFacesAreTurned) {
    test::Random random(5);
    for (const TriangleMesh& mesh :
         {make_box({1, 1, 1}), make_box({3, 1, 2}, 3), make_torus(1, 0.4, 20, 12), make_sphere(1, 16, 8)})
        for (const std::size_t every : {2U, 3U, 17U}) {
            TriangleMesh turned = mesh;
            for (std::size_t face = 0; face < mesh.faces.size(); face += every)
                std::swap(turned.faces[face][1], turned.faces[face][2]);
            const ExactMap map = ExactMap::build(turned);
            ASSERT_FALSE(map.view().border.empty());
            int certain_count = 0, uncertain_count = 0;
            for (int n = 0; n < 2000; ++n) {
                const Vec3f p = test::in_sphere(random, 1.2F * map.view().radius) + map.view().centre;
                if (unsigned_distance(mesh, Vec3d(p)) < 1e-5 * map.view().radius) continue;
                const Containment found = classify(map, p);
                ASSERT_EQ(contact(map, p, 10).certain, found.certain);
                (found.certain ? certain_count : uncertain_count)++;
                if (found.certain) {
                    ASSERT_EQ(found.inside, winding_number(mesh, Vec3d(p)) > 0.5);
                }
            }
            EXPECT_GT(certain_count, 500);
            EXPECT_TRUE(uncertain_count > 20 || every == 17);
        }
}

TEST(ExactMapOfAnOpenSurface, AgreesWithTheReportOnWhatIsClosed) {
    test::Random random(7);
    const TriangleMesh torus = make_torus(1, 0.4, 20, 12);
    const double radius = inspect(torus).bounding_sphere.radius;
    for (const double share : {0.0, 1e-12, 0x1p-22, 0x1p-17, 1e-3}) {
        TriangleMesh mesh = torus; // each face with corners of its own
        mesh.vertices.clear();
        for (Triangle& face : mesh.faces)
            for (std::uint32_t& corner : face) {
                const Vec3f apart = test::in_sphere(random, static_cast<float>(share * radius / 2));
                mesh.vertices.push_back(torus.vertices[corner] + apart);
                corner = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
            }
        const bool closed = share < 0x1p-21;
        EXPECT_EQ(inspect(mesh).closed, closed) << share;
        for (const CentreChoice centre : {CentreChoice::BoundingSphere, CentreChoice::Search}) {
            const ExactMap map = ExactMap::build(mesh, {.centre = centre});
            EXPECT_EQ(map.view().border.empty(), closed) << share;
        }
    }
}

TEST(ExactMapOfAnOpenSurface, ReportsTheShareThatNeedNotBeComputed) {
    const ExactMap pierced = ExactMap::build(without_faces(make_torus(1, 0.4, 60, 24), 100, 1));
    EXPECT_LT(pierced.statistics().certain_share, 1);
    EXPECT_GT(pierced.statistics().certain_share, 0.95F);
    EXPECT_GT(pierced.statistics().uncertain_directions, 0);
    EXPECT_LT(pierced.statistics().uncertain_directions, 0.1F);

    test::Random random(4);
    int known = 0;
    constexpr int kCount = 20'000;
    for (int n = 0; n < kCount; ++n)
        known += classify(pierced, test::in_sphere(random, pierced.view().radius)).computed ? 0 : 1;
    EXPECT_NEAR(double{pierced.statistics().certain_share}, known / double{kCount}, 0.01);
}

TEST(ExactMapOfAnOpenSurface, AnswersTheSameWithoutALookForGapsThatAreCertain) {
    test::Random random(5);
    for (const TriangleMesh& mesh : {without_faces(make_torus(1, 0.4, 30, 12), 100, 40), bowl(-0.5)}) {
        const ExactMap with = ExactMap::build(mesh),
                       without = ExactMap::build(mesh, {.find_certain_gaps = false});
        EXPECT_LT(without.statistics().certain_share, 0.01);
        EXPECT_NE(without.source_hash(), with.source_hash());
        for (int n = 0; n < 3000; ++n) {
            const Vec3f p = test::in_sphere(random, 1.2F * with.view().radius) + with.view().centre;
            const Containment found = classify(without, p), expected = classify(with, p);
            ASSERT_EQ(found.inside, expected.inside) << n;
            ASSERT_EQ(found.certain, expected.certain) << n;
            ASSERT_EQ(signed_distance(without, p), signed_distance(with, p)) << n;
        }
    }
}

TEST(ExactMapOfAnOpenSurface, IsCertainEverywhereWhenTheSurfaceIsClosedAfterAll) {
    // Every face has its own vertices, as in STL files: closed by position, though not by index.
    const TriangleMesh box = make_box({2, 1, 1}, 3);
    TriangleMesh soup;
    for (const Triangle& face : box.faces) {
        const auto first = static_cast<std::uint32_t>(soup.vertices.size());
        for (std::uint32_t vertex : face) soup.vertices.push_back(box.vertices[vertex]);
        soup.faces.push_back({first, first + 1, first + 2});
    }
    const ExactMap map = ExactMap::build(soup);
    EXPECT_TRUE(map.view().border.empty());
    EXPECT_EQ(map.statistics().certain_share, 1);
    EXPECT_TRUE(classify(map, {0, 0, 0}).inside);
    EXPECT_TRUE(classify(map, {0, 0, 0}).certain);
}

TEST(ExactMapOfAnOpenSurface, IsRightOnRaysThroughTheBordersVerticesAndAlongItsEdges) {
    // Diagonals and axes of the boxes run through vertices of the border; so do the middles of many cells.
    for (const TriangleMesh& mesh :
         {without_faces(make_box({1, 1, 1}), 0, 1), without_faces(make_box({1, 1, 1}), 1, 2),
          without_faces(make_box({2, 2, 2}, 4), 0, 32)})
        for (std::uint32_t divisions : {0U, 1U, 4U, 5U}) {
            const ExactMap map = ExactMap::build(mesh, {.divisions = divisions});
            for (int x = -9; x <= 9; ++x)
                for (int y = -9; y <= 9; ++y)
                    for (int z = -9; z <= 9; ++z) {
                        const Vec3d p = Vec3d{double(x), double(y), double(z)} * 0.11;
                        const double winding = winding_number(mesh, Vec3d(Vec3f(p)));
                        if (std::fabs(std::fabs(winding) - 0.5) < 1e-4) continue;
                        if (unsigned_distance(mesh, p) < 1e-4) continue;
                        ASSERT_EQ(contains(map, Vec3f(p)), std::fabs(winding) > 0.5)
                            << x << " " << y << " " << z << ", winding number " << winding;
                    }
        }
}

TEST(ExactMapOfAnOpenSurface, LooksBeyondTheBoundingSphereToo) {
    TriangleMesh sheets; // forty squares in one place
    for (std::uint32_t n = 0; n < 40; ++n) {
        for (const Vec3f& v : {Vec3f{-1, -1, 0}, Vec3f{1, -1, 0}, Vec3f{1, 1, 0}, Vec3f{-1, 1, 0}})
            sheets.vertices.push_back(v);
        sheets.faces.push_back({4 * n, 4 * n + 1, 4 * n + 2});
        sheets.faces.push_back({4 * n, 4 * n + 2, 4 * n + 3});
    }
    const ExactMap map = ExactMap::build(sheets);
    for (float z : {-0.3F, -1.2F, -1.5F, -3.0F, -5.0F, -60.0F}) {
        const double winding = winding_number(sheets, {0.01, 0.02, double{z}});
        const Containment found = classify(map, {0.01F, 0.02F, z});
        EXPECT_EQ(found.inside, std::fabs(winding) > 0.5) << z << " " << winding;
        EXPECT_TRUE(found.computed);
        EXPECT_EQ(found.certain, std::fabs(std::fabs(winding - std::floor(winding)) - 0.5) > kCertainMargin);
    }
}
