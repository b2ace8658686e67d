#include "render/tone.hpp"

#include <gtest/gtest.h>

using namespace echinus;

TEST(Tone, EveryByteSurvivesTheWayToLinearLightAndBack) {
    for (int byte = 0; byte < 256; ++byte) {
        const float value = static_cast<float>(byte) / 255;
        const auto back = to_srgb8(to_linear({value, value, value}));
        EXPECT_EQ(back[0], byte);
        EXPECT_EQ(back[2], byte);
    }
}

TEST(Tone, ClampsWhatNoScreenCanShow) {
    const auto bytes = to_srgb8({-1, 7, 0.5F});
    EXPECT_EQ(bytes[0], 0);
    EXPECT_EQ(bytes[1], 255);
    EXPECT_EQ(bytes[2], 188); // IEC 61966-2-1: 0.5 is shown as 0.7354
}

TEST(Tone, LeavesTheColoursOfThePaletteAlone) {
    for (const Colour& colour : palette::kLayers) {
        EXPECT_EQ(compress_highlights(to_linear(colour)), to_linear(colour));
    }
}

TEST(Tone, BendsHighlightsSmoothlyAndNeverReachesWhite) {
    float last = 0;
    for (float light = 0.01F; light < 50; light *= 1.01F) {
        const float shown = compress_highlights({light, light, light}).x;
        EXPECT_GT(shown, last);
        EXPECT_LT(shown, 1);
        EXPECT_LE(shown, light * 1.0001F);
        last = shown;
    }
}
