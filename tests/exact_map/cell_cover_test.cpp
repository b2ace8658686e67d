#include "directions/face_cone.hpp"
#include "exact_map/build/cell_cover.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <tuple>

using namespace echinus;

namespace {

class RandomLattice {
  public:
    explicit RandomLattice(unsigned seed) : random_(seed) {}
    std::int64_t coordinate(std::int64_t extent) {
        return std::uniform_int_distribution<std::int64_t>(-extent, extent)(random_);
    }
    LatticePoint point(std::int64_t extent) {
        return {coordinate(extent), coordinate(extent), coordinate(extent)};
    }

  private:
    std::mt19937_64 random_;
};

} // namespace

TEST(OctahedralCells, NumberEveryCellAndPartOnce) {
    for (std::uint32_t divisions : {1U, 2U, 3U, 7U}) {
        const OctahedralCells cells(divisions);
        std::set<std::uint32_t> found;
        RandomLattice random(divisions);
        for (int n = 0; n < 200'000; ++n) {
            const LatticePoint p = random.point(kLatticeExtent);
            if (p == LatticePoint{}) continue;
            const auto [cell, part] = cells.locate(p);
            ASSERT_LT(cell, cells.count());
            found.insert(cell * 16 + part);
        }
        EXPECT_EQ(found.size(), 16 * cells.count());
    }
}

TEST(OctahedralCells, LocateDirectionsOnWallsAxesAndCornersWithinRange) {
    for (std::int32_t divisions : {1, 2, 4, 24, 512})
        for (std::int64_t x = -4; x <= 4; ++x)
            for (std::int64_t y = -4; y <= 4; ++y)
                for (std::int64_t z = -4; z <= 4; ++z) {
                    const OctahedralCells cells(static_cast<std::uint32_t>(divisions));
                    for (std::int64_t scale : {1L, 1000L, 131'072L})
                        ASSERT_LT(cells.locate({x * scale, y * scale, z * scale}).cell, cells.count());
                }
}

namespace {

/// Corners that agree modulo 16, so that every mean of 16 of them lies on the lattice.
using Face = std::array<LatticePoint, 3>;

Face random_face(RandomLattice& random, int n) {
    const std::int64_t extent = n % 2 == 0 ? 64 : kLatticeExtent / 256;
    const std::int64_t scale = n % 2 == 0 ? 1024 : 16;
    const LatticePoint middle = random.point(8 * extent);
    Face face;
    for (LatticePoint& corner : face) corner = (middle + random.point(extent)) * scale;
    return face;
}

/// A face whose plane passes the centre within a few steps, as beside a centre that was moved off a face.
Face nearly_edge_on_face(RandomLattice& random) {
    const LatticePoint a = random.point(4), b = random.point(4), offset = random.point(2);
    const auto in_plane = [&] { return a * random.coordinate(1000) + b * random.coordinate(1000); };
    Face face;
    for (LatticePoint& corner : face) corner = in_plane() * 16 + offset;
    return face;
}

/// The cells and parts of every point of a face, even on their walls, are in the face's cover, and the
/// point's L1 norm lies in the cover's range.
void expect_every_point_held(const OctahedralCells& cells, const Face& face) {
    std::vector<CellCover> covers;
    cover_cells(cells, {}, face, covers);
    for (int k = 0; k <= 16; ++k)
        for (int l = 0; l + k <= 16; ++l) {
            // Edges and corners included.
            const LatticePoint sum = face[0] * k + face[1] * l + face[2] * (16 - k - l);
            const LatticePoint p{sum.x / 16, sum.y / 16, sum.z / 16};
            if (p == LatticePoint{}) continue;
            const auto [cell, part] = cells.locate(p);
            const auto t = static_cast<double>(l1_norm(p));
            const bool held = std::any_of(covers.begin(), covers.end(), [&](const CellCover& cover) {
                return cover.cell == cell && (cover.parts >> part & 1) != 0 && cover.nearest <= t + 1e-3 &&
                       t <= cover.farthest + 1e-3;
            });
            ASSERT_TRUE(held) << "cell " << cell << ", t " << t;
        }
}

void expect_ranges_within_reach(const OctahedralCells& cells, const Face& face) {
    std::vector<CellCover> covers;
    cover_cells(cells, {}, face, covers);
    const auto farthest_corner =
        static_cast<double>(std::max({l1_norm(face[0]), l1_norm(face[1]), l1_norm(face[2])}));
    for (const CellCover& cover : covers) {
        ASSERT_LE(0, cover.nearest);
        ASSERT_LE(cover.nearest, cover.farthest) << "cell " << cover.cell;
        ASSERT_LE(cover.farthest, std::max(farthest_corner, 8.0) + 1e-3) << "cell " << cover.cell;
    }
}

} // namespace

// Exactness rests on this property.
TEST(CellCover, HoldsEveryPointOfTheFace) {
    RandomLattice random(7);
    for (int n = 0; n < 400; ++n) {
        const OctahedralCells cells(static_cast<std::uint32_t>(1 + n % 32));
        ASSERT_NO_FATAL_FAILURE(expect_every_point_held(cells, random_face(random, n))) << n;
        ASSERT_NO_FATAL_FAILURE(expect_every_point_held(cells, nearly_edge_on_face(random))) << n;
    }
}

TEST(CellCover, HasRangesThatAscendAndThatTheFaceCanReach) {
    RandomLattice random(11);
    for (int n = 0; n < 2000; ++n) {
        const OctahedralCells cells(static_cast<std::uint32_t>(1 + n % 32));
        ASSERT_NO_FATAL_FAILURE(expect_ranges_within_reach(cells, random_face(random, n))) << n;
        ASSERT_NO_FATAL_FAILURE(expect_ranges_within_reach(cells, nearly_edge_on_face(random))) << n;
    }
}

TEST(CellCover, ListsAFaceOnceInACell) {
    RandomLattice random(8);
    for (int n = 0; n < 300; ++n) {
        // Every third face passes within a few steps of the centre.
        const LatticePoint middle = n % 3 == 0 ? LatticePoint{} : random.point(kLatticeExtent / 4);
        std::array<LatticePoint, 3> face;
        for (LatticePoint& corner : face)
            corner = middle + random.point(n % 2 == 0 ? 20 : kLatticeExtent / 4);
        std::vector<CellCover> covers;
        cover_cells(OctahedralCells(9), {}, face, covers);
        std::set<std::uint32_t> listed;
        for (const CellCover& cover : covers) ASSERT_TRUE(listed.insert(cover.cell).second) << "face " << n;
    }
}

TEST(CellCover, OfAnOctantIsThatPartOfTheWhole) {
    RandomLattice random(10);
    for (int n = 0; n < 300; ++n) {
        const LatticePoint middle = n % 3 == 0 ? LatticePoint{} : random.point(kLatticeExtent / 4);
        std::array<LatticePoint, 3> face;
        for (LatticePoint& corner : face)
            corner = middle + random.point(n % 2 == 0 ? 20 : kLatticeExtent / 4);
        const OctahedralCells cells(5);
        std::vector<CellCover> all, one_by_one;
        cover_cells(cells, {}, face, all);
        for (std::uint32_t octant = 0; octant < 8; ++octant) {
            const std::size_t before = one_by_one.size();
            cover_cells(cells, {octant, octant + 1}, face, one_by_one);
            for (std::size_t i = before; i < one_by_one.size(); ++i)
                ASSERT_EQ(cells.triangle(one_by_one[i].cell).octant, octant);
            const bool met = (octants_met(face) & Octants{octant, octant + 1}.bits()) != 0;
            ASSERT_TRUE(met || one_by_one.size() == before);
        }
        const auto key = [](const CellCover& c) {
            return std::tuple(c.cell, c.parts, c.middle, c.nearest, c.farthest);
        };
        ASSERT_TRUE(std::ranges::equal(all, one_by_one, {}, key, key));
    }
}

TEST(CellCover, DecidesWhetherTheRayThroughTheMiddleMeetsTheFace) {
    RandomLattice random(9);
    int met = 0, unsure = 0, total = 0;
    for (int n = 0; n < 600; ++n) {
        const std::int64_t extent = kLatticeExtent / (n % 2 == 0 ? 4 : 32);
        const LatticePoint middle = random.point(kLatticeExtent / 2);
        std::array<LatticePoint, 3> face;
        for (LatticePoint& corner : face) corner = middle + random.point(extent);
        const FaceCone cone(face[0], face[1], face[2]);
        if (cone.edge_on()) continue;
        const OctahedralCells cells(static_cast<std::uint32_t>(1 + n % 24));
        std::vector<CellCover> covers;
        cover_cells(cells, {}, face, covers);
        std::set<std::uint32_t> said_to_meet;
        for (const CellCover& cover : covers) {
            const bool meets = cone.meets(cells.middle(cover.cell));
            ++total;
            met += meets ? 1 : 0;
            unsure += cover.middle == MiddleRay::Unsure ? 1 : 0;
            if (cover.middle != MiddleRay::Unsure) {
                ASSERT_EQ(cover.middle == MiddleRay::Meets, meets) << n;
            }
            if (meets) said_to_meet.insert(cover.cell);
        }
        for (std::uint32_t cell = 0; cell < cells.count(); ++cell) { // and no cell misses a face that counts
            if (cone.meets(cells.middle(cell))) {
                ASSERT_TRUE(said_to_meet.contains(cell)) << n;
            }
        }
    }
    EXPECT_GT(met, 200);
    EXPECT_LT(unsure, total / 20);
}
