#include "render/light.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

using namespace echinus;

TEST(SampleTables, PutOneOfSixteenSamplesIntoEveryBoxOfEverySixteenth) {
    const SampleTables tables(16);
    for (std::uint32_t pixel = 0; pixel < 300; ++pixel) {
        const std::uint32_t seed = SampleTables::pixel_seed(pixel % 20, pixel / 20);
        for (SampleUse use : {SampleUse::Pixel, SampleUse::Lamp, SampleUse::Sky}) {
            for (int columns = 1; columns <= 16; columns *= 2) {
                std::vector<int> visits(16);
                for (std::uint32_t i = 0; i < 16; ++i) {
                    const Sample2 sample = tables.sample(i, use, seed);
                    const int column = static_cast<int>(sample[0] * static_cast<float>(columns));
                    const int row = static_cast<int>(sample[1] * (16.0F / static_cast<float>(columns)));
                    ++visits.at(static_cast<std::size_t>(row * columns + column));
                }
                for (int count : visits) ASSERT_EQ(count, 1);
            }
        }
    }
}

TEST(SampleTables, DrawOtherSamplesForNeighboursAndForOtherUses) {
    const SampleTables tables(8);
    const std::uint32_t seed = SampleTables::pixel_seed(5, 6);
    EXPECT_NE(tables.sample(0, SampleUse::Sky, seed),
              tables.sample(0, SampleUse::Sky, SampleTables::pixel_seed(6, 5)));
    EXPECT_NE(tables.sample(0, SampleUse::Sky, seed), tables.sample(0, SampleUse::Lamp, seed));
}

TEST(SampleTables, StayBelowOneForAnyCount) {
    const SampleTables tables(37);
    for (std::uint32_t i = 0; i < 37; ++i) {
        for (float part : tables.sample(i, SampleUse::Pixel, i * 7919)) {
            EXPECT_GE(part, 0);
            EXPECT_LT(part, 1);
        }
    }
}

namespace {

Camera some_camera() {
    return camera_for(std::vector<Vec3f>{{-1, -1, -1}, {1, 1, 1}}, View{}, 1);
}

} // namespace

TEST(StudioLight, ComesFromAboveTheCamerasLeftShoulder) {
    const Camera camera = some_camera();
    const StudioLight light(camera);
    for (const Sample2& sample : {Sample2{0, 0}, Sample2{0.5F, 0.5F}, Sample2{0.99F, 0.2F}}) {
        const Vec3d direction(light.lamp_direction(sample));
        EXPECT_LT(dot(direction, camera.right), 0);
        EXPECT_GT(dot(direction, camera.world_up), 0);
        EXPECT_LT(dot(direction, camera.forward), 0);
    }
}

TEST(StudioLight, IsBrighterFromTheSkyThanFromTheFloor) {
    const StudioLight light(some_camera());
    EXPECT_GT(light.ambient_radiance(light.up()).y, light.ambient_radiance(-light.up()).y);
    EXPECT_EQ(light.lamp_irradiance(-light.up()), Vec3f{});
}

TEST(CosineDirection, IsUnitAndFollowsTheCosine) {
    // Under a density of cos / pi the mean of the cosine over the hemisphere is 2/3, of its square 1/2.
    for (const Vec3f& normal : {Vec3f{0, 0, 1}, Vec3f{0, 0, -1}, Vec3f{0.6F, 0, 0.8F}, Vec3f{0, -1, 0}}) {
        double sum = 0;
        double sum_of_squares = 0;
        constexpr int kSide = 64;
        for (int i = 0; i < kSide * kSide; ++i) {
            const Sample2 sample{(static_cast<float>(i % kSide) + 0.5F) / kSide,
                                 (static_cast<float>(i / kSide) + 0.5F) / kSide};
            const Vec3f direction = cosine_direction(normal, sample);
            ASSERT_NEAR(length(direction), 1, 1e-5);
            const double cosine = dot(direction, normal);
            ASSERT_GE(cosine, -1e-6);
            sum += cosine;
            sum_of_squares += cosine * cosine;
        }
        EXPECT_NEAR(sum / (kSide * kSide), 2.0 / 3, 2e-3);
        EXPECT_NEAR(sum_of_squares / (kSide * kSide), 0.5, 2e-3);
    }
}
