#include "simulation/coarse_sheets.hpp"
#include "support/cloth_meshes.hpp"
#include "support/kinds_of_simulations.hpp"

#include <echinus/error.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace echinus;
using namespace echinus::test;

namespace {

/// Row 0 is pinned.
Deformable hanging_sheet(std::uint32_t columns, std::uint32_t rows, const RigidTransform& pose = {}) {
    std::vector<std::uint32_t> pins;
    for (std::uint32_t c = 0; c < columns; ++c) pins.push_back(c);
    return make_cloth({.column_count = columns, .row_count = rows, .pose = pose, .pins = pins});
}

SimulationOptions hanging(bool multilevel) {
    return {.gravity = {0, 9.81, 0}, .rest = {.speed = 0}, .multilevel = multilevel};
}

/// Of its structural sticks, over their rest length.
double largest_stretch(const Deformable& cloth) {
    double largest = 0;
    for (const Stick& stick : cloth.sticks) {
        if (stick.kind != StickKind::Structural) continue;
        const double now = length(Vec3d(cloth.positions[stick.b]) - Vec3d(cloth.positions[stick.a]));
        largest = std::max(largest, now / double{stick.rest_length} - 1);
    }
    return largest;
}

Simulation after(int frames, const Deformable& cloth, const SimulationOptions& options) {
    Simulation simulation(cloth, {}, options);
    for (int i = 0; i < frames; ++i) simulation.step();
    return simulation;
}

Vec3d momentum_of(const Particles& before, const Particles& after, const Deformable& cloth) {
    Vec3d sum;
    for (std::size_t i = 0; i < cloth.particle_count(); ++i)
        sum +=
            (Vec3d(after.positions[i]) - Vec3d(before.positions[i])) * (1 / double{cloth.inverse_masses[i]});
    return sum;
}

} // namespace

TEST(CoarseSheets, KeepALargeClothThatHangsFromStretching) {
    const Deformable cloth = hanging_sheet(100, 200);
    EXPECT_GT(largest_stretch(after(120, cloth, hanging(false)).deformable()), 0.2);
    EXPECT_LT(largest_stretch(after(120, cloth, hanging(true)).deformable()), 0.005);
}

TEST(CoarseSheets, KeepEachPartOfWhatIsCombinedFromStretching) {
    const std::vector<Deformable> parts{hanging_sheet(41, 90), make_cloth(make_sphere(0.2, 12, 6), {}),
                                        hanging_sheet(90, 90, {Rotation{}, {2, 0, 0}})};
    const Simulation simulation = after(120, combine(parts), hanging(true));
    EXPECT_LT(largest_stretch(simulation.deformable()), 0.02);
    EXPECT_GT(largest_stretch(after(120, combine(parts), hanging(false)).deformable()), 0.05);
}

TEST(CoarseSheets, LeaveAClothAtRestAndOneInFoldsAsTheyAre) {
    Deformable cloth = make_cloth({.column_count = 40, .row_count = 33});
    for (std::size_t i = 0; i < cloth.particle_count(); ++i) // pleats, shorter than the cloth
        cloth.positions[i].z = 0.004F * static_cast<float>(i % 40 % 2), cloth.positions[i].x *= 0.9F;
    const Particles before(cloth);
    Particles after = before;
    CoarseSheets(cloth).relax(after);
    for (std::size_t i = 0; i < cloth.particle_count(); ++i)
        EXPECT_EQ(after.positions[i], before.positions[i]);
}

TEST(CoarseSheets, KeepTheMomentumOfAFreeCloth) {
    Deformable cloth = make_cloth({.column_count = 37, .row_count = 50});
    for (std::size_t i = 0; i < cloth.particle_count(); ++i) {
        cloth.positions[i].y *= 1.3F + 0.002F * static_cast<float>(i % 37);
        cloth.inverse_masses[i] = 1.0F / static_cast<float>(1 + i % 3);
    }
    const Particles before(cloth);
    Particles after = before;
    CoarseSheets(cloth).relax(after);
    double moved = 0;
    for (std::size_t i = 0; i < cloth.particle_count(); ++i)
        moved += double{length(after.positions[i] - before.positions[i])};
    EXPECT_GT(moved, 50);
    EXPECT_LT(length(momentum_of(before, after, cloth)), 1e-4 * moved);
}

TEST(CoarseSheets, MoveNoPinnedParticle) {
    Deformable cloth = make_cloth({.column_count = 30, .row_count = 30, .pins = {31, 450, 899}});
    for (Vec3f& p : cloth.positions) p = p * 1.4F;
    const Particles before(cloth);
    Particles after = before;
    CoarseSheets(cloth).relax(after);
    for (const std::size_t i : {31u, 450u, 899u}) EXPECT_EQ(after.positions[i], before.positions[i]);
    EXPECT_NE(after.positions[15], before.positions[15]);
}

TEST(CoarseSheets, AreFoundInRowsOfFacesOnly) {
    EXPECT_FALSE(CoarseSheets(make_cloth({.column_count = 2, .row_count = 9})).empty());
    EXPECT_TRUE(CoarseSheets(make_cloth({.column_count = 2, .row_count = 2})).empty());
    EXPECT_TRUE(CoarseSheets(make_cloth(make_torus(1, 0.4, 30, 20), {})).empty());
    Deformable bare = make_cloth({.column_count = 9, .row_count = 9});
    bare.faces.clear();
    EXPECT_TRUE(CoarseSheets(bare).empty());
}

TEST(CoarseSheets, LeadNoFaceIntoAModel) {
    Deformable sheet = sheet_at(0.3, 1.2, 60);
    SimulationOptions options = surfaces_for_kinds(true);
    options.multilevel = true;
    const std::vector<TriangleMesh> models{make_sphere(0.25, 24, 12)};
    Simulation simulation(sheet, colliders_of(models), options);
    expect_nothing_meets(simulation, models, 150);
}

TEST(CoarseSheets, AreRelaxedToTheSameBitsOnAnyNumberOfThreads) {
    SimulationOptions options = hanging(true);
    const Deformable cloth = hanging_sheet(60, 60);
    const std::uint64_t hash = after(20, cloth, options).state_hash();
    options.thread_count = 3;
    EXPECT_EQ(after(20, cloth, options).state_hash(), hash);
    EXPECT_NE(after(20, cloth, hanging(false)).state_hash(), hash);
}

TEST(CoarseSheets, NeedTheVerletSolver) {
    SimulationOptions options = hanging(true);
    options.solver = SolverKind::Xpbd;
    EXPECT_THROW(after(0, hanging_sheet(9, 9), options), Error);
}
