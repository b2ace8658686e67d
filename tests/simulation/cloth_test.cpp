// Cloth of a rectangle and from any mesh.

#include "support/draping.hpp"
#include "support/expectations.hpp"
#include "support/instruction_sets.hpp"
#include "support/meshes.hpp"

#include <echinus/error.hpp>
#include <echinus/simulation.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <set>
#include <utility>

using namespace echinus;

namespace {

/// Whether a constraint of a kind joins two particles of a sheet, by how far apart they are in columns and
/// rows.
bool should_join(int columns_apart, int rows_apart, ConstraintKind kind) {
    const int far = std::max(columns_apart, rows_apart);
    const int near = std::min(columns_apart, rows_apart);
    switch (kind) {
    case ConstraintKind::Structural:
        return far == 1 && near == 0;
    case ConstraintKind::Shear:
        return far == 1 && near == 1;
    default:
        return far == 2 && near == 0;
    }
}

constexpr float kNaNLength = std::numeric_limits<float>::quiet_NaN();
/// That adds up over some frames in coordinates around 1.
constexpr double kRounding = 1e-5;
const SimulationOptions kWeightless{.gravity = {}};

std::size_t count_of(const Deformable& cloth, ConstraintKind kind) {
    return static_cast<std::size_t>(
        std::count_if(cloth.constraints.begin(), cloth.constraints.end(),
                      [=](const DistanceConstraint& constraint) { return constraint.kind == kind; }));
}

std::set<std::pair<std::uint32_t, std::uint32_t>> pairs_of(const Deformable& cloth, ConstraintKind kind) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> pairs;
    for (const DistanceConstraint& constraint : cloth.constraints)
        if (constraint.kind == kind) pairs.insert(std::minmax(constraint.a, constraint.b));
    return pairs;
}

/// A closed cube whose faces are quadrilaterals.
TriangleMesh bag() {
    return make_box({1, 1, 1}, 5);
}

/// A sheet of 7 x 7 vertices without the four squares in its middle.
TriangleMesh sheet_with_hole() {
    TriangleMesh mesh = test::sheet_mesh(7, 7);
    const auto is_in_hole = [&](const Triangle& face) {
        Vec3f middle;
        for (const std::uint32_t corner : face) middle += mesh.vertices[corner] * (1.0F / 3);
        return std::max(std::fabs(middle.x), std::fabs(middle.y)) < 1.0F / 6;
    };
    std::erase_if(mesh.faces, is_in_hole);
    return weld(mesh);
}

void expect_at_rest_without_gravity(const Deformable& cloth, double tolerance) {
    for (const SimulationOptions& options : {kWeightless, test::jakobsen(kWeightless)}) {
        Simulation simulation(cloth, {}, options);
        for (int i = 0; i < 20; ++i) simulation.step();
        float farthest = 0;
        for (std::size_t i = 0; i < cloth.particle_count(); ++i)
            farthest = std::max(farthest, length(simulation.positions()[i] - cloth.positions[i]));
        EXPECT_LE(farthest, tolerance);
    }
}

void expect_refusal(const std::string& words, const TriangleMesh& mesh, const MeshClothOptions& options = {},
                    ErrorCode code = ErrorCode::InvalidMesh) {
    test::expect_error(code, words, [&] { make_cloth(mesh, options); });
}

} // namespace

TEST(Cloth, HasEveryConstraintOfItsKindOnceAndNoOther) {
    for (const auto& [columns, rows] : {std::pair{2, 2}, {7, 4}, {3, 9}, {8, 8}}) {
        const Deformable cloth =
            make_cloth({.column_count = std::uint32_t(columns), .row_count = std::uint32_t(rows)});
        std::set<std::pair<std::uint32_t, std::uint32_t>> seen;
        for (const DistanceConstraint& constraint : cloth.constraints) {
            const int a = int(constraint.a);
            const int b = int(constraint.b);
            EXPECT_TRUE(should_join(std::abs(a % columns - b % columns), std::abs(a / columns - b / columns),
                                    constraint.kind))
                << a << " " << b;
            EXPECT_TRUE(seen.insert(std::minmax(constraint.a, constraint.b)).second) << a << " " << b;
        }
        const int structural = (columns - 1) * rows + columns * (rows - 1);
        const int shear = 2 * (columns - 1) * (rows - 1);
        const int bending = (columns - 2) * rows + columns * (rows - 2);
        EXPECT_EQ(cloth.constraints.size(), std::size_t(structural + shear + bending));
    }
}

TEST(Cloth, OfThePaperHas59002Constraints) {
    EXPECT_EQ(make_cloth({.column_count = 100, .row_count = 100}).constraints.size(), 59'002u);
}

TEST(Cloth, IsAtRestWhereItStarts) {
    const RigidTransform pose{Rotation::about({1, 2, 3}, 0.8), {5, -4, 3}};
    const Deformable cloth =
        make_cloth({.column_count = 9, .row_count = 6, .width = 2, .height = 3, .pose = pose});
    EXPECT_TRUE(cloth.velocities.empty());
    for (const DistanceConstraint& constraint : cloth.constraints)
        EXPECT_NEAR(length(cloth.positions[constraint.b] - cloth.positions[constraint.a]),
                    constraint.rest_length, 1e-6);
    EXPECT_NEAR(length(Vec3d(cloth.positions.front()) - pose.to_world({-1, -1.5, 0})), 0, 1e-6);
    EXPECT_NEAR(length(Vec3d(cloth.positions.back()) - pose.to_world({1, 1.5, 0})), 0, 1e-6);
}

TEST(Cloth, TurnsAllItsFacesAlongItsLocalZ) {
    const RigidTransform pose{Rotation::about({1, 0, 0}, std::numbers::pi / 2), {}};
    const Deformable cloth = make_cloth({.column_count = 5, .row_count = 4, .pose = pose});
    EXPECT_EQ(cloth.faces.size(), 4u * 3u * 2u);
    const Vec3d front = pose.rotation.apply({0, 0, 1});
    double area = 0;
    for (const Triangle& face : cloth.faces) {
        const Vec3d a(cloth.positions[face[0]]);
        const Vec3d twice_area =
            cross(Vec3d(cloth.positions[face[1]]) - a, Vec3d(cloth.positions[face[2]]) - a);
        EXPECT_NEAR(dot(twice_area, front), length(twice_area), 1e-7);
        area += length(twice_area) / 2;
    }
    EXPECT_NEAR(area, 1, 1e-6);
}

TEST(Cloth, PinsWhatItIsToldTo) {
    const Deformable cloth = make_cloth({.column_count = 3, .row_count = 3, .pins = {0, 8}});
    for (std::size_t i = 0; i < 9; ++i) EXPECT_EQ(cloth.inverse_masses[i], i == 0 || i == 8 ? 0 : 1);
}

TEST(Cloth, RefusesSizesThatMakeNoSheet) {
    const auto expect_refused = [](const ClothOptions& options) {
        test::expect_error(ErrorCode::InvalidOptions, "", [&] { make_cloth(options); });
    };
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    expect_refused({.column_count = 1});
    expect_refused({.row_count = 0});
    expect_refused({.column_count = 1U << 31, .row_count = 1U << 31});
    expect_refused({.width = 0});
    expect_refused({.height = kNaN});
    expect_refused({.column_count = 4, .row_count = 4, .pins = {16}});
}

TEST(MeshCloth, OfASheetHasTheConstraintsOfTheSheetThatIsWovenButForBending) {
    const Deformable woven = make_cloth({.column_count = 7, .row_count = 5, .width = 1, .height = 4.0 / 6});
    const Deformable cloth = make_cloth(test::sheet_mesh(7, 5), {});
    EXPECT_EQ(cloth.faces, woven.faces);
    for (const ConstraintKind kind : {ConstraintKind::Structural, ConstraintKind::Shear})
        EXPECT_EQ(pairs_of(cloth, kind), pairs_of(woven, kind));
    EXPECT_EQ(count_of(cloth, ConstraintKind::Bending),
              2 * 4 * 6u - 4 - 6); // at edges but those of the border
}

TEST(MeshCloth, HasOneConstraintForEachEdgeAndABendingConstraintAcrossEachButDiagonals) {
    const TriangleMesh sphere = make_sphere(1, 12, 8);
    const Deformable cloth = make_cloth(sphere, {});
    const std::size_t edge_count = sphere.vertices.size() + sphere.faces.size() - 2; // Euler
    const std::size_t diagonal_count = count_of(cloth, ConstraintKind::Shear) / 2;
    EXPECT_EQ(count_of(cloth, ConstraintKind::Structural) + diagonal_count, edge_count);
    EXPECT_EQ(count_of(cloth, ConstraintKind::Bending) + diagonal_count, edge_count);
}

TEST(MeshCloth, OfTrianglesThatMakeUpNoRectanglesHasNoShearConstraints) {
    TriangleMesh slanted = test::sheet_mesh(6, 6);
    for (Vec3f& vertex : slanted.vertices) vertex.x += 0.5F * vertex.y; // equilateral, nearly
    EXPECT_EQ(count_of(make_cloth(slanted, {}), ConstraintKind::Shear), 0u);
}

TEST(MeshCloth, HasThePapersBendingConstraints) {
    const Deformable cloth = make_cloth(bag(), {});
    // At each edge of a square but none of its diagonals.
    EXPECT_EQ(count_of(cloth, ConstraintKind::Bending), 2 * 6 * 25u);
}

TEST(MeshCloth, OfACurvedShapeStaysAtRestWithoutGravity) {
    for (const TriangleMesh& mesh :
         {make_sphere(1, 16, 12), make_torus(1, 0.3, 20, 10), bag(), test::band_mesh(40, 2)})
        expect_at_rest_without_gravity(make_cloth(mesh, {}), kRounding);
}

TEST(MeshCloth, ThatLiesFlatAndAtRestDoesNotMoveAtAll) {
    // Powers of two, so that no rest length is rounded.
    Deformable cloth = make_cloth(test::sheet_mesh(9, 9), {});
    std::erase_if(cloth.constraints, [](const DistanceConstraint& constraint) {
        return constraint.kind == ConstraintKind::Shear;
    });
    expect_at_rest_without_gravity(cloth, 0);
}

TEST(MeshCloth, TakesItsRestShapeWhenItStartsInAnother) {
    const TriangleMesh dome = [] {
        TriangleMesh mesh = test::sheet_mesh(8, 8);
        for (Vec3f& v : mesh.vertices) v.z = 0.6F - 0.8F * (v.x * v.x + v.y * v.y);
        return mesh;
    }();
    TriangleMesh rumpled = dome;
    for (Vec3f& v : rumpled.vertices) v.z *= 0.8F;
    const Deformable cloth = make_cloth(rumpled, {.rest_vertices = dome.vertices});
    EXPECT_EQ(cloth.positions, rumpled.vertices);
    SimulationOptions options = kWeightless;
    options.newton().air_drag = 5;
    options.newton().material.bending_stiffness = 1;
    for (const bool is_jakobsen : {false, true}) {
        if (is_jakobsen) options.solver = JakobsenOptions{.drag = 0.1};
        Simulation simulation(cloth, {}, options);
        for (int i = 0; i < 400; ++i) simulation.step();
        double farthest = 0; // bending constraints are as long as angles say
        for (const DistanceConstraint& constraint : cloth.constraints) {
            const double distance =
                length(simulation.positions()[constraint.b] - simulation.positions()[constraint.a]);
            farthest = std::max(farthest, std::abs(distance / constraint.rest_length - 1));
        }
        EXPECT_LT(farthest, 1e-3);
    }
}

TEST(MeshCloth, HasTheLengthsOfItsRestShapeScaledAndPlacedAnywhere) {
    const TriangleMesh torus = make_torus(1, 0.4, 16, 8);
    const RigidTransform pose{Rotation::about({1, 2, 3}, 0.8), {5, -4, 3}};
    const Deformable cloth = make_cloth(torus, {.pose = pose, .scale = 2.5});
    for (std::size_t i = 0; i < torus.vertices.size(); ++i)
        EXPECT_EQ(cloth.positions[i], Vec3f(pose.to_world(Vec3d(torus.vertices[i]) * 2.5)));
    for (const DistanceConstraint& constraint : cloth.constraints)
        EXPECT_NEAR(length(cloth.positions[constraint.b] - cloth.positions[constraint.a]),
                    constraint.rest_length, 4e-6);
}

TEST(MeshCloth, WeighsItsParticlesByTheAreaAroundThem) {
    const Deformable cloth = make_cloth(test::sheet_mesh(6, 6), {.pins = {7}});
    double sum = 0;
    for (std::size_t i = 0; i < 36; ++i)
        if (i != 7) sum += 1 / cloth.inverse_masses[i];
    const float inner = 1 / cloth.inverse_masses[14];
    EXPECT_NEAR(sum, 36 - inner, 1e-4); // the mean is 1
    EXPECT_NEAR(inner, 36.0 / 25, 1e-5);
    EXPECT_NEAR(1 / cloth.inverse_masses[1], inner / 2, 1e-5); // on the border
    EXPECT_NEAR(1 / cloth.inverse_masses[0], inner / 3, 1e-5); // a corner with two faces
    EXPECT_NEAR(1 / cloth.inverse_masses[5], inner / 6, 1e-5); // a corner with one
    EXPECT_EQ(cloth.inverse_masses[7], 0);
}

TEST(MeshCloth, MayHaveHolesAndSeveralPieces) {
    const TriangleMesh holed = sheet_with_hole();
    EXPECT_EQ(holed.vertices.size(), 48u);
    const TriangleMesh pieces = test::joined({holed, test::translated(bag(), {3, 0, 0})});
    const Deformable cloth = make_cloth(pieces, {.pins = {0}});
    Simulation simulation(cloth, {}, {});
    for (int i = 0; i < 15; ++i) simulation.step();
    // The pinned piece hangs, the other falls.
    EXPECT_GT(simulation.positions()[24].z, -1.5);
    for (std::size_t i = holed.vertices.size(); i < pieces.vertices.size(); ++i)
        EXPECT_LT(simulation.positions()[i].z, cloth.positions[i].z - 0.2);
}

TEST(MeshCloth, MayHaveThreads) {
    // A needle of five particles beside a sheet, sewn to its corner.
    TriangleMesh mesh = test::sheet_mesh(4, 4);
    MeshClothOptions options;
    std::uint32_t last = 15;
    for (std::uint32_t i = 0; i < 5; ++i) {
        mesh.vertices.push_back(mesh.vertices[15] + Vec3f{0.1F * static_cast<float>(i + 1), 0, 0});
        options.threads.push_back({last, 16 + i});
        last = 16 + i;
    }
    const Deformable cloth = make_cloth(mesh, options);
    const Deformable sheet = make_cloth(test::sheet_mesh(4, 4), {});
    EXPECT_EQ(cloth.constraints.size(), sheet.constraints.size() + 5 + 4);
    EXPECT_EQ(count_of(cloth, ConstraintKind::Bending), count_of(sheet, ConstraintKind::Bending) + 4);
    for (const float inverse_mass : cloth.inverse_masses) {
        EXPECT_GT(inverse_mass, 0.1F);
        EXPECT_LT(inverse_mass, 10);
    }
}

TEST(MeshCloth, MayBeAThreadAlone) {
    const TriangleMesh thread{{{0, 0, 0}, {0.1F, 0, 0}, {0.2F, 0, 0}, {0.3F, 0, 0}}, {}};
    const Deformable cloth = make_cloth(thread, {.threads = {{0, 1}, {1, 2}, {2, 3}}, .pins = {0}});
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_NEAR(cloth.inverse_masses[i], (std::array{0.0, 0.75, 0.75, 1.5}[i]), 1e-6);
    Simulation simulation(cloth, {}, {.solver = NewtonOptions{.air_drag = 5}});
    for (int i = 0; i < 300; ++i) simulation.step();
    EXPECT_NEAR(simulation.positions()[3].z, -0.3, 0.01); // it hangs
}

TEST(MeshCloth, TurnsFacesRoundThatRunAlongAnEdgeTheSameWay) {
    const TriangleMesh sheet = test::sheet_mesh(6, 5);
    TriangleMesh muddled = sheet;
    for (std::size_t face = 1; face < muddled.faces.size(); face += 3)
        std::swap(muddled.faces[face][0], muddled.faces[face][1]);
    const TriangleMesh mended{sheet.vertices, make_cloth(muddled, {}).faces};
    EXPECT_EQ(inspect(mended).misoriented_edges.count, 0u);
    EXPECT_EQ(mended.faces.front(), sheet.faces.front());
}

TEST(MeshCloth, MayBeOneSided) {
    const TriangleMesh strip = test::band_mesh(40, 1);
    const Deformable cloth = make_cloth(strip, {});
    EXPECT_EQ(inspect({strip.vertices, cloth.faces}).misoriented_edges.count, 1u);
    expect_at_rest_without_gravity(cloth, kRounding);
}

TEST(MeshCloth, OfAMeshThatIsNoSurfaceIsRefusedByName) {
    TriangleMesh three = test::sheet_mesh(3, 3);
    three.vertices.emplace_back(0, 0, 1);
    three.faces.push_back({4, 5, 9});
    expect_refusal("the edge between vertices 4 and 5 has the faces 3, 6, 8", three);

    TriangleMesh doubled = test::sheet_mesh(3, 3);
    doubled.faces = {doubled.faces[0], {0, 4, 1}};
    expect_refusal("faces 0 and 1 of the cloth have the same corners", doubled);

    TriangleMesh collapsed = test::sheet_mesh(3, 3);
    collapsed.faces[3] = {4, 4, 5};
    expect_refusal("face 3 of the cloth has two equal corners", collapsed);

    TriangleMesh thin = test::sheet_mesh(3, 3);
    thin.faces.push_back({0, 1, 2});
    expect_refusal("face 8 of the cloth has no area", thin);

    TriangleMesh unused = test::sheet_mesh(3, 3);
    unused.vertices.emplace_back(0, 0, 1);
    expect_refusal("vertex 9 of the cloth belongs to no face and no thread", unused);

    TriangleMesh broken = test::sheet_mesh(3, 3);
    broken.faces[2][1] = 9;
    expect_refusal("face 2 of the mesh refers to vertex 9", broken);

    TriangleMesh nowhere = test::sheet_mesh(3, 3);
    nowhere.vertices[4].z = kNaNLength;
    expect_refusal("uses vertex 4", nowhere);
    expect_refusal("neither faces nor threads", {});
}

TEST(MeshCloth, RefusesOptionsOutOfRangeByName) {
    const TriangleMesh sheet = test::sheet_mesh(3, 3);
    const auto expect_option = [&](const std::string& words, const MeshClothOptions& options) {
        expect_refusal(words, sheet, options, ErrorCode::InvalidOptions);
    };
    expect_option("a pin refers to vertex 9, but the cloth has only 9", {.pins = {9}});
    expect_option("an attachment refers to vertex 10", {.attachments = {{10}}});
    expect_option("vertex 4 is both pinned", {.pins = {0, 4}, .attachments = {{4}}});
    expect_option("a thread ends at vertex 11", {.threads = {{0, 11}}});
    expect_option("the cloth's scale is 0; it must lie in", {.scale = 0});
    expect_option("its rest shape has 2; the numbers must be equal", {.rest_vertices = {{}, {}}});
    expect_option("the cloth has the rotation", {.pose = {{2, 0, 0, 0}, {}}});
    expect_refusal("the thread from vertex 3 to 3 has no length", sheet, {.threads = {{3, 3}}});
    TriangleMesh flat_at_rest = sheet;
    for (Vec3f& v : flat_at_rest.vertices) v.y = 0;
    expect_refusal("face 0 of the cloth has no area", sheet, {.rest_vertices = flat_at_rest.vertices});
}

TEST(MeshCloth, FallsToTheSameBitsOnEveryRunAndUnderEachInstructionSet) {
    const std::vector<Collider> colliders{{.map = ExactMap::build(make_sphere(0.4, 24, 12))}};
    for (const SimulationOptions& options : {SimulationOptions{}, test::jakobsen()}) {
        std::set<std::uint64_t> hashes;
        test::under_each_instruction_set([&](std::string_view) {
            const Deformable cloth =
                make_cloth(make_torus(0.6, 0.25, 24, 12), {.pose = {Rotation{}, {0.1, 0, 0.8}}});
            Simulation simulation(cloth, colliders, options);
            while (simulation.frame() * options.time_step < 0.4) simulation.step();
            hashes.insert(simulation.state_hash());
            EXPECT_GT(simulation.profile().contact_count, 0u);
            EXPECT_EQ(simulation.profile().lost_count, 0u);
        });
        EXPECT_EQ(hashes.size(), 1u);
    }
}

// ---- Attachments ----

TEST(Attachments, FollowATurningColliderExactly) {
    const Collider turning{.map = ExactMap::build(make_box({1, 1, 1})),
                           .pose = {Rotation::about({0, 1, 0}, 0.3), {1, 2, 3}},
                           .linear_velocity = {0.3, 0, 0.1},
                           .angular_velocity = {1, 5, 2}};
    const std::vector<std::uint32_t> held{0, 1, 2, 3};
    for (const SimulationOptions& solver :
         {SimulationOptions{.solver = NewtonOptions{.collision = CollisionMode::Surfaces}},
          test::jakobsen()}) {
        MeshClothOptions options{.pose = {Rotation{}, {1, 2, 3.8}}};
        for (const std::uint32_t particle : held) options.attachments.push_back({particle, 0});
        const Deformable cloth = make_cloth(test::sheet_mesh(4, 6), options);
        Simulation simulation(cloth, {turning}, solver);
        for (int i = 0; i < 50; ++i) simulation.step();
        const RigidTransform& pose = simulation.colliders()[0].pose;
        for (const std::uint32_t particle : held)
            EXPECT_EQ(simulation.positions()[particle],
                      Vec3f(pose.to_world(turning.pose.to_local(Vec3d(cloth.positions[particle])))));
        for (std::size_t i = 0; i < cloth.particle_count(); ++i)
            EXPECT_LT(length(simulation.positions()[i] - simulation.positions()[0]), 3);
    }
}

TEST(Attachments, GiveParticlesTheVelocityOfTheCollider) {
    Deformable cloth = make_cloth(test::sheet_mesh(2, 2), {.attachments = {{0}, {1}, {2}, {3}}});
    Simulation simulation(cloth,
                          {{.map = ExactMap::build(make_box({1, 1, 1})),
                            .pose = {Rotation{}, {0, 0, -5}},
                            .linear_velocity = {0, 3, 4}}},
                          test::jakobsen());
    for (int i = 0; i < 10; ++i) simulation.step();
    EXPECT_NEAR(simulation.largest_speed(), 5, 1e-3);
}

TEST(Attachments, AreRefusedByNameWhereTheyDoNotFit) {
    const std::vector<Collider> colliders{{.map = ExactMap::build(make_box({1, 1, 1}))}};
    const auto expect_words = [&](const std::string& words, const Deformable& cloth) {
        test::expect_error(ErrorCode::InvalidOptions, words,
                           [&] { Simulation(cloth, colliders, test::jakobsen()); });
    };
    const TriangleMesh sheet = test::translated(test::sheet_mesh(3, 3), {0, 0, 2});
    expect_words("refers to collider 1 of 1", make_cloth(sheet, {.attachments = {{4, 1}}}));
    expect_words("particle 4 is not its first", make_cloth(sheet, {.attachments = {{4, 0}, {4, 0}}}));
    Deformable free = make_cloth(sheet, {});
    free.attachments = {{2, 0}};
    expect_words("attachment 0 of particle 2: an attached particle must be pinned", free);
    free.attachments = {{9, 0}};
    expect_words("the last particle is 8", free);
}
