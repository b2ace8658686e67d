#include "support/meshes.hpp"
#include "support/random_points.hpp"

#include <echinus/collider.hpp>
#include <echinus/distance_map.hpp>
#include <echinus/exact_map.hpp>
#include <echinus/tetrahedra.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>

using namespace echinus;
using namespace echinus::test;

namespace {

/// A mesh far away, and what is asked of it. Brute force judges: by double at the origin.
struct FarMesh {
    TriangleMesh near, far;
    Vec3d offset;
    double radius, tolerance; ///< 3.8e-6 R, and what doubles round so far away

    FarMesh(const TriangleMesh& mesh, const Vec3d& place)
        : near(mesh), far(local_mesh(positions_at(mesh, place), mesh.faces)), offset(place),
          radius(inspect(mesh).bounding_sphere.radius),
          tolerance(3.8e-6 * radius + 4 * 0x1p-53 * length(place)) {}

    Vec3d random_point(Random& random) const { return Vec3d(in_cube(random, 1.2F)) + offset; }
    Vec3f local(const Vec3d& point) const { return to_local(point, far.origin); }
    double distance(const Vec3d& point) const { return unsigned_distance(near, point - offset); }
    bool is_inside(const Vec3d& point) const { return winding_number(near, point - offset) > 0.5; }
};

std::vector<FarMesh> far_meshes() {
    std::vector<FarMesh> meshes;
    for (const TriangleMesh& mesh : shapes_far_away())
        for (const Vec3d& place : places_far_away()) meshes.emplace_back(mesh, place);
    return meshes;
}

} // namespace

TEST(FarAway, ExactMapsGiveSidesAndDistancesAsAtTheOrigin) {
    Random random(1);
    for (const FarMesh& mesh : far_meshes()) {
        const ExactMap map = ExactMap::build(mesh.far);
        ASSERT_EQ(map.view().origin, mesh.far.origin);
        for (int i = 0; i < 300; ++i) {
            const Vec3d point = mesh.random_point(random);
            const double distance = mesh.distance(point);
            const float answer = signed_distance(map, mesh.local(point));
            EXPECT_NEAR(std::abs(answer), distance, mesh.tolerance + 0x1p-23 * distance);
            if (distance > mesh.tolerance) EXPECT_EQ(std::signbit(answer), mesh.is_inside(point));
            const Contact contact = echinus::contact(map, mesh.local(point), INFINITY);
            const Vec3d place = Vec3d(contact.point) + map.view().origin;
            EXPECT_NEAR(length(place - point), distance, mesh.tolerance + 0x1p-22 * distance);
        }
    }
}

TEST(FarAway, DistanceMapsGiveSidesAsAtTheOrigin) {
    Random random(2);
    for (const FarMesh& mesh : far_meshes()) {
        const DistanceMap map = DistanceMap::build(mesh.far);
        ASSERT_EQ(map.view().origin, mesh.far.origin);
        for (int i = 0; i < 300; ++i) {
            const Vec3d point = mesh.random_point(random);
            if (mesh.distance(point) > 0.03)
                EXPECT_EQ(contains(map, mesh.local(point)), mesh.is_inside(point));
        }
    }
}

TEST(FarAway, CollidersPlaceWhatTheFileHas) {
    Random random(3);
    const FarMesh mesh(make_box({1, 0.9, 0.8}), {448262, 5411932, 112});
    // Turned about the file's 0, scaled, and moved so that it stands near the world's.
    const Vec3d scale{1, 2, -1};
    RigidTransform pose{Rotation::about({1, 2, 3}, 0.7), {}};
    const Vec3d centre{448262, 2 * 5411932, -112};
    pose.translation = -pose.rotation.apply(centre);
    const std::array<Collider, 1> colliders{
        {{.map = ExactMap::build(mesh.far), .pose = pose, .scale = scale}}};
    for (int i = 0; i < 300; ++i) {
        const Vec3d local(in_cube(random, 0.8F));
        if (mesh.distance(local + mesh.offset) < 1e-5) continue;
        const Vec3d stretched{scale.x * local.x, scale.y * local.y, scale.z * local.z};
        const Vec3d world = pose.rotation.apply(stretched);
        const bool inside = mesh.is_inside(local + mesh.offset);
        EXPECT_EQ(contains(colliders[0], Vec3f(world)), inside);
        std::uint32_t particle = 0;
        const ContactArrays<double> arrays{.particles = {&particle, 1}};
        EXPECT_EQ(contacts_into(colliders, StridedSpan<const Vec3d>(&world, 1), 0, arrays), inside ? 1U : 0U);
    }
}

TEST(FarAway, TetrahedraFillWhatIsThere) {
    const FarMesh mesh(make_sphere(0.7, 24, 12), {448262, 5411932, 112});
    const ExactMap map = ExactMap::build(mesh.far);
    const TetrahedralMesh body = tetrahedralize(map, {.size = 0.1}).mesh;
    EXPECT_EQ(body.origin, mesh.far.origin);
    EXPECT_EQ(boundary(body).origin, mesh.far.origin);
    EXPECT_EQ(reconstruct_surface(map).mesh.origin, mesh.far.origin);
    EXPECT_NEAR(inspect_tetrahedra(body).volume, inspect(mesh.near).signed_volume, 0.03);
    // Of the same body in another local frame.
    TetrahedralMesh moved = body;
    for (Vec3f& vertex : moved.vertices) vertex = vertex + Vec3f{8, 0, 0};
    moved.origin = body.origin - Vec3d{8, 0, 0};
    const BoundaryDistance here = measure_distance(body, map), there = measure_distance(moved, map);
    EXPECT_LT(here.greatest_to_model, 0.1);
    EXPECT_NEAR(there.greatest_to_model, here.greatest_to_model, 1e-5);
    EXPECT_NEAR(there.greatest_to_boundary, here.greatest_to_boundary, 1e-5);
}

TEST(FarAway, MapsOfEqualFloatsHaveOtherHashesThanAtTheOrigin) {
    const FarMesh mesh(make_box({1, 1, 1}), {448262, 5411932, 112});
    TriangleMesh here = mesh.far;
    here.origin = {};
    EXPECT_NE(ExactMap::build(mesh.far).source_hash(), ExactMap::build(here).source_hash());
    EXPECT_NE(DistanceMap::build(mesh.far).source_hash(), DistanceMap::build(here).source_hash());
}
