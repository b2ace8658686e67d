#include "support/random_points.hpp"
#include "tetrahedra/stencils.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

using namespace echinus;
using namespace echinus::test;

namespace {

/// A lattice whose vertices are inside or outside by chance, but for its hull, and whose edges are cut by
/// chance, mostly where a vertex is just moved onto the surface, or just not: the worst surface of all.
class RandomLattice {
  public:
    RandomLattice(std::uint32_t seed, float inside_share)
        : random_(seed), lattice_({0, 0, 0}, {kCubes, kCubes, kCubes}, 1), sides_(sides(inside_share)),
          cuts_(
              lattice_, sides_, [this](const Vec3d& a, const Vec3d& b) { return fraction(a, b); }, 1) {
        cuts_.warp(sides_);
        for (BodyLattice::Vertex vertex = 0; vertex < lattice_.vertex_count(); vertex += 2)
            for_each_tetrahedron_at(lattice_.place_of(vertex), [&](const auto& corners) {
                if (!std::all_of(corners.begin(), corners.end(),
                                 [&](const auto& p) { return lattice_.contains(p); }))
                    return;
                add_stencil(lattice_, sides_, cuts_, corners, tetrahedra_);
            });
    }

    const std::vector<StencilTetrahedron>& tetrahedra() const { return tetrahedra_; }
    Vec3d position(const StencilCorner& corner) const {
        return corner.is_cut_point() ? cuts_.position(corner.number())
                                     : cuts_.position_of(lattice_.place_of(corner.number()));
    }

    bool is_on_surface(const StencilCorner& corner) const {
        return corner.is_cut_point() || sides_[corner.number()] == LatticeSide::OnSurface;
    }

  private:
    static constexpr double kCubes = 24;

    LatticeSides sides(float inside_share) {
        LatticeSides sides(lattice_.vertex_count());
        for (BodyLattice::Vertex vertex = 0; vertex < sides.size(); ++vertex) {
            const Vec3d p = lattice_.position(vertex);
            const bool on_hull = std::min({p.x, p.y, p.z}) < 0 || std::max({p.x, p.y, p.z}) > kCubes;
            if (!on_hull && uniform(random_, 0, 1) < inside_share) sides[vertex] = LatticeSide::Inside;
        }
        return sides;
    }

    double fraction(const Vec3d& outside, const Vec3d& inside) {
        const double share = length(inside - outside) > 0.9 ? CutPoints::kLongShare : CutPoints::kShortShare;
        constexpr double kAcross = 1e-6;
        const double low = random_() % 2 == 0 ? share - kAcross : share + kAcross;
        switch (random_() % 8) {
        case 0:
            return static_cast<double>(uniform(random_, 0, 1));
        case 1:
            return 0;
        case 2:
            return 1;
        default:
            return random_() % 2 == 0 ? low : 1 - low;
        }
    }

    Random random_;
    BodyLattice lattice_;
    LatticeSides sides_;
    CutPoints cuts_;
    std::vector<StencilTetrahedron> tetrahedra_;
};

/// By the solid geometry of the normals, unlike inspect().
double angle_deg(const std::array<Vec3d, 4>& p, std::size_t at, std::size_t opposite) {
    std::vector<Vec3d> normals; // of the faces opposite to two corners, outward
    for (const std::size_t corner : {at, opposite}) {
        const Vec3d &a = p[(corner + 1) % 4], &b = p[(corner + 2) % 4], &c = p[(corner + 3) % 4];
        Vec3d normal = cross(b - a, c - a);
        if (dot(normal, p[corner] - a) > 0) normal = -normal;
        normals.push_back(normal * (1 / length(normal)));
    }
    return std::acos(std::clamp(-dot(normals[0], normals[1]), -1.0, 1.0)) * 180 / std::numbers::pi;
}

} // namespace

TEST(Stencils, KeepTheAnglesWhateverTheSurface) {
    double least = 180, greatest = 0;
    for (const float inside_share : {0.1F, 0.3F, 0.5F, 0.7F, 0.9F}) {
        const RandomLattice lattice(static_cast<std::uint32_t>(100 * inside_share), inside_share);
        EXPECT_GT(lattice.tetrahedra().size(), 1'000U);
        for (const StencilTetrahedron& corners : lattice.tetrahedra()) {
            std::array<Vec3d, 4> p;
            for (std::size_t i = 0; i < 4; ++i) p[i] = lattice.position(corners[i]);
            ASSERT_GT(dot(cross(p[1] - p[0], p[2] - p[0]), p[3] - p[0]), 0);
            for (std::size_t i = 0; i < 4; ++i)
                for (std::size_t j = i + 1; j < 4; ++j) {
                    least = std::min(least, angle_deg(p, i, j));
                    greatest = std::max(greatest, angle_deg(p, i, j));
                }
        }
    }
    EXPECT_GT(least, 9.31);
    EXPECT_LT(greatest, 161.65);
    // The bounds are met nearly, so the test meets the worst.
    EXPECT_LT(least, 10);
    EXPECT_GT(greatest, 159);
}

TEST(Stencils, FitTogetherWithoutGaps) {
    const RandomLattice lattice(9, 0.5F);
    // Every face of a tetrahedron has at most two, and where it has two, they run along it oppositely.
    std::map<std::array<std::uint64_t, 3>, std::vector<bool>> uses;
    constexpr std::size_t kFaces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
    for (const StencilTetrahedron& corners : lattice.tetrahedra())
        for (const auto& face : kFaces) {
            std::array<std::uint64_t, 3> key{corners[face[0]].key, corners[face[1]].key,
                                             corners[face[2]].key};
            std::rotate(key.begin(), std::min_element(key.begin(), key.end()), key.end());
            const bool is_turned = key[1] > key[2];
            if (is_turned) std::swap(key[1], key[2]);
            uses[key].push_back(is_turned);
        }
    for (const auto& [face, turned] : uses) {
        ASSERT_LE(turned.size(), 2U);
        if (turned.size() == 2)
            ASSERT_NE(turned[0], turned[1]);
        else // a diagonal that two neighbours drew differently would leave a corner inside
            for (const std::uint64_t key : face) ASSERT_TRUE(lattice.is_on_surface({key}));
    }
    EXPECT_GT(uses.size(), 100'000U);
}
