#include <echinus/geometry.hpp>

#include <gtest/gtest.h>

#include <vector>

using namespace echinus;

TEST(StridedSpan, WalksPositionsInsideAVertexStruct) {
    struct Vertex {
        float weight;
        Vec3f position;
        int colour;
    };
    const std::vector<Vertex> vertices{{0.5F, {1, 2, 3}, 7}, {0.25F, {4, 5, 6}, 8}};
    const StridedSpan<const Vec3f> positions(&vertices[0].position, vertices.size(), sizeof(Vertex));
    ASSERT_EQ(positions.size(), 2u);
    EXPECT_EQ(positions[1], (Vec3f{4, 5, 6}));
}

TEST(StridedSpan, ConvertsFromAVector) {
    std::vector<Vec3f> points{{1, 0, 0}, {2, 0, 0}};
    StridedSpan<const Vec3f> read = points;
    StridedSpan<Vec3f> write = points;
    write[1].x = 9;
    EXPECT_EQ(read[1].x, 9);
}
