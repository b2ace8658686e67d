// Properties of every system behind the common interface.

#include "bad_meshes.hpp"
#include "rivals/maps/maps.hpp"
#include "rivals/system.hpp"
#ifdef ECHINUS_HAS_CLASSIFIED_GRID
#include "rivals/classified_grid/classified_grid.hpp"
#endif
#ifdef ECHINUS_HAS_DENSE_GRID
#include "rivals/dense_grid/dense_grid.hpp"
#endif
#ifdef ECHINUS_HAS_SPARSE_FIELD
#include "rivals/sparse_field/sparse_field.hpp"
#endif
#ifdef ECHINUS_HAS_EMBREE_TREE
#include "rivals/embree_tree/embree_tree.hpp"
#endif
#ifdef ECHINUS_HAS_BULLET_MESH
#include "rivals/bullet_mesh/bullet_mesh.hpp"
#endif
#ifdef ECHINUS_HAS_SUPERQUADRIC_MAP
#include "rivals/superquadric_map/superquadric_map.hpp"
#endif
#include "support/random_points.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <memory>
#include <set>
#include <string>
#include <vector>

using namespace echinus;
using rivals::System;

namespace {

struct TestedSystem {
    std::string name;
    double distance_error; ///< of depths and places on the unit sphere, by coarse resolutions
    std::function<std::unique_ptr<const System>(const TriangleMesh&)> build;
    /// False where the first of two faces in one place is a matter of chance.
    bool tells_faces_in_one_place_apart = true;
    /// A particle beyond what the system knows of is not seen from outside.
    bool (*sees)(const Vec3f&) = [](const Vec3f&) { return true; };
};

template <typename Kind>
std::unique_ptr<const System> held(Kind system) {
    return std::make_unique<Kind>(std::move(system));
}

std::vector<TestedSystem> all_systems() {
    using namespace rivals;
    return {
        {"exact", 0.01, [](const TriangleMesh& mesh) { return exact_map(mesh); }},
        {"distance", 0.02, [](const TriangleMesh& mesh) { return distance_map(mesh); }},
        {"octahedral distance", 0.02,
         [](const TriangleMesh& mesh) {
             DistanceMapOptions options;
             options.grid = DirectionGrid::Octahedral;
             return distance_map(mesh, options);
         }},
#ifdef ECHINUS_HAS_CLASSIFIED_GRID
        {"classified", 0.01,
         [](const TriangleMesh& mesh) { return held(ClassifiedGrid::build(mesh, 2'000'000)); }},
#endif
#ifdef ECHINUS_HAS_DENSE_GRID
        {"dense", 0.05, [](const TriangleMesh& mesh) { return held(DenseGrid::with_samples(mesh, 31)); },
         true,
         [](const Vec3f& p) {
             return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= 1;
         }},
#endif
#ifdef ECHINUS_HAS_SPARSE_FIELD
        {"openvdb", 0.05, [](const TriangleMesh& mesh) { return held(SparseField::with_samples(mesh, 21)); }},
#endif
#ifdef ECHINUS_HAS_EMBREE_TREE
        {"embree", 0.01, [](const TriangleMesh& mesh) { return held(EmbreeTree::build(mesh)); }},
#endif
#ifdef ECHINUS_HAS_BULLET_MESH
        {"bullet", 0.01, [](const TriangleMesh& mesh) { return held(BulletMesh::build(mesh, 2)); }, false},
#endif
#ifdef ECHINUS_HAS_SUPERQUADRIC_MAP
        {"superquadric", 0.02,
         [](const TriangleMesh& mesh) {
             SuperquadricMapOptions options;
             options.omega_count = options.eta_count = 100;
             options.decomposition_face_limit = 500; // for the sake of time
             return held(SuperquadricMap::build(mesh, options));
         }},
#endif
    };
}

/// Not so near the sphere that an approximation may take the wrong side, nor so near its centre that the way
/// out is a matter of taste.
std::vector<Vec3f> clear_points() {
    test::Random random(5);
    std::vector<Vec3f> points;
    while (points.size() < 3000) {
        const Vec3f p = test::in_cube(random, 1.5F);
        const float radius = length(p);
        if (radius > 0.3F && std::abs(radius - 1) > 0.05F) points.push_back(p);
    }
    return points;
}

} // namespace

TEST(EverySystem, TellsInsideFromOutsideOfASphere) {
    const TriangleMesh sphere = make_sphere(1, 48, 24);
    const std::vector<Vec3f> points = clear_points();
    for (const TestedSystem& system : all_systems()) {
        const auto built = system.build(sphere);
        std::vector<std::uint8_t> inside(points.size(), 2);
        built->contains_batch(points, inside);
        for (std::size_t i = 0; i < points.size(); ++i)
            ASSERT_EQ(inside[i], length(points[i]) < 1) << system.name << ' ' << i;
    }
}

TEST(EverySystem, PushesOutOfASphereAlongItsRadius) {
    const TriangleMesh sphere = make_sphere(1, 48, 24);
    const std::vector<Vec3f> points = clear_points();
    for (const TestedSystem& system : all_systems()) {
        const auto built = system.build(sphere);
        std::vector<Contact> contacts(points.size());
        built->contacts_batch(points, contacts);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Contact& contact = contacts[i];
            const float radius = length(points[i]);
            ASSERT_EQ(contact.inside, radius < 1) << system.name << ' ' << i;
            if (radius > 1) {
                ASSERT_FALSE(contact.found()) << system.name;
                ASSERT_EQ(contact.depth, 0) << system.name;
                ASSERT_EQ(contact.point, points[i]) << system.name;
                continue;
            }
            ASSERT_NEAR(contact.depth, 1 - radius, system.distance_error) << system.name << ' ' << i;
            ASSERT_NEAR(length(contact.point), 1, system.distance_error) << system.name << ' ' << i;
            ASSERT_GT(dot(contact.normal, points[i]) / radius, 0.98F) << system.name << ' ' << i;
        }
    }
}

TEST(EverySystem, SeesASphereFromOutsideWithinTheMargin) {
    const TriangleMesh sphere = make_sphere(1, 48, 24);
    constexpr float kMargin = 0.12F;
    const std::vector<Vec3f> points = clear_points();
    for (const TestedSystem& system : all_systems()) {
        const auto built = system.build(sphere);
        std::vector<Contact> contacts(points.size()), of_inside(points.size());
        built->contacts_batch(points, kMargin, contacts);
        built->contacts_batch(points, of_inside);
        std::size_t seen = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Contact& contact = contacts[i];
            const float radius = length(points[i]);
            if (radius < 1) { // the margin changes nothing, but for which particles are asked for together
                ASSERT_LT(length(contact.point - of_inside[i].point), 1e-5F) << system.name << ' ' << i;
                ASSERT_LT(length(contact.normal - of_inside[i].normal), 1e-3F) << system.name << ' ' << i;
                ASSERT_NEAR(contact.depth, of_inside[i].depth, 1e-5) << system.name << ' ' << i;
                continue;
            }
            ASSERT_FALSE(contact.inside) << system.name << ' ' << i;
            if (std::abs(radius - 1 - kMargin) < system.distance_error) continue;
            const bool expected = radius < 1 + kMargin && system.sees(points[i]);
            ASSERT_EQ(contact.found(), expected) << system.name << ' ' << i;
            if (!contact.found()) {
                ASSERT_EQ(contact.point, points[i]) << system.name << ' ' << i;
                ASSERT_EQ(contact.depth, 0) << system.name << ' ' << i;
                continue;
            }
            ++seen;
            ASSERT_NEAR(contact.depth, 1 - radius, system.distance_error) << system.name << ' ' << i;
            ASSERT_NEAR(length(contact.point), 1, system.distance_error) << system.name << ' ' << i;
            ASSERT_GT(dot(contact.normal, points[i]) / radius, 0.98F) << system.name << ' ' << i;
        }
        EXPECT_GT(seen, 10U) << system.name;
    }
}

TEST(EverySystem, PutsWhatIsNotFiniteOutside) {
    const TriangleMesh sphere = make_sphere(1, 48, 24);
    std::vector<Vec3f> points;
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                            -std::numeric_limits<float>::infinity()})
        for (const Vec3f& p : {Vec3f{bad, 0, 0}, Vec3f{0, bad, 0}, Vec3f{0, 0, bad}, Vec3f{bad, bad, bad}})
            points.push_back(p);
    for (const TestedSystem& system : all_systems()) {
        const auto built = system.build(sphere);
        std::vector<std::uint8_t> inside(points.size(), 2);
        built->contains_batch(points, inside);
        EXPECT_EQ(inside, std::vector<std::uint8_t>(points.size(), 0)) << system.name;
        std::vector<Contact> contacts(points.size());
        for (const float margin : {0.0F, 1.0F}) {
            built->contacts_batch(points, margin, contacts);
            for (const Contact& contact : contacts) EXPECT_FALSE(contact.found()) << system.name;
        }
    }
}

TEST(EverySystem, AnswersNoParticlesWithNothing) {
    for (const TestedSystem& system : all_systems()) {
        const auto built = system.build(make_box({1, 1, 1}));
        built->contains_batch({}, {});
        built->contacts_batch({}, std::span<Contact>());
    }
}

TEST(EverySystem, HasANameOfItsOwnAndSaysWhatItsBytesAre) {
    std::set<std::string> names;
    for (const TestedSystem& system : all_systems()) {
        const auto built = system.build(make_box({1, 1, 1}));
        EXPECT_EQ(built->name(), system.name);
        EXPECT_TRUE(names.insert(built->name()).second) << system.name;
        EXPECT_FALSE(built->counted().empty()) << system.name;
        EXPECT_GE(built->byte_count(), 100) << system.name;
    }
}

TEST(EverySystem, RefusesBadMeshes) {
    for (const TestedSystem& system : all_systems()) {
        SCOPED_TRACE(system.name);
        test::expect_bad_meshes_are_refused(system.build);
    }
}

TEST(EverySystem, FindsNothingInAFlatMesh) {
    std::vector<Vec3f> points;
    for (int i = 0; i < 20; ++i) {
        const float x = 0.05F * static_cast<float>(i);
        points.insert(points.end(), {{x, 0.2F, 0.01F}, {x, 0.2F, -0.01F}, {0.3F, x, 0.3F}});
    }
    for (const TestedSystem& system : all_systems()) {
        const auto built = system.build(test::flat_mesh());
        if (!system.tells_faces_in_one_place_apart) continue;
        std::vector<std::uint8_t> inside(points.size(), 2);
        built->contains_batch(points, inside);
        EXPECT_EQ(inside, std::vector<std::uint8_t>(points.size(), 0)) << system.name;
    }
}
