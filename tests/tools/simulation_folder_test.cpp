#include "recording/simulation_folder.hpp"
#include "support/expectations.hpp"
#include "support/temporary_folder.hpp"

#include <echinus/error.hpp>
#include <echinus/mesh_io.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <random>

using namespace echinus;
namespace fs = std::filesystem;

namespace {

constexpr std::uint32_t kSide = 4; // the cloth is kSide x kSide points
constexpr std::size_t kPointCount = kSide * kSide;

TriangleMesh square_cloth() {
    TriangleMesh cloth;
    for (std::size_t i = 0; i < kPointCount; ++i) {
        cloth.vertices.push_back({static_cast<float>(i % kSide), static_cast<float>(i / kSide), 0});
    }
    for (std::uint32_t j = 0; j + 1 < kSide; ++j) {
        for (std::uint32_t i = 0; i + 1 < kSide; ++i) {
            const std::uint32_t corner = j * kSide + i;
            cloth.faces.push_back({corner, corner + 1, corner + kSide + 1});
            cloth.faces.push_back({corner, corner + kSide + 1, corner + kSide});
        }
    }
    return cloth;
}

/// A cloth that falls as a whole for half of the samples and is stretched in the other half.
std::vector<Vec3f> positions_at(std::size_t sample, std::size_t sample_count) {
    std::vector<Vec3f> points = square_cloth().vertices;
    const std::size_t half = sample_count / 2;
    const float fallen = 0.2F * static_cast<float>(std::min(sample, half));
    const float stretch = 1 + 0.1F * static_cast<float>(sample > half ? sample - half : 0);
    for (Vec3f& point : points) point = {point.x * stretch, point.y, point.z - fallen};
    return points;
}

template <typename T>
void append_bytes(std::string& bytes, const T& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

std::string cache_bytes(std::int32_t sample_count, float start_frame = 0, float frames_per_sample = 1) {
    std::string bytes("POINTCACHE2\0", 12);
    append_bytes(bytes, std::int32_t{1});
    append_bytes(bytes, static_cast<std::int32_t>(kPointCount));
    append_bytes(bytes, start_frame);
    append_bytes(bytes, frames_per_sample);
    append_bytes(bytes, sample_count);
    for (std::int32_t sample = 0; sample < sample_count; ++sample) {
        for (const Vec3f& point :
             positions_at(static_cast<std::size_t>(sample), static_cast<std::size_t>(sample_count)))
            append_bytes(bytes, point);
    }
    return bytes;
}

constexpr const char* kReport = R"({
    "gravity": [0, -9.81, 0], "frames": 9, "frames_to_rest": 9,
    "collider": {"mesh": "collider.obj", "poses": [
        {"frame": 0, "translation": [0, 0, 0], "rotation": [1, 0, 0, 0]},
        {"frame": 4, "translation": [10, 0, 0], "rotation": [0, 0, 0, 1]}]}})";

class SimulationFolderTest : public test::TemporaryFolderTest {
  protected:
    void SetUp() override {
        TemporaryFolderTest::SetUp();
        write_mesh(path("cloth.obj"), square_cloth());
        write_mesh(path("collider.obj"), make_box({2, 2, 2}));
        write("cloth.pc2", cache_bytes(10));
        write("report.json", kReport);
    }

    fs::path folder() const { return path(""); }

    /// Opens the folder and reads all of it.
    void read_everything() const {
        const SimulationFolder simulation(folder());
        for (std::size_t sample = 0; sample < simulation.sample_count(); ++sample) {
            simulation.cloth(sample);
            simulation.colliders(sample);
        }
    }
    void expect_error(ErrorCode code, const std::string& words) const {
        test::expect_error(code, words, [this] { read_everything(); });
        test::expect_error(code, folder().string(), [this] { read_everything(); });
    }
    static std::string replaced(std::string text, const std::string& old_part, const std::string& new_part) {
        return text.replace(text.find(old_part), old_part.size(), new_part);
    }
};

} // namespace

TEST_F(SimulationFolderTest, GivesTheClothOfEverySampleWithTheFacesOfItsRestMesh) {
    const SimulationFolder simulation(folder());
    ASSERT_EQ(simulation.sample_count(), 10U);
    for (std::size_t sample = 0; sample < 10; ++sample) {
        const TriangleMesh cloth = simulation.cloth(sample).mesh;
        EXPECT_EQ(cloth.vertices, positions_at(sample, 10));
        EXPECT_EQ(cloth.faces, square_cloth().faces);
    }
}

TEST_F(SimulationFolderTest, PosesTheColliderAsItStoodLast) {
    const SimulationFolder simulation(folder());
    const TriangleMesh box = make_box({2, 2, 2});
    EXPECT_EQ(simulation.colliders(0).vertices, box.vertices);
    EXPECT_EQ(simulation.colliders(3).vertices, box.vertices);
    for (std::size_t sample : {4U, 9U}) {
        const TriangleMesh moved = simulation.colliders(sample); // half a turn about z, then along x
        for (std::size_t v = 0; v < box.vertices.size(); ++v) {
            const Vec3f& point = box.vertices[v];
            EXPECT_NEAR(length(moved.vertices[v] - Vec3f{10 - point.x, -point.y, point.z}), 0, 1e-6);
        }
    }
}

TEST_F(SimulationFolderTest, TakesUpFromGravity) {
    EXPECT_GT(SimulationFolder(folder()).up().y, 0);
    write("report.json", replaced(kReport, "-9.81", "0"));
    EXPECT_EQ(SimulationFolder(folder()).up(), (Vec3d{0, 0, 1}));
}

TEST_F(SimulationFolderTest, KnowsWhetherTheClothCameToRest) {
    EXPECT_EQ(SimulationFolder(folder()).rest_frame(), 9);
    write("report.json", replaced(kReport, "\"frames_to_rest\": 9", "\"frames_to_rest\": null"));
    EXPECT_FALSE(SimulationFolder(folder()).rest_frame());
}

TEST_F(SimulationFolderTest, FindsTheSampleOfAFrame) {
    write("cloth.pc2", cache_bytes(10, 20, 5));
    const SimulationFolder simulation(folder());
    EXPECT_EQ(simulation.sample_at(20), 0U);
    EXPECT_EQ(simulation.sample_at(65), 9U);
    EXPECT_EQ(simulation.sample_at(31), 2U);
    EXPECT_EQ(simulation.frame_of(2), 30);
    EXPECT_THROW(simulation.sample_at(17), Error);
    EXPECT_THROW(simulation.sample_at(68), Error);
    EXPECT_THROW(simulation.sample_at(std::numeric_limits<std::int64_t>::min()), Error);
    EXPECT_THROW(simulation.sample_at(std::numeric_limits<std::int64_t>::max()), Error);
}

TEST_F(SimulationFolderTest, RefusesACacheCutShortAtAnyByte) {
    const std::string whole = cache_bytes(2);
    for (std::size_t size = 0; size < whole.size(); ++size) {
        write("cloth.pc2", whole.substr(0, size));
        EXPECT_THROW(read_everything(), Error) << size << " bytes";
    }
    write("cloth.pc2", whole + '\0');
    expect_error(ErrorCode::Damaged, "bytes");
}

TEST_F(SimulationFolderTest, SurvivesAnyHeader) {
    std::mt19937 random(11);
    const std::string whole = cache_bytes(2);
    for (int round = 0; round < 500; ++round) {
        std::string bytes = whole;
        for (int change = 0; change < 3; ++change) bytes[random() % 32] = static_cast<char>(random() % 256);
        if (bytes == whole) continue;
        write("cloth.pc2", bytes);
        try {
            read_everything(); // some changes, as of the start frame, are harmless
        } catch (const Error&) {
        }
    }
}

TEST_F(SimulationFolderTest, SaysWhatIsWrongWithACache) {
    const auto with = [](std::size_t offset, auto value) {
        std::string bytes = cache_bytes(3);
        std::memcpy(bytes.data() + offset, &value, sizeof(value));
        return bytes;
    };
    write("cloth.pc2", with(0, 'p'));
    expect_error(ErrorCode::WrongFormat, "POINTCACHE2");
    write("cloth.pc2", with(12, std::int32_t{2}));
    expect_error(ErrorCode::UnsupportedVersion, "version 2");
    write("cloth.pc2", with(16, std::int32_t{-1}));
    expect_error(ErrorCode::Damaged, "-1 points");
    write("cloth.pc2", with(16, std::numeric_limits<std::int32_t>::max()));
    expect_error(ErrorCode::Damaged, "bytes");
    write("cloth.pc2", with(28, std::int32_t{0}));
    expect_error(ErrorCode::Damaged, "0 samples");
    write("cloth.pc2", with(24, std::numeric_limits<float>::quiet_NaN()));
    expect_error(ErrorCode::Damaged, "frames per sample");
    write("cloth.pc2", with(32 + 12 * (kPointCount + 3) + 4, std::numeric_limits<float>::infinity()));
    expect_error(ErrorCode::Damaged, "point 3 of sample 1");
}

TEST_F(SimulationFolderTest, SaysWhatIsWrongWithAReport) {
    const auto wrong = [&](const std::string& old_part, const std::string& new_part,
                           const std::string& words) {
        write("report.json", replaced(kReport, old_part, new_part));
        expect_error(ErrorCode::Damaged, words);
    };
    wrong("{", "", "JSON");
    wrong("\"gravity\"", "\"gravty\"", "gravity");
    wrong("-9.81, 0]", "-9.81]", "gravity");
    wrong("-9.81", "\"down\"", "gravity");
    wrong("\"frames_to_rest\": 9", "\"frames_to_rest\": \"soon\"", "frames_to_rest");
    wrong("\"collider.obj\"", "7", "mesh");
    wrong("\"collider.obj\"", "\"collider.obj\", \"faces\": 11", "12 faces, which differs from");
    wrong("[0, 0, 0, 1]", "[0, 0, 0, 0]", "rotation");
    wrong("[0, 0, 0, 1]", "[0, 0, 1]", "rotation");
    wrong("\"frame\": 4", "\"frame\": 0", "ascend");
    wrong("\"translation\": [10, 0, 0]", "\"translation\": 10", "translation");
    write(
        "report.json",
        R"({"gravity": [0,0,-1], "frames_to_rest": null, "collider": {"mesh": "collider.obj", "poses": []}})");
    expect_error(ErrorCode::Damaged, "poses");
}

TEST_F(SimulationFolderTest, SaysWhichFileIsMissing) {
    for (const char* name : {"cloth.pc2", "cloth.obj", "collider.obj", "report.json"}) {
        const fs::path aside = path("aside");
        fs::rename(path(name), aside);
        expect_error(ErrorCode::Unreadable, name);
        fs::rename(aside, path(name));
    }
}

TEST_F(SimulationFolderTest, RefusesARestMeshOfAnotherCloth) {
    TriangleMesh other = square_cloth();
    other.faces.resize(2);
    write_mesh(path("cloth.obj"), other);
    expect_error(ErrorCode::Damaged, "vertices");
}

TEST_F(SimulationFolderTest, ChoosesMomentsThatDiffer) {
    write("cloth.pc2", cache_bytes(40));
    const std::vector<std::size_t> moments = choose_moments(SimulationFolder(folder()), 6);
    ASSERT_EQ(moments.size(), 6U);
    EXPECT_EQ(moments.front(), 0U);
    EXPECT_EQ(moments.back(), 39U);
    EXPECT_TRUE(std::is_sorted(moments.begin(), moments.end()));
    EXPECT_EQ(std::adjacent_find(moments.begin(), moments.end()), moments.end());
    // For 20 samples the cloth only falls, which changes little: that is worth one moment after the first.
    EXPECT_LE(std::count_if(moments.begin(), moments.end(), [](std::size_t sample) { return sample < 20; }),
              2);
}

TEST_F(SimulationFolderTest, SpendsNoMomentsOnAClothThatOnlyTrembles) {
    // It changes in the first tenth of the time and trembles for the rest.
    std::string bytes = cache_bytes(100);
    std::vector<Vec3f> points = square_cloth().vertices;
    for (std::size_t sample = 0; sample < 100; ++sample) {
        std::vector<Vec3f> moved = points;
        const float stretch = 1 + 0.2F * static_cast<float>(std::min<std::size_t>(sample, 10)) +
                              (sample % 2 == 0 ? 0.02F : 0.0F);
        for (Vec3f& point : moved) point.x *= stretch;
        std::memcpy(bytes.data() + 32 + sample * sizeof(Vec3f) * kPointCount, moved.data(),
                    sizeof(Vec3f) * kPointCount);
    }
    write("cloth.pc2", bytes);
    const std::vector<std::size_t> moments = choose_moments(SimulationFolder(folder()), 6);
    ASSERT_EQ(moments.size(), 6U);
    EXPECT_LE(moments[4], 10U);
    EXPECT_EQ(moments[5], 99U);
}

TEST_F(SimulationFolderTest, ChoosesAllMomentsWhereThereAreFew) {
    for (std::int32_t count = 1; count <= 6; ++count) {
        write("cloth.pc2", cache_bytes(count));
        const std::vector<std::size_t> moments = choose_moments(SimulationFolder(folder()), 6);
        ASSERT_EQ(moments.size(), static_cast<std::size_t>(count));
        for (std::size_t i = 0; i < moments.size(); ++i) EXPECT_EQ(moments[i], i);
    }
}
