#include "exact_map/build/split_faces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

using namespace echinus;

namespace {

/// @param extent  number of places along each axis
std::vector<TreeItem> random_items(std::size_t count, const std::array<std::uint32_t, 3>& extent,
                                   unsigned seed) {
    std::mt19937 random(seed);
    std::vector<TreeItem> items(count);
    for (std::uint32_t face = 0; face < count; ++face) {
        items[face].face = face;
        for (std::size_t axis = 0; axis < 3; ++axis) items[face].place[axis] = random() % extent[axis];
    }
    return items;
}

std::vector<std::uint32_t> sorted_faces(std::span<const TreeItem> items) {
    std::vector<std::uint32_t> faces;
    for (const TreeItem& item : items) faces.push_back(item.face);
    std::sort(faces.begin(), faces.end());
    return faces;
}

/// The faces of the left half, found by sorting all of them.
std::vector<std::uint32_t> left_by_sorting(std::vector<TreeItem> items, std::size_t left_count,
                                           std::size_t axis) {
    std::sort(items.begin(), items.end(), [axis](const TreeItem& a, const TreeItem& b) {
        return a.place[axis] != b.place[axis] ? a.place[axis] < b.place[axis] : a.face < b.face;
    });
    return sorted_faces(std::span(items).first(left_count));
}

} // namespace

TEST(SplitFaces, PutsTheSmallestAlongTheLongestSideFirst) {
    for (std::size_t count : {2U, 9U, 24U, 25U, 100U, 300U, 5000U})
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (std::uint32_t extent : {1U, 3U, 1'000'000U}) { // with many ties, and with hardly any
                std::array<std::uint32_t, 3> extents{1, 1, 1};
                extents[axis] = extent;
                std::vector<TreeItem> items = random_items(count, extents, static_cast<unsigned>(count));
                const std::size_t expected_axis = extent == 1 ? 0 : axis; // the first of equal sides
                for (std::size_t left_count : {std::size_t{1}, count / 2, count - 1}) {
                    const std::vector<std::uint32_t> expected =
                        left_by_sorting(items, left_count, expected_axis);
                    split_at_longest_side(items, left_count);
                    EXPECT_EQ(sorted_faces(std::span(items).first(left_count)), expected);
                }
            }
}

TEST(SplitFaces, MendsASplitThatIsNearlyRight) {
    std::vector<TreeItem> items = random_items(3000, {1'000'000, 10, 10}, 1);
    split_at_longest_side(items, 1400);
    std::mt19937 random(2);
    for (TreeItem& item : items) item.place[0] += random() % 20'000;
    const std::vector<std::uint32_t> expected = left_by_sorting(items, 1400, 0);
    split_at_longest_side(items, 1400);
    EXPECT_EQ(sorted_faces(std::span(items).first(1400)), expected);
}

TEST(SplitFaces, SortByNumber) {
    for (std::size_t count : {1U, 2U, 7U, 8U, 20U}) {
        std::vector<TreeItem> items = random_items(count, {9, 9, 9}, 3);
        std::shuffle(items.begin(), items.end(), std::mt19937(4));
        sort_by_face(items);
        for (std::uint32_t i = 0; i < count; ++i) EXPECT_EQ(items[i].face, i);
    }
}
