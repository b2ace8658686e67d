#include "support/expectations.hpp"
#include "support/meshes.hpp"
#include "support/random_points.hpp"
#include "support/soft_bodies.hpp"
#include "tetrahedra/body_lattice.hpp"
#include "tetrahedra/mend.hpp"

#include <echinus/exact_map.hpp>
#include <echinus/intersections.hpp>
#include <echinus/tetrahedra.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <vector>

using namespace echinus;
using namespace echinus::test;

namespace {

/// The bounds, and a twentieth of a degree for the rounding of vertices to float.
constexpr double kLeastAngle = 9.25, kGreatestAngle = 161.75;

Tetrahedralization tetrahedralize_mesh(const TriangleMesh& mesh, TetrahedralizeOptions options) {
    const ExactMap map = ExactMap::build(mesh);
    return tetrahedralize(map, options);
}

/// Positive tetrahedra whose volumes add up to what their boundary encloses, and a boundary that does not
/// intersect itself: so they overlap nowhere.
TetrahedralReport expect_good_body(const TetrahedralMesh& mesh) {
    const TetrahedralReport report = inspect_tetrahedra(mesh); // throws unless all are positive
    EXPECT_EQ(report.vertex_count, mesh.vertices.size());
    EXPECT_GT(report.least_volume, 0);
    EXPECT_GE(report.least_angle_deg, kLeastAngle);
    EXPECT_LE(report.greatest_angle_deg, kGreatestAngle);
    EXPECT_TRUE(report.boundary.closed);
    EXPECT_TRUE(report.boundary.manifold);
    EXPECT_NEAR(report.boundary.signed_volume, report.volume, 1e-9 * report.volume);
    EXPECT_TRUE(self_intersecting_pairs(boundary(mesh)).empty());
    return report;
}

TriangleMesh two_spheres() {
    return joined({make_sphere(1, 40, 20), translated(make_sphere(0.8, 30, 15), {1.1F, 0.2F, 0.1F})});
}

} // namespace

TEST(Tetrahedralize, FillsASphereATorusABoxAPlateAndSpheresThatOverlap) {
    const TriangleMesh models[] = {make_sphere(1, 60, 30), make_torus(1, 0.4, 60, 24),
                                   make_box({1, 2, 0.7}, 2), make_box({2, 2, 0.2}, 4), two_spheres()};
    for (const TriangleMesh& model : models)
        for (const double size : {0.23, 0.12, 0.061}) {
            SCOPED_TRACE(size);
            expect_good_body(tetrahedralize_mesh(model, {.size = size}).mesh);
        }
}

TEST(Tetrahedralize, FillsABoxAsMuchWhenPlanesThroughItsCentreCutItIntoParts) {
    for (const std::size_t count : {500U, 4000U}) {
        const TetrahedralizeOptions options{.count = count};
        const double whole =
            inspect_tetrahedra(tetrahedralize_mesh(make_box({2, 2, 2}), options).mesh).volume;
        for (const TriangleMesh& model : {make_two_wedges(), make_four_wedges()})
            EXPECT_NEAR(expect_good_body(tetrahedralize_mesh(model, options).mesh).volume, whole, 1e-3);
    }
}

TEST(Tetrahedralize, MeetsTheAnglesWhateverTheSurface) {
    // Features finer than the lattice: nearly every pattern of sides and every place of a cut occurs.
    Random random(5);
    TriangleMesh crowd;
    for (int i = 0; i < 150; ++i) {
        const double radius = uniform(random, 0.02F, 0.2F);
        crowd = joined({crowd, translated(make_sphere(radius, 7, 5), in_cube(random, 1))});
    }
    std::size_t removed = 0;
    for (const double size : {0.3, 0.17, 0.1, 0.06}) {
        SCOPED_TRACE(size);
        const Tetrahedralization body = tetrahedralize_mesh(crowd, {.size = size});
        expect_good_body(body.mesh);
        removed += body.removed_tetrahedra;
    }
    EXPECT_GT(removed, 0U) << "the test has no place where parts meet in a vertex";
}

TEST(Tetrahedralize, FillsOpenSurfacesByTheirWindingNumber) {
    for (const double size : {0.2, 0.1})
        expect_good_body(tetrahedralize_mesh(exploded(make_sphere(1, 24, 12), 0.9F), {.size = size}).mesh);
}

TEST(Tetrahedralize, PutsTheBoundaryOnTheModel) {
    const TriangleMesh model = make_torus(1, 0.4, 60, 24);
    const double size = 0.15;
    const Tetrahedralization body = tetrahedralize_mesh(model, {.size = size});
    ASSERT_EQ(body.removed_tetrahedra, 0U);
    EXPECT_EQ(body.size, size);
    const TriangleMesh surface = boundary(body.mesh);
    for (const Triangle& face : surface.faces)
        for (const std::uint32_t vertex : face)
            ASSERT_LT(unsigned_distance(model, Vec3d(surface.vertices[vertex])), 1e-5);
}

TEST(Tetrahedralize, ConvergesToTheVolumeOfASphere) {
    const TriangleMesh model = make_sphere(1, 400, 200);
    const ExactMap map = ExactMap::build(model);
    const double volume = inspect(model).signed_volume;
    double last_error = 1;
    for (const double size : {0.4, 0.2, 0.1}) {
        const double error =
            std::abs(inspect_tetrahedra(tetrahedralize(map, {.size = size}).mesh).volume - volume) / volume;
        EXPECT_LT(error, last_error / 3) << size; // chords: a quarter at half the size
        last_error = error;
    }
    EXPECT_LT(last_error, 0.005);
}

TEST(Tetrahedralize, MeetsACount) {
    const ExactMap map = ExactMap::build(two_spheres());
    for (const std::size_t count : {500U, 5'000U, 50'000U}) {
        const Tetrahedralization body = tetrahedralize(map, {.count = count});
        EXPECT_NEAR(static_cast<double>(body.mesh.tetrahedra.size()), static_cast<double>(count),
                    0.05 * count);
        EXPECT_EQ(tetrahedralize(map, {.size = body.size}).mesh.tetrahedra, body.mesh.tetrahedra);
    }
}

TEST(Tetrahedralize, PrefersTooManyTetrahedraToNone) {
    const ExactMap map = ExactMap::build(make_sphere(1, 40, 20));
    for (const std::size_t count : {1U, 5U})
        EXPECT_LT(tetrahedralize(map, {.count = count}).mesh.tetrahedra.size(), 200U) << count;
}

TEST(Tetrahedralize, GivesTheSameBytesForAnyNumberOfThreads) {
    const ExactMap map = ExactMap::build(two_spheres());
    const TetrahedralMesh one = tetrahedralize(map, {.size = 0.07, .thread_count = 1}).mesh;
    for (const unsigned thread_count : {2U, 3U, 7U}) {
        const TetrahedralMesh other = tetrahedralize(map, {.size = 0.07, .thread_count = thread_count}).mesh;
        EXPECT_EQ(other.vertices, one.vertices);
        EXPECT_EQ(other.tetrahedra, one.tetrahedra);
    }
}

TEST(Tetrahedralize, DoesNotMindFarPlacesAndSmallSizes) {
    for (const float scale : {1e-6F, 1e6F}) {
        TriangleMesh model = make_torus(1, 0.4, 20, 12);
        for (Vec3f& vertex : model.vertices) vertex = (vertex + Vec3f{30, -20, 10}) * scale;
        expect_good_body(tetrahedralize_mesh(model, {.size = 0.2 * double{scale}}).mesh);
    }
}

TEST(Tetrahedralize, ReportsProgressUpToTheEnd) {
    const ExactMap map = ExactMap::build(make_sphere(1, 20, 10));
    std::vector<double> shares;
    tetrahedralize(map, {.size = 0.1, .progress = [&](double share) { shares.push_back(share); }});
    ASSERT_FALSE(shares.empty());
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
    EXPECT_EQ(shares.back(), 1);
}

TEST(Tetrahedralize, RefusesWhatItCannotDo) {
    const ExactMap map = ExactMap::build(make_sphere(1, 20, 10));
    const auto expect_refused = [&](const std::string& words, const TetrahedralizeOptions& options) {
        expect_error(ErrorCode::InvalidOptions, words, [&] { tetrahedralize(map, options); });
    };
    expect_refused("either the size", {});
    expect_refused("either the size", {.size = 1, .count = 1});
    expect_refused("finite and positive", {.size = -1});
    expect_refused("finite and positive", {.size = std::nan("")});
    expect_refused("more tetrahedra than the limit of 1000", {.size = 0.1, .most_tetrahedra = 1000});
    expect_refused("2000 tetrahedra are more than the limit", {.count = 2000, .most_tetrahedra = 1000});
    expect_refused("too small for coordinates of up to 1", {.size = 1e-4});
    expect_refused("vertices, more than the limit", {.size = 0.001});
    expect_error(ErrorCode::InvalidMesh, "choose a smaller size", [] {
        tetrahedralize_mesh(make_box({2, 2, 0.001}), {.size = 0.33});
    });
}

TEST(Tetrahedralize, RefusesACountForAPlateThatHasElementsOnlyByTheMillions) {
    expect_error(ErrorCode::InvalidMesh, "at which about 500 tetrahedra fit into the model", [] {
        tetrahedralize_mesh(make_box({2, 2, 0.001}), {.count = 500});
    });
}

namespace {

constexpr double kSize = 0.5;

BodyLattice lattice() {
    return {{-1, 0, 2}, {1, 1.3, 2.6}, kSize};
}

} // namespace

TEST(BodyLattice, NumbersItsPlacesWithoutGaps) {
    const BodyLattice bcc = lattice();
    for (BodyLattice::Vertex vertex = 0; vertex < bcc.vertex_count(); ++vertex) {
        const BodyLattice::Place place = bcc.place_of(vertex);
        ASSERT_TRUE(bcc.contains(place));
        ASSERT_EQ(bcc.vertex_at(place), vertex);
        ASSERT_TRUE(place.x % 2 == place.y % 2 && place.y % 2 == place.z % 2);
    }
    EXPECT_EQ(static_cast<double>(bcc.vertex_count()),
              BodyLattice::vertex_count_around({-1, 0, 2}, {1, 1.3, 2.6}, kSize));
}

TEST(BodyLattice, HasItsHullOutsideOfTheBox) {
    const BodyLattice bcc = lattice();
    const auto is_in_box = [](const Vec3d& p, double margin) {
        return p.x > -1 - margin && p.x < 1 + margin && p.y > -margin && p.y < 1.3 + margin &&
               p.z > 2 - margin && p.z < 2.6 + margin;
    };
    for (BodyLattice::Vertex vertex = 0; vertex < bcc.vertex_count(); ++vertex) {
        const BodyLattice::Place place = bcc.place_of(vertex);
        bool is_hull = false; // some neighbour is missing
        for (const BodyLattice::Place& edge : kEdges)
            is_hull = is_hull || !bcc.contains(place + edge) || !bcc.contains(place - edge);
        if (is_hull) ASSERT_FALSE(is_in_box(bcc.position(vertex), kSize / 2 - 1e-9));
    }
}

TEST(BodyLattice, FillsSpaceWithEqualPositiveTetrahedra) {
    const BodyLattice bcc = lattice();
    double volume = 0;
    std::set<std::array<BodyLattice::Vertex, 4>> seen;
    // Around one corner of cubes far from the hull: its share is one cube.
    const BodyLattice::Place corner = bcc.place_of(bcc.vertex_at({6, 4, 4}));
    for_each_tetrahedron_at(corner, [&](const std::array<BodyLattice::Place, 4>& places) {
        const Vec3d a = bcc.position(places[0]);
        const auto way_to = [&](std::size_t i) { return bcc.position(places[i]) - a; };
        const double one = dot(cross(way_to(1), way_to(2)), way_to(3)) / 6;
        EXPECT_NEAR(one, kSize * kSize * kSize / 12, 1e-12);
        EXPECT_NEAR(length(way_to(1)), kSize, 1e-12);
        EXPECT_NEAR(length(bcc.position(places[3]) - bcc.position(places[2])), kSize, 1e-12);
        volume += one;
        std::array<BodyLattice::Vertex, 4> numbers{};
        for (std::size_t i = 0; i < 4; ++i) numbers[i] = bcc.vertex_at(places[i]);
        std::sort(numbers.begin(), numbers.end());
        EXPECT_TRUE(seen.insert(numbers).second);
    });
    EXPECT_EQ(seen.size(), 12U);
    EXPECT_NEAR(volume, kSize * kSize * kSize, 1e-12);
}

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

TEST(MendTetrahedra, TurnsNegativeOnesOnly) {
    TetrahedralMesh body = make_brick(2);
    std::swap(body.tetrahedra[3][0], body.tetrahedra[3][2]);
    std::swap(body.tetrahedra[8][1], body.tetrahedra[8][3]);
    EXPECT_ANY_THROW(require_valid_tetrahedra(body));
    EXPECT_EQ(turn_negative(body), 2U);
    EXPECT_NO_THROW(require_valid_tetrahedra(body));
    EXPECT_EQ(turn_negative(body), 0U);
    EXPECT_EQ(body.tetrahedra[0], make_brick(2).tetrahedra[0]);
}

TEST(MendTetrahedra, DropsVerticesThatNothingUses) {
    TetrahedralMesh body = make_brick(2);
    std::erase_if(body.tetrahedra, [&](const Tetrahedron& corners) { // all that reach beyond x = 1
        return std::any_of(corners.begin(), corners.end(), [&](auto v) { return body.vertices[v].x > 1; });
    });
    const MeshReport before = inspect(boundary(body));
    EXPECT_EQ(drop_unused_vertices(body), 9U);
    EXPECT_EQ(body.vertices.size(), 18U);
    EXPECT_NO_THROW(require_valid_tetrahedra(body));
    EXPECT_EQ(inspect(boundary(body)).signed_volume, before.signed_volume);
    EXPECT_EQ(before.signed_volume, 4);
}

namespace {

bool is_manifold(const TetrahedralMesh& mesh) {
    return inspect(boundary(mesh)).manifold;
}

/// The brick without the cubes for which `is_gone` holds.
template <typename IsGone>
TetrahedralMesh brick_without(std::uint32_t count, IsGone&& is_gone) {
    TetrahedralMesh brick = make_brick(count), left{brick.vertices, {}};
    for (std::uint32_t number = 0; number < brick.tetrahedra.size(); ++number) {
        const std::uint32_t cube = number / 6;
        if (!is_gone(cube % count, cube / count % count, cube / count / count))
            left.tetrahedra.push_back(brick.tetrahedra[number]);
    }
    return left;
}

} // namespace

TEST(RemovePinches, LeavesAManifoldBodyAlone) {
    TetrahedralMesh brick = make_brick(3);
    EXPECT_EQ(remove_pinches(brick), 0U);
    EXPECT_EQ(brick.tetrahedra, make_brick(3).tetrahedra);
}

TEST(RemovePinches, PartsCubesThatMeetInAnEdge) {
    TetrahedralMesh body = brick_without(2, [](auto x, auto y, auto) { return x != y; });
    ASSERT_FALSE(is_manifold(body));
    const std::size_t before = body.tetrahedra.size();
    const std::size_t removed = remove_pinches(body);
    EXPECT_TRUE(is_manifold(body));
    EXPECT_EQ(body.tetrahedra.size(), before - removed);
    EXPECT_GE(body.tetrahedra.size(), before / 2); // the larger part stays whole
}

TEST(RemovePinches, PartsCubesThatMeetInACorner) {
    TetrahedralMesh body = brick_without(2, [](auto x, auto y, auto z) { return x != y || y != z; });
    ASSERT_FALSE(is_manifold(body));
    EXPECT_GT(remove_pinches(body), 0U);
    EXPECT_TRUE(is_manifold(body));
    EXPECT_GE(body.tetrahedra.size(), 6U);
}

TEST(RemovePinches, OpensHollowsThatMeetInACorner) {
    TetrahedralMesh body = brick_without(4, [](auto x, auto y, auto z) {
        return (x == 1 && y == 1 && z == 1) || (x == 2 && y == 2 && z == 2);
    });
    ASSERT_FALSE(is_manifold(body));
    EXPECT_GT(remove_pinches(body), 0U);
    EXPECT_TRUE(is_manifold(body));
    EXPECT_GT(body.tetrahedra.size(), 62U * 6 - 40);
}
