// The judge of intersections agrees with CGAL's exact predicates.

#include "judges/check_cloth.hpp"
#include "judges/exact_judge.hpp"
#include "judges/nasty_meshes.hpp"
#include "mesh_io/point_cache.hpp"
#include "support/expectations.hpp"
#include "support/meshes.hpp"
#include "support/temporary_folder.hpp"

#include <echinus/mesh_io.hpp>

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cmath>
#include <cstdlib>

using namespace echinus;
using namespace echinus::test;

namespace {

using FloatCorners = std::array<Vec3f, 3>;

/// A point of a triangle or near it: where floats can hold it on an edge or in the plane, else rounded.
Vec3f point_of(Random& random, const FloatCorners& t) {
    const double u = std::uniform_int_distribution<int>(-2, 10)(random) / 8.0;
    const double v = std::uniform_int_distribution<int>(-2, 10)(random) / 8.0;
    const Vec3d a(t[0]);
    return Vec3f(a + u * (Vec3d(t[1]) - a) + v * (Vec3d(t[2]) - a));
}

/// Moved by at most one step of the floats along each axis.
Vec3f nudged(Random& random, const Vec3f& p) {
    const auto nudge = [&](float x) {
        const float towards[] = {-1e30F, x, 1e30F};
        return std::nextafter(x, towards[std::uniform_int_distribution<int>(0, 2)(random)]);
    };
    const float x = nudge(p.x), y = nudge(p.y);
    return {x, y, nudge(p.z)};
}

/// A mesh whose vertices all moved by up to `size` in every direction.
TriangleMesh crumpled(TriangleMesh mesh, Random& random, float size) {
    for (Vec3f& vertex : mesh.vertices) vertex += in_cube(random, size);
    return mesh;
}

} // namespace

TEST(IntersectionsOracle, TrianglesOfWholeNumbersMeetAsCgalSays) {
    Random random(1);
    for (const int half_width : {1, 2, 4, 1000}) {
        for (int i = 0; i < 20'000; ++i) {
            FloatCorners a, b;
            for (Vec3f& p : a) p = whole_point(random, half_width);
            for (Vec3f& p : b) p = whole_point(random, half_width);
            ASSERT_EQ(triangles_intersect(a, b), triangles_intersect_by_cgal(a, b))
                << i << ", " << half_width;
        }
    }
}

TEST(IntersectionsOracle, TrianglesThatNearlyTouchMeetAsCgalSays) {
    Random random(2);
    int meeting = 0;
    constexpr int kCount = 40'000;
    for (int i = 0; i < kCount; ++i) {
        FloatCorners a{in_cube(random, 1), in_cube(random, 1), in_cube(random, 1)};
        if (i % 8 == 0) a[2] = point_of(random, {a[0], a[1], a[1]}); // a sliver, up to rounding
        FloatCorners b{nudged(random, point_of(random, a)), in_cube(random, 1), in_cube(random, 1)};
        if (i % 2 == 0) b[1] = nudged(random, point_of(random, a));
        if (i % 4 == 0) b[2] = nudged(random, point_of(random, a));
        const bool expected = triangles_intersect_by_cgal(a, b);
        ASSERT_EQ(triangles_intersect(a, b), expected) << i;
        meeting += expected;
    }
    EXPECT_GT(meeting, kCount / 5);
    EXPECT_LT(meeting, kCount * 4 / 5);
}

TEST(IntersectionsOracle, PairsOfTwoMeshesAreThoseOfCgal) {
    Random random(3);
    for (const auto& [name, mesh] : generated_meshes())
        for (const auto& [other_name, other] : generated_meshes())
            for (const float size : {0.0F, 0.05F}) {
                const TriangleMesh moved = crumpled(other, random, size);
                ASSERT_EQ(intersecting_pairs(mesh, moved), intersecting_pairs_by_cgal(mesh, moved))
                    << name << " and " << other_name << ", " << size;
            }
}

TEST(IntersectionsOracle, PairsOfAMeshWithItselfAreThoseOfCgal) {
    Random random(4);
    std::size_t found = 0;
    for (const auto& [name, mesh] : generated_meshes())
        for (const float size : {0.0F, 0.01F, 0.2F}) {
            const TriangleMesh moved = crumpled(mesh, random, size);
            const auto pairs = self_intersecting_pairs(moved);
            ASSERT_EQ(pairs, self_intersecting_pairs_by_cgal(moved)) << name << ", " << size;
            found += pairs.size();
        }
    EXPECT_GT(found, 1000U);
    for (int i = 0; i < 200; ++i) {
        const TriangleMesh mesh = random_soup(random, 10, 20, i % 4 + 1);
        ASSERT_EQ(self_intersecting_pairs(mesh), self_intersecting_pairs_by_cgal(mesh)) << i;
    }
}

namespace {

/// A box under a square of cloth, which sinks by 0.1 a frame from 0.25 above, so that it enters in frame 3;
/// in frame 2 one corner is folded over flat. From frame 5 on the box stands elsewhere.
class CheckClothTest : public TemporaryFolderTest {
  protected:
    void SetUp() override {
        TemporaryFolderTest::SetUp();
        TriangleMesh cloth{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {1, 3, 2}}};
        write_mesh(path("cloth.obj"), cloth);
        write_mesh(path("collider.obj"), make_box({4, 4, 1}));
        PointCacheWriter cache(path("cloth.pc2"), 4, 1);
        for (int frame = 0; frame < 8; ++frame) {
            std::vector<Vec3f> positions = cloth.vertices;
            if (frame == 2) positions[3] = {0.25F, 0.25F, 0};
            for (Vec3f& p : positions) p.z += 0.75F - 0.1F * static_cast<float>(frame);
            cache.add(positions);
        }
        cache.commit();
        write("report.json", R"({"gravity": [0, 0, -9.81], "frames_to_rest": null,
            "collider": {"mesh": "collider.obj", "poses": [
                {"frame": 0, "translation": [0, 0, 0], "rotation": [1, 0, 0, 0]},
                {"frame": 5, "translation": [9, 0, 0], "rotation": [1, 0, 0, 0]}]}})");
    }

    /// The exit status of echinus-check.
    int status(const std::string& arguments) const {
        const std::string command = std::string("\"") + ECHINUS_CHECK_PROGRAM + "\" " + arguments + " > \"" +
                                    path("out").string() + "\" 2>&1";
        return WEXITSTATUS(std::system(command.c_str()));
    }
};

} // namespace

TEST_F(CheckClothTest, CountsPairsInEveryFrameWithTheModelWhereItStood) {
    const ClothCheckResult result = check_cloth(path(""));
    EXPECT_EQ(result.cloth_face_count, 2U);
    EXPECT_EQ(result.model_face_count, 12U);
    ASSERT_EQ(result.frames.size(), 8U);
    for (std::size_t frame = 0; frame < 8; ++frame) {
        EXPECT_EQ(result.frames[frame].frame, double(frame));
        // In frame 3 the cloth passes z = 0.5 - 0.05 within the box, whose sides it does not reach.
        EXPECT_EQ(result.frames[frame].model_pairs, 0U) << frame;
        EXPECT_EQ(result.frames[frame].own_pairs, frame == 2 ? 1U : 0U) << frame;
    }
    EXPECT_FALSE(result.holds());
}

TEST_F(CheckClothTest, FindsTheFramesInWhichTheClothCutsTheModel) {
    write_mesh(path("collider.obj"), make_box({1, 1, 1})); // its sides pass through the cloth
    const ClothCheckResult result = check_cloth(path(""));
    for (std::size_t frame = 0; frame < 8; ++frame)
        EXPECT_EQ(result.frames[frame].model_pairs != 0, frame == 3 || frame == 4) << frame;
    EXPECT_EQ(result.frames[3].first_model_pair->a, 0U);
    EXPECT_NE(to_text(result).find("Faces INTERSECT in 3 frames"), std::string::npos) << to_text(result);
    EXPECT_NE(to_json(result).find("\"frames_with_pairs\": 3"), std::string::npos);
}

TEST_F(CheckClothTest, CountsNoFacesThatTheModelLetsThrough) {
    write_mesh(path("collider.obj"), make_box({1, 1, 1}));
    const auto with_runs = [&](const std::string& runs) {
        write("report.json", R"({"gravity": [0, 0, -9.81], "frames_to_rest": null, "colliders": [{
            "mesh": "collider.obj", "lets_through": )" +
                                 runs + R"(, "poses": [
                {"frame": 0, "translation": [0, 0, 0], "rotation": [1, 0, 0, 0]}]}]})");
    };
    with_runs("[[3, 3]]"); // of the second face
    const ClothCheckResult of_one = check_cloth(path(""));
    EXPECT_GT(of_one.frames[3].model_pairs, 0U);
    EXPECT_EQ(of_one.frames[3].first_model_pair->a, 0U);
    with_runs("[[0, 1], [3, 3]]");
    const ClothCheckResult of_none = check_cloth(path(""));
    for (const JudgedFrame& frame : of_none.frames) EXPECT_EQ(frame.model_pairs, 0U) << frame.frame;
    for (const char* runs : {"[[2, 4]]", "[[3, 1]]", "[3]", "[[-1, 2]]", "[]", "[[0.5, 1]]"}) {
        with_runs(runs);
        expect_error(ErrorCode::Damaged, "lets_through", [&] { check_cloth(path("")); });
    }
}

TEST_F(CheckClothTest, JudgesEverySoManyFramesAndTheLast) {
    const ClothCheckResult result = check_cloth(path(""), {.stride = 3});
    ASSERT_EQ(result.frames.size(), 4U);
    EXPECT_EQ(result.frames[1].frame, 3);
    EXPECT_EQ(result.frames[3].frame, 7);
    EXPECT_TRUE(result.holds());
    EXPECT_NE(to_text(result).find("No faces intersect."), std::string::npos);
}

TEST_F(CheckClothTest, TheProgramFailsWhereFacesIntersectAndWhereThereIsNoRecording) {
    const std::string folder = "--cloth \"" + path("").string() + "\"";
    EXPECT_EQ(status(folder), 1);
    EXPECT_EQ(status(folder + " --json"), 1);
    EXPECT_EQ(status(folder + " --every 3"), 0);
    EXPECT_EQ(status("--cloth \"" + path("nothing").string() + "\""), 1);
    EXPECT_EQ(status(folder + " --every 0"), 2);
    EXPECT_EQ(status(folder + " --generate torus"), 2);
}
