#include <echinus/map_file.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>

using namespace echinus;
namespace fs = std::filesystem;

// Files of every version of the format, kept forever: all later releases read what one release wrote.
//
// Distance maps are of a box of 2 x 3 x 4 around the origin with 8 x 6 directions on a sphere or an
// ellipsoid, 9 x 9 on an octahedron or 6 x 5 x 5 on a cube, exact maps of the same box, of that box without
// its last face, and of a torus, with 8 cells each; that of the torus has all indices in 32 bits. Those of
// version 2 are of the box moved far away.

namespace {

const Vec3d kBoxSize{2, 3, 4};

struct Golden {
    const char* file;
    DistanceMapOptions options;
};

const Golden kGoldenFloat32{"v1_box_float32.ech",
                            {.longitude_count = 8,
                             .colatitude_count = 6,
                             .correction = VertexCorrection::None,
                             .entry_format = EntryFormat::Float32,
                             .pole_axis = PoleAxis::Z}};
const Golden kGoldenUnorm16{"v1_box_unorm16.ech",
                            {.longitude_count = 8,
                             .colatitude_count = 6,
                             .correction = VertexCorrection::Signed,
                             .entry_format = EntryFormat::Unorm16,
                             .pole_axis = PoleAxis::X}};

const Golden kGoldenOctahedral{"v1_box_octahedral.ech",
                               {.grid = DirectionGrid::Octahedral,
                                .divisions = 4,
                                .correction = VertexCorrection::None,
                                .entry_format = EntryFormat::Float32}};

const Golden kGoldenCube{"v1_box_cube.ech",
                         {.grid = DirectionGrid::Cube,
                          .divisions = 4,
                          .correction = VertexCorrection::None,
                          .entry_format = EntryFormat::Float32}};

const Golden kGoldenEllipsoidal{"v1_box_ellipsoidal.ech",
                                {.grid = DirectionGrid::Ellipsoidal,
                                 .longitude_count = 8,
                                 .colatitude_count = 6,
                                 .correction = VertexCorrection::None,
                                 .entry_format = EntryFormat::Float32}};

const char* const kGoldenExact = "v1_box_exact.ech";
const char* const kGoldenExactOpen = "v1_open_box_exact.ech"; ///< its gaps reach to the half
const char* const kGoldenExactOpenMargin = "v1_open_box_exact_margin.ech";
const char* const kGoldenExactWide = "v1_torus_exact_wide.ech";

const char* const kGoldenFarExact = "v2_far_box_exact.ech";
const char* const kGoldenFarFloat32 = "v2_far_box_float32.ech";
const Vec3d kFarAway{448262, 5411932, 112};

TriangleMesh far_box() {
    TriangleMesh box = make_box(kBoxSize);
    box.origin = kFarAway;
    return box;
}

fs::path path_of(const char* file) {
    return fs::path(ECHINUS_GOLDEN_FOLDER) / file;
}

TriangleMesh open_box() {
    TriangleMesh box = make_box(kBoxSize);
    box.faces.pop_back();
    return box;
}

std::vector<std::byte> bytes_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    const std::string content{std::istreambuf_iterator<char>(file), {}};
    const auto* first = reinterpret_cast<const std::byte*>(content.data());
    return {first, first + content.size()};
}

/// The distance from the centre of the box to its surface along sample (i, j), by the slabs of the box; the
/// poles lie on z.
double box_distance(const Vec3d& size, std::uint32_t i, std::uint32_t j) {
    const double phi = 2 * std::numbers::pi * i / 8;
    const double theta = std::numbers::pi * (j + 0.5) / 6;
    const Vec3d d{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
    return std::min({size.x / 2 / std::fabs(d.x), size.y / 2 / std::fabs(d.y), size.z / 2 / std::fabs(d.z)});
}

void expect_options(const DistanceMapView& view, const DistanceMapOptions& options) {
    EXPECT_EQ(view.longitude_count, options.longitude_count);
    EXPECT_EQ(view.colatitude_count, options.colatitude_count);
    EXPECT_EQ(view.correction, options.correction);
    EXPECT_EQ(view.entry_format, options.entry_format);
    EXPECT_EQ(view.pole_axis, options.pole_axis);
}

void expect_box(const DistanceMap& map) {
    const DistanceMapView& view = map.view();
    EXPECT_LT(length(view.centre), 1e-5F);
    EXPECT_NEAR(view.radius, std::sqrt(29.0) / 2, 1e-5);
    EXPECT_TRUE(view.centre_inside);
    EXPECT_EQ(view.entry_count(), 48u);
    EXPECT_EQ(map.statistics().face_count, 12u);
    EXPECT_EQ(map.statistics().max_entries, 1u);
    EXPECT_EQ(map.statistics().wrong_parity_share, 0);
}

/// A failure leaves the new bytes in the build folder: if the change is intended, they become the next golden
/// file, beside the old ones.
void expect_same_bytes(const std::vector<std::byte>& actual, const char* file) {
    if (actual == bytes_of(path_of(file))) return;
    const fs::path copy = fs::current_path() / file;
    std::ofstream(copy, std::ios::binary)
        .write(reinterpret_cast<const char*>(actual.data()), static_cast<std::streamsize>(actual.size()));
    ADD_FAILURE() << file << " is written otherwise today; see " << copy;
}

} // namespace

TEST(GoldenMapFile, OfVersion1WithFloatsHoldsTheBox) {
    const DistanceMap map = load_distance_map(path_of(kGoldenFloat32.file));
    expect_options(map, kGoldenFloat32.options);
    expect_box(map);
    for (std::uint32_t j = 0; j < 6; ++j) {
        for (std::uint32_t i = 0; i < 8; ++i) {
            EXPECT_NEAR(map.view().entries_float32[j * 8 + i], box_distance(kBoxSize, i, j), 1e-5);
        }
    }
}

TEST(GoldenMapFile, OfVersion1With16BitsHoldsTheBoxOrMore) {
    const DistanceMap map = load_distance_map(path_of(kGoldenUnorm16.file));
    expect_options(map, kGoldenUnorm16.options);
    expect_box(map);
    // Poles on x: the grid's x, y, z are the mesh's y, z, x. The correction only pushes outwards here.
    const Vec3d size_in_grid{kBoxSize.y, kBoxSize.z, kBoxSize.x};
    for (std::uint32_t j = 0; j < 6; ++j) {
        for (std::uint32_t i = 0; i < 8; ++i) {
            const double entry = map.view().entries_unorm16[j * 8 + i] / 65535.0 * map.view().radius;
            EXPECT_GE(entry, box_distance(size_in_grid, i, j) - 5e-5);
        }
    }
    EXPECT_GT(map.statistics().corrected_entries, 0u);
}

TEST(GoldenMapFile, OfVersion1WithAnOctahedralGridHoldsTheBox) {
    const DistanceMap map = load_distance_map(path_of(kGoldenOctahedral.file));
    EXPECT_EQ(map.view().grid, DirectionGrid::Octahedral);
    EXPECT_EQ(map.view().divisions, 4u);
    EXPECT_EQ(map.view().entry_count(), 81u);
    EXPECT_TRUE(map.view().centre_inside);
    // Column i and row j of the upper side: along (i - 4, j - 4, the rest of 4).
    for (int j = 4; j <= 8; ++j) {
        for (int i = 4; i + j <= 12; ++i) {
            const Vec3d d = Vec3d{i - 4.0, j - 4.0, 12.0 - i - j} * 0.25;
            const double l1_radius = std::min({1 / d.x, 1.5 / d.y, 2 / d.z});
            const auto index = static_cast<std::size_t>(j * 9 + i);
            EXPECT_NEAR(map.view().entries_float32[index], l1_radius, 1e-5);
        }
    }
    EXPECT_TRUE(contains(map, {0.99F, 0.1F, 0.1F}));
    EXPECT_FALSE(contains(map, {1.01F, 0.1F, 0.1F}));
}

TEST(GoldenMapFile, OfVersion1WithACubeHoldsTheBox) {
    const DistanceMap map = load_distance_map(path_of(kGoldenCube.file));
    EXPECT_EQ(map.view().grid, DirectionGrid::Cube);
    EXPECT_EQ(map.view().divisions, 4u);
    EXPECT_EQ(map.view().entry_count(), 150u);
    EXPECT_TRUE(map.view().centre_inside);
    // Column i and row j of the side towards -y: along (q, -1, p).
    for (int j = 0; j <= 4; ++j) {
        for (int i = 0; i <= 4; ++i) {
            const double p = std::tan(std::numbers::pi / 4 * (i / 2.0 - 1));
            const double q = std::tan(std::numbers::pi / 4 * (j / 2.0 - 1));
            const double per_length = std::min({1 / std::fabs(q), 1.5, 2 / std::fabs(p)});
            const auto index = static_cast<std::size_t>((3 * 5 + j) * 5 + i);
            EXPECT_NEAR(map.view().entries_float32[index], per_length * std::sqrt(1 + p * p + q * q), 1e-5);
        }
    }
}

TEST(GoldenMapFile, OfVersion1WithAnEllipsoidalGridHoldsTheBox) {
    const DistanceMap map = load_distance_map(path_of(kGoldenEllipsoidal.file));
    expect_options(map, kGoldenEllipsoidal.options);
    expect_box(map);
    EXPECT_EQ(map.view().grid, DirectionGrid::Ellipsoidal);
    EXPECT_EQ(map.view().scale.x, 1);
    EXPECT_NEAR(map.view().scale.y, 2.0 / 3, 1e-5);
    EXPECT_NEAR(map.view().scale.z, 2.0 / 4, 1e-5);
    // In the scaled frame the box is a cube with the edge 2.
    for (std::uint32_t j = 0; j < 6; ++j)
        for (std::uint32_t i = 0; i < 8; ++i)
            EXPECT_NEAR(map.view().entries_float32[j * 8 + i], box_distance({2, 2, 2}, i, j), 1e-5);
}

TEST(GoldenMapFile, OfVersion1WithAnExactMapHoldsTheBox) {
    const ExactMap map = load_exact_map(path_of(kGoldenExact));
    EXPECT_NEAR(map.view().radius, std::sqrt(29.0) / 2, 1e-5);
    EXPECT_EQ(map.statistics().face_count, 12u);
    EXPECT_EQ(map.statistics().certain_share, 1);
    EXPECT_TRUE(contains(map, {0.99F, 1.49F, -1.99F}));
    EXPECT_FALSE(contains(map, {1.01F, 0, 0}));
    EXPECT_NEAR(contact(map, {0.75F, 0, 0}).depth, 0.25, 1e-5);
}

TEST(GoldenMapFile, OfVersion1WithAnExactMapOfAnOpenMeshMarksWhatIsComputed) {
    for (const char* const file : {kGoldenExactOpen, kGoldenExactOpenMargin}) {
        const ExactMap map = load_exact_map(path_of(file));
        EXPECT_EQ(map.view().rule, InsideRule::Parity);
        EXPECT_EQ(map.view().border.size(), 3u);
        EXPECT_LT(map.statistics().certain_share, 1);
        EXPECT_TRUE(classify(map, {0, 0, 0}).inside);
        EXPECT_FALSE(classify(map, {0, 0, 0}).computed);
        EXPECT_TRUE(classify(map, {0, 0, 0}).certain);
        EXPECT_TRUE(classify(map, {0.9F, 1.4F, 1.9F}).computed);
    }
}

TEST(GoldenMapFile, OfVersion1WithAnExactMapInWideIndicesHoldsTheTorus) {
    const ExactMap map = load_exact_map(path_of(kGoldenExactWide));
    EXPECT_FALSE(map.view().references.wide.empty());
    EXPECT_FALSE(map.view().corners.wide.empty());
    EXPECT_FALSE(map.view().face_numbers.wide.empty());
    EXPECT_TRUE(contains(map, {1, 0, 0}));
    EXPECT_FALSE(contains(map, {0, 0, 0}));
}

TEST(GoldenMapFile, OfVersion2HoldsABoxFarAway) {
    const ExactMap exact = load_exact_map(path_of(kGoldenFarExact));
    EXPECT_EQ(exact.view().origin, kFarAway);
    EXPECT_TRUE(contains(exact, to_local(kFarAway + Vec3d{0.99, 1.49, -1.99}, exact.view().origin)));
    EXPECT_FALSE(contains(exact, to_local(kFarAway + Vec3d{1.01, 0, 0}, exact.view().origin)));
    const DistanceMap distance = load_distance_map(path_of(kGoldenFarFloat32));
    EXPECT_EQ(distance.view().origin, kFarAway);
    expect_box(distance);
}

TEST(GoldenMapFile, IsWrittenBackByteForByte) {
    for (const char* file : {kGoldenFloat32.file, kGoldenUnorm16.file, kGoldenOctahedral.file,
                             kGoldenCube.file, kGoldenEllipsoidal.file, kGoldenExact, kGoldenExactOpen,
                             kGoldenExactOpenMargin, kGoldenExactWide, kGoldenFarExact, kGoldenFarFloat32}) {
        expect_same_bytes(serialise(load_map(path_of(file))), file);
    }
}

TEST(GoldenMapFile, IsWhatTodaysBuildWritesOnAnyNumberOfThreads) {
    for (const unsigned thread_count : {1u, 3u}) {
        for (Golden golden :
             {kGoldenFloat32, kGoldenUnorm16, kGoldenOctahedral, kGoldenCube, kGoldenEllipsoidal}) {
            golden.options.thread_count = thread_count;
            expect_same_bytes(serialise(DistanceMap::build(make_box(kBoxSize), golden.options)), golden.file);
        }
        ExactMapOptions options{.divisions = 1, .thread_count = thread_count};
        expect_same_bytes(serialise(ExactMap::build(make_box(kBoxSize), options)), kGoldenExact);
        expect_same_bytes(serialise(ExactMap::build(far_box(), options)), kGoldenFarExact);
        expect_same_bytes(serialise(DistanceMap::build(far_box(), kGoldenFloat32.options)),
                          kGoldenFarFloat32);
        options.rule = InsideRule::Parity;
        expect_same_bytes(serialise(ExactMap::build(open_box(), options)), kGoldenExactOpenMargin);
    }
}
