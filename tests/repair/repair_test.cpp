#include "support/expectations.hpp"
#include "support/meshes.hpp"

#include <echinus/mesh.hpp>

#include <gtest/gtest.h>

#include <limits>
#include <random>

using namespace echinus;
using namespace echinus::test;

namespace {

using Faces = std::vector<std::uint32_t>;

void expect_unchanged(const TriangleMesh& mesh, const RepairOptions& options) {
    const RepairedMesh repaired = repair(mesh, options);
    EXPECT_FALSE(repaired.report.changed_anything());
    EXPECT_EQ(repaired.mesh.faces, mesh.faces);
    EXPECT_EQ(repaired.mesh.vertices, mesh.vertices);
}

/// Both outward, one above and one below their common face, which occurs twice: faces 0 and 4.
TriangleMesh glued_tetrahedra() {
    return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}},
            {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}, {0, 1, 2}, {0, 4, 1}, {0, 2, 4}, {1, 4, 2}}};
}

} // namespace

TEST(Repair, ChangesNothingUnlessAskedTo) {
    TriangleMesh mesh = turned_inside_out(cube_with_doubled_top());
    mesh.faces.push_back(mesh.faces[0]);
    expect_unchanged(mesh, {});
}

TEST(Repair, ChangesNothingOfASoundMesh) {
    expect_unchanged(make_torus(1, 0.4, 12, 8), RepairOptions::all());
    expect_unchanged(make_box({1, 2, 3}, 2), RepairOptions::all());
}

TEST(Repair, KeepsTheFirstOfDuplicateFaces) {
    TriangleMesh mesh = make_box({1, 1, 1});
    const TriangleMesh box = mesh;
    const Triangle f = mesh.faces[2];
    mesh.faces.insert(mesh.faces.begin() + 5, {f[2], f[1], f[0]});
    mesh.faces.push_back({f[1], f[2], f[0]});
    const RepairedMesh repaired = repair(mesh, {.drop_duplicate_faces = true});
    EXPECT_EQ(repaired.report.duplicate_faces_dropped, (Faces{5, 13}));
    EXPECT_EQ(repaired.mesh.faces, box.faces);
}

TEST(Repair, DropsBothOfTheOppositeFacesAlongWhichSolidsAreGlued) {
    const RepairedMesh repaired = repair(glued_tetrahedra(), {.drop_duplicate_faces = true});
    EXPECT_TRUE(inspect(glued_tetrahedra()).closed);
    EXPECT_EQ(repaired.report.duplicate_faces_dropped, (Faces{0, 4}));
    EXPECT_EQ(repaired.mesh.faces.size(), 6U);
    EXPECT_TRUE(inspect(repaired.mesh).closed);
    EXPECT_TRUE(inspect(repaired.mesh).manifold);
    EXPECT_NEAR(inspect(repaired.mesh).signed_volume, 1.0 / 3, 1e-15);
}

TEST(Repair, KeepsAFaceThatOverlappingSolidsShare) {
    // Two tetrahedra on the same side of their common face: without one of its copies, one would be open.
    TriangleMesh mesh = glued_tetrahedra();
    mesh.vertices[4] = {0, 0, 2};
    for (std::size_t face = 4; face < 8; ++face) std::swap(mesh.faces[face][1], mesh.faces[face][2]);
    EXPECT_TRUE(inspect(mesh).closed);
    expect_unchanged(mesh, {.drop_duplicate_faces = true});
}

TEST(Repair, MakesOneSolidOfTwoThatCoincide) {
    TriangleMesh mesh = make_box({1, 1, 1});
    const TriangleMesh box = mesh;
    mesh.faces.insert(mesh.faces.end(), box.faces.begin(), box.faces.end());
    EXPECT_EQ(repair(mesh, {.drop_duplicate_faces = true}).mesh.faces, box.faces);
}

TEST(Repair, KeepsTheFirstOfTwoOppositeFacesWhereThatClosesTheMesh) {
    TriangleMesh mesh = make_box({1, 1, 1});
    const TriangleMesh box = mesh;
    mesh.faces.push_back({box.faces[3][1], box.faces[3][0], box.faces[3][2]});
    EXPECT_FALSE(inspect(mesh).closed);
    EXPECT_EQ(repair(mesh, {.drop_duplicate_faces = true}).mesh.faces, box.faces);
}

TEST(Repair, LeavesAMeshOfNothingButOppositeFacesAsItIs) {
    expect_unchanged({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}}, RepairOptions::all());
}

TEST(Repair, DropsTheLaterOfTwoPatchesThatFitEquallyWell) {
    const TriangleMesh mesh = cube_with_doubled_top();
    EXPECT_FALSE(inspect(mesh).closed);
    EXPECT_EQ(inspect(mesh).nonmanifold_edges.count, 4U);
    const RepairedMesh repaired = repair(mesh, {.drop_doubled_patches = true});
    EXPECT_EQ(repaired.report.doubled_patch_faces_dropped, (Faces{12, 13}));
    const MeshReport report = inspect(repaired.mesh);
    EXPECT_TRUE(report.closed);
    EXPECT_TRUE(report.manifold);
    EXPECT_NEAR(report.signed_volume, 1, 1e-15);
}

TEST(Repair, DropsThePatchThatIsTurnedTheWrongWayEvenIfItIsTheFirst) {
    TriangleMesh mesh = cube_with_doubled_top();
    std::swap(mesh.faces[10][0], mesh.faces[10][1]);
    std::swap(mesh.faces[11][0], mesh.faces[11][1]);
    const RepairedMesh whole_patch_turned = repair(mesh, {.drop_doubled_patches = true});
    EXPECT_EQ(whole_patch_turned.report.doubled_patch_faces_dropped, (Faces{10, 11}));
    EXPECT_TRUE(inspect(whole_patch_turned.mesh).closed);

    std::swap(mesh.faces[11][0], mesh.faces[11][1]);
    const RepairedMesh one_face_turned = repair(mesh, {.drop_doubled_patches = true});
    EXPECT_EQ(one_face_turned.report.doubled_patch_faces_dropped, (Faces{10, 11}));
    EXPECT_TRUE(inspect(one_face_turned.mesh).closed);
}

TEST(Repair, LeavesASeparateTetrahedronAlone) {
    // Its faces are also two pairs with the same four corners, but no surface continues around them.
    const TriangleMesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                   {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
    expect_unchanged(tetrahedron, RepairOptions::all());
}

TEST(Repair, KeepsTheCommonSquareOfTouchingSolidsThatDivideItAlongEitherDiagonal) {
    const TriangleMesh cube = make_box({1, 1, 1});
    TriangleMesh mirrored = translated(cube, {1, 0, 0});
    for (Vec3f& p : mirrored.vertices) p.y = -p.y;
    const TriangleMesh mesh = weld(joined({cube, turned_inside_out(mirrored)}));
    ASSERT_TRUE(inspect(mesh).closed);
    ASSERT_EQ(inspect(mesh).nonmanifold_edges.count, 4U);
    ASSERT_EQ(inspect(mesh).duplicate_faces.count, 0U); // the diagonals do differ
    expect_unchanged(mesh, RepairOptions::all());
}

TEST(Repair, TurnsFacesSoThatNeighboursAgree) {
    const TriangleMesh torus = make_torus(1, 0.4, 12, 8);
    TriangleMesh mesh = torus;
    for (std::size_t face = 0; face < mesh.faces.size(); face += 3)
        std::swap(mesh.faces[face][1], mesh.faces[face][2]);
    const RepairedMesh repaired = repair(mesh, {.orient_faces = true});
    EXPECT_EQ(repaired.report.faces_turned, (torus.faces.size() + 2) / 3);
    EXPECT_EQ(repaired.mesh.faces, torus.faces);
}

TEST(Repair, TurnsFacesOutwardsOfWhichHalfAreTurned) {
    TriangleMesh mesh = make_box({1, 1, 1});
    for (std::size_t face = 0; face < mesh.faces.size(); face += 2)
        std::swap(mesh.faces[face][1], mesh.faces[face][2]);
    const MeshReport report = inspect(repair(mesh, RepairOptions::all()).mesh);
    EXPECT_TRUE(report.closed);
    EXPECT_NEAR(report.signed_volume, 1, 1e-15);
}

TEST(Repair, TurnsNoFaceWhereThatNeedsAGuess) {
    TriangleMesh open = make_box({1, 1, 1}, 2);
    std::swap(open.faces[7][0], open.faces[7][1]);
    open.faces.pop_back();
    expect_unchanged(open, {.orient_faces = true});
    TriangleMesh mirrored = translated(make_box({1, 1, 1}), {1, 0, 0});
    for (Vec3f& p : mirrored.vertices) p.y = -p.y;
    TriangleMesh whole = weld(joined({make_box({1, 1, 1}), turned_inside_out(mirrored)}));
    std::swap(whole.faces[0][0], whole.faces[0][1]); // of a block that shares a side with another
    expect_unchanged(whole, {.orient_faces = true});
}

TEST(Repair, TurnsTheFacesOfBlocksThatTouchInEdgesAsOfBlocksThatDoNot) {
    // Four in a ring around a hole, one more across two of their edges, and one apart.
    const TriangleMesh box = make_box({1, 1, 1});
    TriangleMesh whole = box;
    for (const Vec3f& shift :
         {Vec3f{1, 1, 0}, Vec3f{2, 0, 0}, Vec3f{1, -1, 0}, Vec3f{0, 1, 1}, Vec3f{5, 0, 0}})
        whole = joined({whole, translated(box, shift)});
    whole = weld(whole);
    ASSERT_GT(inspect(whole).nonmanifold_edges.count, 4U);
    std::mt19937 random(1);
    for (int turn = 0; turn < 200; ++turn) {
        TriangleMesh mesh = whole;
        for (Triangle& face : mesh.faces)
            if (random() % (2 + turn % 5) == 0) std::swap(face[0], face[1]);
        const MeshReport report = inspect(repair(mesh, RepairOptions::all()).mesh);
        EXPECT_TRUE(report.closed);
        EXPECT_EQ(report.misoriented_edges.count, 0U);
        EXPECT_NEAR(report.signed_volume, 6, 1e-12);
    }
}

TEST(Repair, KeepsACavityWhoseVerticesAllLieOnTheSurfaceAroundIt) {
    // Its edges lie in the top and the bottom of a box, whose faces they divide.
    const Vec3f a{1, 2, 4}, b{3, 2, 4}, c{2, 1, 0}, d{2, 3, 0};
    TriangleMesh mesh{
        {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 0, 4}, {4, 0, 4}, {4, 4, 4}, {0, 4, 4}, a, b, c, d},
        {{0, 1, 5},   {0, 5, 4},  {1, 2, 6},  {1, 6, 5},   {2, 3, 7},  {2, 7, 6},  {3, 0, 4},   {3, 4, 7},
         {4, 5, 8},   {5, 9, 8},  {5, 6, 9},  {6, 7, 9},   {7, 8, 9},  {7, 4, 8},  {1, 0, 10},  {0, 3, 10},
         {3, 11, 10}, {3, 2, 11}, {2, 1, 11}, {1, 10, 11}, {8, 10, 9}, {8, 9, 11}, {8, 11, 10}, {9, 10, 11}}};
    const MeshReport report = inspect(mesh);
    ASSERT_TRUE(report.closed);
    ASSERT_EQ(report.nonmanifold_edges.count, 2U);
    if (report.signed_volume > 64) // the cavity's faces run as those of a solid
        for (std::size_t face = 20; face < 24; ++face) std::swap(mesh.faces[face][1], mesh.faces[face][2]);
    const double volume = 64 - 8.0 / 3;
    ASSERT_NEAR(inspect(mesh).signed_volume, volume, 1e-12);
    expect_unchanged(mesh, RepairOptions::all());
    EXPECT_NEAR(inspect(repair(turned_inside_out(mesh), RepairOptions::all()).mesh).signed_volume, volume,
                1e-12);
}

TEST(Repair, TurnsABlockOutwardsThatTouchesAnotherInAnEdge) {
    const TriangleMesh box = make_box({1, 1, 1});
    const TriangleMesh mesh = weld(joined({box, turned_inside_out(translated(box, {1, 1, 0}))}));
    const RepairedMesh repaired = repair(mesh, RepairOptions::all());
    EXPECT_EQ(repaired.report.components_flipped, 1U);
    EXPECT_NEAR(inspect(repaired.mesh).signed_volume, 2, 1e-12);
}

TEST(Repair, WeldsCornersThatDifferByLessThanMapsResolve) {
    TriangleMesh mesh = make_box({1, 1, 1});
    mesh.vertices.push_back(mesh.vertices[mesh.faces[0][0]] + Vec3f{0, 0, 1e-7F});
    const std::uint32_t before = mesh.faces[0][0];
    mesh.faces[0][0] = 8;
    const RepairedMesh repaired = repair(mesh, RepairOptions::all());
    EXPECT_EQ(repaired.report.vertices_welded, 1U);
    EXPECT_EQ(repaired.mesh.faces[0][0], before);
    EXPECT_EQ(repaired.mesh.vertices, mesh.vertices);
}

TEST(Repair, WeldsWithinTheDistanceThatItIsGiven) {
    TriangleMesh mesh = make_box({1, 1, 1});
    mesh.vertices.push_back(mesh.vertices[mesh.faces[0][0]] + Vec3f{0, 0, 1e-3F});
    mesh.faces[0][0] = 8;
    EXPECT_FALSE(inspect(repair(mesh, RepairOptions::all()).mesh).closed);
    RepairOptions options = RepairOptions::all();
    options.weld_distance = 2e-3;
    EXPECT_TRUE(inspect(repair(mesh, options).mesh).closed);
    for (const double wrong : {-1.0, 2.0, std::numeric_limits<double>::quiet_NaN()})
        expect_error(ErrorCode::InvalidOptions, "weld",
                     [&] { repair(mesh, {.close_seams = true, .weld_distance = wrong}); });
}

TEST(Repair, DropsFacesThatLoseTheirAreaByWelding) {
    TriangleMesh mesh = make_box({1, 1, 1});
    mesh.faces.push_back({0, 8, 9}); // a speck at a corner
    mesh.vertices.push_back(mesh.vertices[0] + Vec3f{1e-7F, 0, 0});
    mesh.vertices.push_back(mesh.vertices[0] + Vec3f{0, 1e-7F, 0});
    const RepairedMesh repaired = repair(mesh, {.close_seams = true});
    EXPECT_EQ(repaired.report.slivers_dropped, (Faces{12}));
    EXPECT_TRUE(inspect(repaired.mesh).closed);
}

TEST(Repair, FillsASeamWhereOnlyOneSideOfAnEdgeIsDivided) {
    TriangleMesh mesh = make_box({1, 1, 1});
    const auto [a, b, c] = mesh.faces[0];
    mesh.vertices.push_back((mesh.vertices[a] + mesh.vertices[b]) * 0.5F);
    mesh.faces[0] = {a, 8, c};
    mesh.faces.push_back({8, b, c});
    ASSERT_EQ(inspect(mesh).border_edges.count, 3U);
    const RepairedMesh repaired = repair(mesh, RepairOptions::all());
    EXPECT_EQ(repaired.report.seams_filled, 1U);
    EXPECT_EQ(repaired.report.faces_added, 1U);
    EXPECT_TRUE(inspect(repaired.mesh).closed);
    EXPECT_TRUE(inspect(repaired.mesh).manifold);
    EXPECT_NEAR(inspect(repaired.mesh).signed_volume, 1, 1e-15);
}

TEST(Repair, FillsNoHoleThatIsWiderThanASeam) {
    TriangleMesh mesh = make_box({1, 1, 1});
    const auto [a, b, c] = mesh.faces[0];
    mesh.vertices.push_back((mesh.vertices[a] + mesh.vertices[b]) * 0.5F + Vec3f{1e-4F, 1e-4F, 1e-4F});
    mesh.faces[0] = {a, 8, c};
    mesh.faces.push_back({8, b, c});
    expect_unchanged(mesh, RepairOptions::all());
}

TEST(Repair, DropsALooseSliverAndKeepsOneThatFillsASeam) {
    TriangleMesh loose = make_box({1, 1, 1});
    loose.vertices.insert(loose.vertices.end(), {{0.1F, 0.2F, 5}, {0.2F, 0.4F, 5}, {0.3F, 0.6F, 5}});
    loose.faces.insert(loose.faces.begin(), Triangle{8, 9, 10});
    const RepairedMesh repaired = repair(loose, RepairOptions::all());
    EXPECT_EQ(repaired.report.slivers_dropped, (Faces{0}));
    EXPECT_TRUE(inspect(repaired.mesh).closed);

    const TriangleMesh filled{{{0, 0, 0}, {2, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}},
                              {{0, 2, 1}, {0, 4, 3}, {4, 1, 3}, {0, 1, 4}, {0, 3, 2}, {1, 2, 3}}};
    expect_unchanged(filled, RepairOptions::all());
}

TEST(Repair, FlipsASolidThatTouchesAnotherInAVertex) {
    const TriangleMesh box = make_box({1, 1, 1});
    const TriangleMesh mesh =
        weld(joined({make_box({2, 2, 2}), turned_inside_out(translated(box, {1.5F, 1.5F, 1.5F}))}));
    ASSERT_EQ(inspect(mesh).component_count, 1U);
    const RepairedMesh repaired = repair(mesh, {.flip_inside_out = true});
    EXPECT_EQ(repaired.report.components_flipped, 1U);
    EXPECT_NEAR(inspect(repaired.mesh).signed_volume, 9, 1e-14);
}

TEST(Repair, LeavesACavityThatTouchesTheSurfaceInAVertex) {
    const TriangleMesh box = make_box({1, 1, 1});
    const TriangleMesh mesh =
        weld(joined({make_box({2, 2, 2}), turned_inside_out(translated(box, {0.5F, 0.5F, 0.5F}))}));
    ASSERT_EQ(inspect(mesh).component_count, 1U);
    expect_unchanged(mesh, RepairOptions::all());
}

TEST(Repair, NumbersFacesAsInTheInputMesh) {
    TriangleMesh mesh = cube_with_doubled_top();
    mesh.faces.insert(mesh.faces.begin() + 1, mesh.faces[0]);
    const RepairedMesh repaired = repair(mesh, RepairOptions::all());
    EXPECT_EQ(repaired.report.duplicate_faces_dropped, (Faces{1}));
    EXPECT_EQ(repaired.report.doubled_patch_faces_dropped, (Faces{13, 14}));
    EXPECT_TRUE(inspect(repaired.mesh).closed);
}

TEST(Repair, FlipsAnInsideOutMesh) {
    const RepairedMesh repaired =
        repair(turned_inside_out(make_torus(1, 0.4, 12, 8)), {.flip_inside_out = true});
    EXPECT_EQ(repaired.report.components_flipped, 1U);
    const MeshReport report = inspect(repaired.mesh);
    EXPECT_TRUE(report.closed);
    EXPECT_GT(report.signed_volume, 0);
}

TEST(Repair, FlipsOnlyTheComponentsThatAreInsideOut) {
    const TriangleMesh box = make_box({1, 1, 1});
    const TriangleMesh mesh =
        joined({joined({box, turned_inside_out(translated(box, {3, 0, 0}))}), translated(box, {6, 0, 0})});
    const RepairedMesh repaired = repair(mesh, {.flip_inside_out = true});
    EXPECT_EQ(repaired.report.components_flipped, 1U);
    EXPECT_NEAR(inspect(repaired.mesh).signed_volume, 3, 1e-14);
    EXPECT_NEAR(winding_number(repaired.mesh, {3, 0, 0}), 1, 1e-12);
}

TEST(Repair, LeavesACavityInsideASolidAsItIs) {
    expect_unchanged(joined({make_box({4, 4, 4}), turned_inside_out(make_sphere(1, 8, 6))}),
                     RepairOptions::all());
}

TEST(Repair, TurnsACavityTogetherWithTheSolidAroundIt) {
    const TriangleMesh hollow = joined({make_box({4, 4, 4}), turned_inside_out(make_sphere(1, 8, 6))});
    const RepairedMesh repaired = repair(turned_inside_out(hollow), {.flip_inside_out = true});
    EXPECT_EQ(repaired.report.components_flipped, 2U);
    EXPECT_NEAR(winding_number(repaired.mesh, {0, 0, 0}), 0, 1e-12);
    EXPECT_NEAR(winding_number(repaired.mesh, {1.5, 1.5, 1.5}), 1, 1e-12);
}

TEST(Repair, DoesNotTurnAnOpenMesh) {
    TriangleMesh mesh = turned_inside_out(make_sphere(1, 8, 6));
    mesh.faces.pop_back();
    expect_unchanged(mesh, RepairOptions::all());
}

TEST(Repair, RefusesAnInvalidMesh) {
    expect_error(ErrorCode::InvalidMesh, "no faces", [] { repair({}, RepairOptions::all()); });
    expect_error(ErrorCode::InvalidMesh, "face 0", [] { repair({{}, {{0, 1, 2}}}, {}); });
}
