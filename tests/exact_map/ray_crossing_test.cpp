#include "exact_map/query/ray_crossing.hpp"

#include <gtest/gtest.h>

#include <random>

using namespace echinus;

namespace {

/// Faces and particles of all sizes, on a lattice coarse enough that many are degenerate.
class RandomCase {
  public:
    explicit RandomCase(unsigned seed) : random_(seed) {}

    LatticePoint point() {
        const std::int64_t unit = std::int64_t{1} << std::uniform_int_distribution<int>(0, 17)(random_);
        const std::int64_t extent = kLatticeExtent / unit;
        std::uniform_int_distribution<std::int64_t> coordinate(-std::min<std::int64_t>(extent, 4),
                                                               std::min<std::int64_t>(extent, 4));
        return LatticePoint{coordinate(random_), coordinate(random_), coordinate(random_)} * unit;
    }
    std::array<LatticePoint, 3> face() {
        std::array<LatticePoint, 3> corners{point(), point(), point()};
        if (std::uniform_int_distribution<int>(0, 1)(random_) == 1)
            for (LatticePoint& corner : corners) corner += fine_shift();
        return corners;
    }
    /// Often on the plane, on an edge's line or at a corner of the face.
    LatticePoint particle(const std::array<LatticePoint, 3>& face) {
        switch (std::uniform_int_distribution<int>(0, 3)(random_)) {
        case 0:
            return face[0];
        case 1:
            return clamped(face[0] + face[1] - face[2]);
        case 2:
            return {(face[0].x + face[1].x) / 2, (face[0].y + face[1].y) / 2, (face[0].z + face[1].z) / 2};
        default:
            return point();
        }
    }

  private:
    LatticePoint fine_shift() {
        std::uniform_int_distribution<std::int64_t> step(-3, 3);
        return {step(random_), step(random_), step(random_)};
    }
    static LatticePoint clamped(const LatticePoint& p) {
        const auto clamp = [](std::int64_t c) { return std::clamp(c, -kLatticeExtent, kLatticeExtent); };
        return {clamp(p.x), clamp(p.y), clamp(p.z)};
    }

    std::mt19937_64 random_;
};

std::array<std::int32_t, 3> stored(const LatticePoint& p) {
    return {static_cast<std::int32_t>(p.x), static_cast<std::int32_t>(p.y), static_cast<std::int32_t>(p.z)};
}

} // namespace

TEST(CrossingFilter, IsRightWhereverItIsSure) {
    RandomCase random(1);
    int sure_count = 0;
    constexpr int kCount = 400'000;
    for (int n = 0; n < kCount; ++n) {
        std::array<LatticePoint, 3> face = random.face();
        for (LatticePoint& corner : face)
            corner = {std::clamp(corner.x, -kLatticeExtent, kLatticeExtent),
                      std::clamp(corner.y, -kLatticeExtent, kLatticeExtent),
                      std::clamp(corner.z, -kLatticeExtent, kLatticeExtent)};
        const LatticePoint p = random.particle(face);
        const auto a = stored(face[0]), b = stored(face[1]), c = stored(face[2]);
        const CrossingFilter filter(p);
        for (RaySide side : {RaySide::Before, RaySide::Beyond}) {
            const auto [crossing, sure] = filter(side, a.data(), b.data(), c.data());
            if (!sure) continue;
            ++sure_count;
            ASSERT_EQ(crossing, crossing_on(side, face, p)) << "case " << n;
        }
    }
    EXPECT_GT(sure_count, kCount / 4) << "the filter is there to decide most cases";
}

TEST(CrossingFilter, IsNearlyAlwaysSureOfFacesInGeneralPosition) {
    std::mt19937_64 random(2);
    std::uniform_int_distribution<std::int64_t> coordinate(-kLatticeExtent, kLatticeExtent);
    const auto point = [&] {
        return LatticePoint{coordinate(random), coordinate(random), coordinate(random)};
    };
    int unsure = 0;
    for (int n = 0; n < 100'000; ++n) {
        const auto a = stored(point()), b = stored(point()), c = stored(point());
        unsure += CrossingFilter(point())(RaySide::Beyond, a.data(), b.data(), c.data()).sure ? 0 : 1;
    }
    EXPECT_LE(unsure, 1);
}

// Any ray and segment crosses a closed surface equally often inwards and outwards, even through vertices and
// along edges and faces.
TEST(ExactCrossings, OfAClosedSurfaceAddUp) {
    RandomCase random(3);
    for (int n = 0; n < 50'000; ++n) {
        const LatticePoint corners[] = {random.point(), random.point(), random.point(), random.point()};
        const std::array<std::array<int, 3>, 4> faces{{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
        const LatticePoint from = random.point(), to = random.point();
        int before = 0, beyond = 0, crossed = 0;
        for (const auto& [i, j, k] : faces) {
            const std::array<LatticePoint, 3> face{corners[i], corners[j], corners[k]};
            before += crossing_on(RaySide::Before, face, from);
            beyond += crossing_on(RaySide::Beyond, face, from);
            if (const auto crossing = crossing_with_face(face, from, to))
                crossed += crossing->entering() ? 1 : -1;
        }
        int winding_to = 0;
        for (const auto& [i, j, k] : faces)
            winding_to += crossing_on(RaySide::Beyond, {corners[i], corners[j], corners[k]}, to);
        // The origin must not lie on a face; then every ray gives the same winding number.
        bool on_face = false;
        for (const auto& [i, j, k] : faces)
            on_face = on_face || dot(corners[i], cross(corners[j], corners[k])) == 0;
        if (on_face) continue;
        ASSERT_LE(std::abs(before + beyond), 1) << "case " << n;
        ASSERT_LE(std::abs(beyond), 1) << "case " << n;
        ASSERT_EQ(beyond + crossed, winding_to) << "case " << n;
    }
}
