// Starts that intersect are parted, or refused by name.

#include "support/draping.hpp"
#include "support/expectations.hpp"
#include "support/meshes.hpp"
#include "support/surface_judge.hpp"

#include <echinus/intersections.hpp>
#include <echinus/simulation.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

using namespace echinus;
using namespace echinus::test;

namespace {

const SimulationOptions kUntangled{.solver = NewtonOptions{.untangle = true}, .thickness = 0.01};

float largest_stretch(const Deformable& before, const Deformable& after) {
    float largest = 0;
    for (const auto& [a, b, c] : before.faces)
        for (const auto& [p, q] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}})
            largest = std::max(largest, length(after.positions[p] - after.positions[q]) /
                                            length(before.positions[p] - before.positions[q]));
    return largest;
}

/// The share of edges whose length changes by more than 5 %.
double stretched_share(const Deformable& before, const Deformable& after) {
    std::size_t count = 0;
    for (const auto& [a, b, c] : before.faces)
        for (const auto& [p, q] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}}) {
            const float ratio = length(after.positions[p] - after.positions[q]) /
                                length(before.positions[p] - before.positions[q]);
            if (std::abs(ratio - 1) > 0.05F) ++count;
        }
    return static_cast<double>(count) / (3 * static_cast<double>(before.faces.size()));
}

/// The start is refused without untangle, and with it nothing intersects at the start and in 15 frames.
/// @return how far edges are stretched at most when it begins
float expect_parted(const Deformable& deformable, const std::vector<TriangleMesh>& models,
                    const std::vector<Collider>& colliders) {
    SimulationOptions tangled = kUntangled;
    tangled.newton().untangle = false;
    expect_error(ErrorCode::InvalidOptions, "set untangle",
                 [&] { Simulation(deformable, colliders, tangled); });
    Simulation simulation(deformable, colliders, kUntangled);
    const float stretch = largest_stretch(deformable, simulation.deformable());
    for (int i = 0; i <= 15; ++i) {
        EXPECT_TRUE(meeting_faces(simulation, models).empty()) << "in frame " << i;
        for (const Collider& collider : simulation.colliders())
            for (const Vec3f& p : simulation.positions()) EXPECT_FALSE(contains(collider, p));
        if (::testing::Test::HasFailure()) break;
        simulation.step();
    }
    EXPECT_EQ(simulation.profile().unresolved_count, 0u);
    return stretch;
}

/// A mesh whose vertices all go through a function.
TriangleMesh bent(TriangleMesh mesh, const std::function<Vec3f(const Vec3f&)>& to) {
    for (Vec3f& v : mesh.vertices) v = to(v);
    return mesh;
}

Vec3f turned(const Vec3f& p, const Vec3d& axis, double angle) {
    return Vec3f(Rotation::about(axis, angle).apply(Vec3d(p)));
}

Deformable cloth_of(const TriangleMesh& mesh) {
    return make_cloth(mesh, {});
}

} // namespace

TEST(Untangle, PartsASheetThatBeginsThroughABallAtWhateverHeight) {
    const std::vector<TriangleMesh> ball{make_sphere(0.4, 24, 12)};
    for (const double height : {0.0, 0.01, 0.1, -0.1, 0.3, 0.39})
        EXPECT_LT(expect_parted(sheet_at(height, 1.2, 19), ball, colliders_of(ball)), 5) << height;
}

TEST(Untangle, PartsASheetThatBeginsInsideABall) {
    const std::vector<TriangleMesh> ball{make_sphere(0.4, 24, 12)};
    for (const double height : {0.0, 0.1, -0.25})
        EXPECT_LT(expect_parted(sheet_at(height, 0.4, 15), ball, colliders_of(ball)), 5) << height;
}

TEST(Untangle, PartsABagThatBeginsInsideABallAndOneThatBeginsHalfInside) {
    const std::vector<TriangleMesh> ball{make_sphere(0.4, 24, 12)};
    const TriangleMesh bag = make_sphere(0.2, 16, 8);
    for (const float shift : {0.0F, 0.1F, 0.4F})
        expect_parted(cloth_of(translated(bag, {shift, 0, 0.01F})), ball, colliders_of(ball));
}

TEST(Untangle, LiftsASheetOffATipThatPiercesAFace) {
    const TriangleMesh needle{{{0, 0, 0.3F}, {0.01F, 0, -2}, {-0.005F, 0.008F, -2}, {-0.005F, -0.008F, -2}},
                              {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}};
    for (const Vec3f& at : {Vec3f{0.01F, 0.02F, 0}, Vec3f{0.37F, 0.31F, 0.05F}}) {
        const TriangleMesh model = translated(needle, at);
        expect_parted(sheet_at(0, 1, 12), {model}, colliders_of({model}));
    }
}

TEST(Untangle, PartsASheetFromModelsThatAreTurnedScaledAndMirrored) {
    const std::vector<TriangleMesh> models{make_torus(1, 0.4, 24, 10), make_box({1, 1, 1})};
    std::vector<Collider> colliders = colliders_of(models);
    colliders[0].pose = {Rotation::about({1, 1, 0}, 0.4), {0, 0, 0.05}};
    colliders[0].scale = {-0.5, 0.3, 0.4};
    colliders[1].pose = {Rotation::about({1, 2, 3}, 1), {0.6, 0.5, -0.05}};
    colliders[1].scale = {0.2, 0.3, 0.1};
    expect_parted(sheet_at(0, 1.6, 30), models, colliders);
}

TEST(Untangle, LiftsASheetThatLiesExactlyOnAModelOrALatticeStepInsideIt) {
    const TriangleMesh table = make_box({4, 4, 1});
    for (const double height : {0.5, 0.5000002, 0.4999998, 0.499999})
        expect_parted(sheet_at(height, 2, 9), {table}, colliders_of({table}));
    // Across an edge of the table, whose middle the map has a little inside.
    for (const double depth : {0.0, 1e-7, -1e-6}) {
        TriangleMesh slanted{{{1.5F, -0.4F, 1}, {2.5F, -0.4F, 0}, {1.5F, 0.4F, 1}, {2.5F, 0.4F, 0}},
                             {{0, 1, 2}, {2, 1, 3}}};
        for (Vec3f& p : slanted.vertices) p = p - Vec3f(Vec3d{depth, 0, depth});
        expect_parted(cloth_of(slanted), {table}, colliders_of({table}));
    }
    const TriangleMesh plane = sheet_mesh(5, 5); // open
    Deformable on_it = sheet_at(0, 0.5, 7);
    expect_parted(on_it, {plane}, colliders_of({plane}));
}

TEST(Untangle, PartsASheetFromAnOpenSurface) {
    TriangleMesh dome = make_sphere(0.4, 20, 10);
    std::erase_if(dome.faces, [&](const Triangle& f) {
        return dome.vertices[f[0]].z + dome.vertices[f[1]].z + dome.vertices[f[2]].z < 0;
    });
    expect_parted(sheet_at(0.3, 1, 20), {weld(dome)}, colliders_of({weld(dome)}));
}

TEST(Untangle, PartsWhatAParticleSimulationHasLeftCutting) {
    const std::vector<TriangleMesh> model{make_box({0.5, 0.5, 0.5})};
    Simulation particles(sheet_at(0.3, 1.2, 14), colliders_of(model), jakobsen({.thickness = 0.01}));
    for (int i = 0; i < 120; ++i) particles.step();
    EXPECT_LT(expect_parted(particles.deformable(), model, colliders_of(model)), 1.5);
}

TEST(Untangle, PartsTwoLayersThatCrossAlongALine) {
    const TriangleMesh below = sheet_mesh(20, 20);
    for (const double angle : {0.05, 0.3, -0.3}) {
        const TriangleMesh above = bent(sheet_mesh(14, 14), [&](const Vec3f& p) {
            return turned(p + Vec3f{0.03F, 0.011F, 0}, {0.2, 1, 0}, angle) + Vec3f{0, 0, 0.01F};
        });
        expect_parted(cloth_of(joined({below, above})), {}, {});
    }
}

TEST(Untangle, PartsALayerWhoseCornerOrBumpHasComeThroughAnother) {
    const TriangleMesh level = sheet_mesh(20, 20);
    const TriangleMesh corner = bent(sheet_mesh(14, 14), [](const Vec3f& p) {
        return p + Vec3f{0, 0, 0.12F - 0.2F * (p.x + p.y)};
    });
    EXPECT_LT(expect_parted(cloth_of(joined({level, corner})), {}, {}), 1.5);
    const TriangleMesh bump = bent(sheet_mesh(17, 17), [](const Vec3f& p) {
        return p * 0.9F + Vec3f{0.02F, 0.01F, 0.05F - 0.12F * std::exp(-20 * (p.x * p.x + p.y * p.y))};
    });
    EXPECT_LT(expect_parted(cloth_of(joined({level, bump})), {}, {}), 1.5);
    EXPECT_LT(expect_parted(cloth_of(joined({bump, level})), {}, {}), 1.5);
}

TEST(Untangle, PartsLayersThatCutIntoEachOtherFromTheirBorders) {
    const TriangleMesh level = sheet_mesh(20, 20);
    const TriangleMesh beside = bent(sheet_mesh(14, 14), [](const Vec3f& p) {
        return turned(p, {1, 0, 0}, 0.4) + Vec3f{0.5F, 0.013F, 0.007F};
    });
    expect_parted(cloth_of(joined({level, beside})), {}, {});
}

TEST(Untangle, PartsASheetFoldedThroughItself) {
    // A strip whose two ends cross.
    const TriangleMesh strip = bent(sheet_mesh(33, 9), [](const Vec3f& p) {
        const double angle = double{p.x} * 1.2 * 2 * std::numbers::pi;
        return Vec3f(0.3F * float(std::sin(angle)), p.y,
                     0.3F * float(std::cos(angle)) + p.x * (1.2F * (p.y + 0.375F) + 0.003F));
    });
    expect_parted(cloth_of(strip), {}, {});
}

TEST(Untangle, PartsAThreadThatPassesThroughASheet) {
    TriangleMesh mesh = sheet_mesh(15, 15);
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    MeshClothOptions options;
    for (std::uint32_t i = 0; i < 12; ++i) {
        const float way = 0.02F * static_cast<float>(i);
        mesh.vertices.push_back({0.013F + way, 0.021F + way * way, 0.19F - way});
        if (i > 0) options.threads.push_back({first + i - 1, first + i});
    }
    std::reverse(options.threads.begin(), options.threads.end());
    expect_parted(make_cloth(mesh, options), {}, {});
}

TEST(Untangle, PartsLayersInsideAModelFromItAndFromEachOther) {
    const std::vector<TriangleMesh> ball{make_sphere(0.4, 24, 12)};
    const TriangleMesh level = sheet_mesh(20, 20);
    const TriangleMesh tilted = bent(sheet_mesh(14, 14), [](const Vec3f& p) {
        return turned(p, {0, 1, 0}, 0.1) + Vec3f{0.01F, 0.01F, 0.02F};
    });
    const TriangleMesh both = bent(joined({level, tilted}), [](const Vec3f& p) {
        return p + Vec3f{0, 0, 0.33F};
    });
    expect_parted(cloth_of(both), ball, colliders_of(ball));
}

TEST(Untangle, LiftsASheetThatStandsHalfInABoxAndHardlyStretchesIt) {
    const std::vector<TriangleMesh> box{make_box({1.3, 1.1, 0.9})};
    for (const double tilt : {0.0, 0.3}) {
        const TriangleMesh standing = bent(sheet_mesh(25, 25), [&](const Vec3f& p) {
            return turned(p, {1, 0, 0}, std::numbers::pi / 2 - tilt) + Vec3f{0, 0.013F, 0.2F};
        });
        EXPECT_LT(expect_parted(cloth_of(standing), box, colliders_of(box)), 1.5) << tilt;
    }
}

TEST(Untangle, PutsASleeveAroundTheArmThatComesThroughIt) {
    constexpr std::uint32_t kAround = 36, kRings = 40;
    TriangleMesh sleeve;
    for (std::uint32_t ring = 0; ring < kRings; ++ring)
        for (std::uint32_t i = 0; i < kAround; ++i) {
            const double angle = (i + 0.5 * (ring % 2)) * 2 * std::numbers::pi / kAround;
            const Vec3d point{0.06 * std::cos(angle), 0.06 * std::sin(angle),
                              0.6 * ring / (kRings - 1) - 0.3};
            sleeve.vertices.push_back(turned(Vec3f(point), {-0.1, 0.15, 0}, 0.18) + Vec3f{0.03F, 0.02F, 0});
        }
    for (std::uint32_t ring = 0; ring + 1 < kRings; ++ring)
        for (std::uint32_t i = 0; i < kAround; ++i) {
            const std::uint32_t a = ring * kAround + i, b = ring * kAround + (i + 1) % kAround;
            const std::uint32_t c = a + kAround, d = b + kAround;
            sleeve.faces.push_back(ring % 2 == 0 ? Triangle{a, b, c} : Triangle{a, b, d});
            sleeve.faces.push_back(ring % 2 == 0 ? Triangle{b, d, c} : Triangle{a, d, c});
        }
    const std::vector<TriangleMesh> arm{bent(make_sphere(1, 40, 40), [](const Vec3f& p) {
        return Vec3f{0.05F * p.x, 0.05F * p.y, 0.5F * p.z};
    })};
    EXPECT_LT(expect_parted(cloth_of(sleeve), arm, colliders_of(arm)), 3);
}

TEST(Untangle, PartsTenSheetsAtRandomPositionsAndHardlyStretchesThem) {
    for (const unsigned seed : {1U, 2U}) {
        std::mt19937 random(seed);
        const auto number = [&] { return static_cast<float>(random()) / 4294967296.0F - 0.5F; };
        TriangleMesh sheets;
        for (int i = 0; i < 10; ++i) {
            const Vec3d axis{number(), number(), number()};
            const double angle = double{number()} * 2 * std::numbers::pi;
            const Vec3f offset = Vec3f{number(), number(), number()} * 0.7F;
            sheets = joined({sheets, bent(sheet_mesh(15, 15),
                                          [&](const Vec3f& p) { return turned(p, axis, angle) + offset; })});
        }
        const Deformable cloth = cloth_of(sheets);
        EXPECT_GT(self_intersecting_pairs(sheets).size(), 500U) << seed;
        const Simulation simulation(cloth, {}, kUntangled);
        EXPECT_TRUE(meeting_faces(simulation, {}).empty()) << seed;
        EXPECT_LT(stretched_share(cloth, simulation.deformable()), 0.02) << seed;
    }
}

TEST(Untangle, ChangesNothingThatBeginsApart) {
    const std::vector<Collider> ball = colliders_of({make_sphere(0.4, 24, 12)});
    const Deformable sheet = sheet_at(0.5, 1, 20, {0, 0.6, -0.6});
    SimulationOptions plain = kUntangled;
    plain.newton().untangle = false;
    EXPECT_EQ(Simulation(sheet, ball, kUntangled).state_hash(), Simulation(sheet, ball, plain).state_hash());
}

TEST(Untangle, LeavesVelocitiesAsTheyAre) {
    const Vec3d velocity{0.06, 0.12, -0.18};
    const Deformable sheet = sheet_at(0.1, 1.2, 20, velocity);
    const Simulation simulation(sheet, colliders_of({make_sphere(0.4, 24, 12)}), kUntangled);
    const Deformable& parted = simulation.deformable();
    EXPECT_NE(parted.positions, sheet.positions);
    for (const Vec3f& kept : parted.velocities) EXPECT_EQ(kept, Vec3f(velocity));
}

TEST(Untangle, MovesNoPinnedParticleAndNamesWhatThatLeaves) {
    const std::vector<Collider> ball = colliders_of({make_sphere(0.4, 24, 12)});
    Deformable sheet = sheet_at(0.1, 1.2, 21);
    sheet.inverse_masses[0] = 0; // outside
    EXPECT_EQ(Simulation(sheet, ball, kUntangled).positions()[0], sheet.positions[0]);
    const std::size_t middle = 21 * 21 / 2;
    sheet.inverse_masses[middle] = 0;
    expect_error(ErrorCode::InvalidOptions, "that untangle could not separate: face ",
                 [&] { Simulation(sheet, ball, kUntangled); });
    Deformable inside = sheet_at(0.1, 0.2, 5);
    inside.inverse_masses.assign(25, 0);
    expect_error(
        ErrorCode::InvalidOptions,
        "25 particles begin inside collider 0, 25 of them pinned there; untangle could not move "
        "them out; the "
        "first is particle 0; move the deformable until they are apart, or do without collision of surfaces",
        [&] { Simulation(inside, ball, kUntangled); });
}

TEST(Untangle, MovesTheLayerThatIsNotPinned) {
    const TriangleMesh level = sheet_mesh(20, 20);
    const TriangleMesh corner = bent(sheet_mesh(14, 14), [](const Vec3f& p) {
        return p + Vec3f{0, 0, 0.12F - 0.2F * (p.x + p.y)};
    });
    for (const bool first : {true, false}) {
        Deformable cloth = cloth_of(joined({level, corner}));
        for (std::size_t i = 0; i < cloth.particle_count(); ++i)
            if ((i < 400) == first) cloth.inverse_masses[i] = 0;
        const Simulation simulation(cloth, {}, kUntangled);
        for (std::size_t i = 0; i < cloth.particle_count(); ++i)
            if (cloth.inverse_masses[i] == 0) EXPECT_EQ(simulation.positions()[i], cloth.positions[i]);
    }
    Deformable cloth = cloth_of(joined({level, corner}));
    cloth.inverse_masses.assign(cloth.particle_count(), 0);
    expect_error(ErrorCode::InvalidOptions, "begins intersecting itself in ",
                 [&] { Simulation(cloth, {}, kUntangled); });
}

TEST(Untangle, NeedsSurfaceCollision) {
    expect_error(ErrorCode::InvalidOptions, "untangle needs the collision of surfaces", [] {
        const NewtonOptions newton{.collision = CollisionMode::Particles, .untangle = true};
        Simulation(sheet_at(1, 1, 5), {}, {.solver = newton});
    });
}

TEST(Untangle, GivesTheSameBitsOnEveryRunWithAnyNumberOfThreads) {
    const std::vector<Collider> ball = colliders_of({make_sphere(0.4, 24, 12)});
    const Deformable sheet = sheet_at(0.1, 1.2, 60);
    const std::uint64_t first = Simulation(sheet, ball, kUntangled).state_hash();
    EXPECT_EQ(Simulation(sheet, ball, kUntangled).state_hash(), first);
    SimulationOptions on_threads = kUntangled;
    on_threads.thread_count = 3;
    EXPECT_EQ(Simulation(sheet, ball, on_threads).state_hash(), first);
}
