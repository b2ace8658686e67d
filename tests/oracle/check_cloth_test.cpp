#include "judges/check_cloth.hpp"
#include "mesh_io/point_cache.hpp"
#include "support/expectations.hpp"
#include "support/temporary_folder.hpp"

#include <echinus/mesh_io.hpp>

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>

using namespace echinus;
using namespace echinus::test;

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
