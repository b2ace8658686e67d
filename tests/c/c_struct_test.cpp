#include "handles.hpp"

#include <echinus/map_file.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

using namespace echinus;
using namespace echinus::test;

namespace {

/// The options of a program that was compiled with a newer header.
struct NewerOptions {
    echinus_exact_map_options known;
    std::uint32_t unknown = 0;
    std::uint32_t also_unknown = 0;
};

TEST(CStructs, OfANewerHeaderAreTakenIfTheySetNothingNew) {
    const CMesh mesh = c_torus();
    NewerOptions options;
    echinus_exact_map_options_init(&options.known, sizeof options);
    EXPECT_EQ(options.known.size, sizeof options);
    EXPECT_EQ(options.unknown, 0U);
    CMap map;
    expect_ok(echinus_map_build_exact(mesh.get(), &options.known, out(map)));

    options.also_unknown = 1;
    expect_refused(echinus_map_build_exact(mesh.get(), &options.known, out(map)), ECHINUS_INVALID_ARGUMENT,
                   "options sets a member that version");
    EXPECT_EQ(map, nullptr);
}

TEST(CStructs, OfANewerHeaderGetZeroWhereTheLibraryKnowsNothing) {
    struct NewerInfo {
        echinus_map_info known;
        std::uint64_t unknown;
    } info;
    std::memset(&info, 0xFF, sizeof info);
    info.known.size = sizeof info;
    const CMap map = c_map(c_torus());
    expect_ok(echinus_map_describe(map.get(), &info.known));
    EXPECT_EQ(info.known.size, sizeof info);
    EXPECT_EQ(info.known.kind, ECHINUS_MAP_EXACT);
    EXPECT_EQ(info.unknown, 0U);
}

TEST(CStructs, AreRefusedWithASizeThatCannotBeRight) {
    const CMesh mesh = c_torus();
    echinus_exact_map_options options;
    echinus_exact_map_options_init(&options, sizeof options);
    CMap map;
    for (const std::size_t wrong :
         {std::size_t{0}, std::size_t{8}, offsetof(echinus_exact_map_options, find_certain_gaps) - 1,
          std::size_t{5000}, SIZE_MAX}) {
        options.size = wrong;
        expect_refused(echinus_map_build_exact(mesh.get(), &options, out(map)), ECHINUS_INVALID_ARGUMENT,
                       "the size of options is " + std::to_string(wrong));
    }
    echinus_mesh_report report{};
    expect_refused(echinus_mesh_inspect(mesh.get(), &report), ECHINUS_INVALID_ARGUMENT,
                   "the size of report is 0");
}

TEST(CStructs, AreFilledNoFartherThanTheirSize) {
    struct {
        echinus_exact_map_options options;
        unsigned char after[16];
    } guarded;
    std::memset(&guarded, 0xAB, sizeof guarded);
    echinus_exact_map_options_init(&guarded.options, offsetof(echinus_exact_map_options, byte_budget));
    const auto* bytes = reinterpret_cast<const unsigned char*>(&guarded);
    for (std::size_t i = offsetof(echinus_exact_map_options, byte_budget); i < sizeof guarded; ++i)
        ASSERT_EQ(bytes[i], 0xAB) << i;
    echinus_exact_map_options_init(nullptr, sizeof guarded.options);
}

} // namespace

namespace {

const std::array<double, 3> kPlace{448262, 5411932, 112};

/// A box of 1 x 0.9 x 0.8 around the place.
CMesh far_box() {
    const TriangleMesh box = make_box({1, 0.9, 0.8});
    std::vector<double> vertices;
    for (const Vec3f& vertex : box.vertices)
        vertices.insert(vertices.end(), {vertex.x + kPlace[0], vertex.y + kPlace[1], vertex.z + kPlace[2]});
    CMesh mesh;
    expect_ok(echinus_mesh_create_double(vertices.data(), box.vertices.size(), box.faces[0].data(),
                                         box.faces.size(), out(mesh)));
    return mesh;
}

} // namespace

TEST(CFarAway, MeshesAndMapsHaveAnOrigin) {
    const CMesh mesh = far_box();
    const double* origin = echinus_mesh_origin(mesh.get());
    for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(origin[axis], kPlace[axis]);
    echinus_mesh_report report{};
    report.size = sizeof report;
    expect_ok(echinus_mesh_inspect(mesh.get(), &report));
    EXPECT_NEAR(report.signed_volume, 0.72, 1e-6);
    EXPECT_EQ(report.rounding_step, 0);

    const CMap map = c_map(mesh);
    echinus_map_info info{};
    info.size = sizeof info;
    expect_ok(echinus_map_describe(map.get(), &info));
    for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(info.origin[axis], kPlace[axis]);

    const std::array<double, 6> points{448262, 5411932.44, 112, 448262, 5411932.46, 112};
    std::array<float, 6> local{};
    expect_ok(echinus_to_local(points.data(), 2, info.origin, local.data()));
    std::array<float, 2> distances{};
    expect_ok(echinus_map_signed_distance(map.get(), local.data(), 2, 0, 1, distances.data(), nullptr));
    EXPECT_NEAR(distances[0], -0.01, 3e-6);
    EXPECT_NEAR(distances[1], 0.01, 3e-6);

    echinus_tetrahedralize_options options;
    echinus_tetrahedralize_options_init(&options, sizeof options);
    options.lattice_size = 0.3;
    CTetrahedra body;
    expect_ok(echinus_tetrahedralize(map.get(), &options, out(body), nullptr));
    EXPECT_EQ(echinus_tetrahedra_origin(body.get())[1], kPlace[1]);
}

TEST(CFarAway, CallersWithTheStructsOfBeforeGetWhatTheyKnow) {
    const CMesh mesh = far_box();
    echinus_mesh_report report{};
    report.size = offsetof(echinus_mesh_report, rounding_step);
    report.rounding_step = -1;
    expect_ok(echinus_mesh_inspect(mesh.get(), &report));
    EXPECT_NEAR(report.signed_volume, 0.72, 1e-6);
    EXPECT_EQ(report.rounding_step, -1);
    echinus_map_info info{};
    info.size = offsetof(echinus_map_info, origin);
    info.origin[0] = -1;
    expect_ok(echinus_map_describe(c_map(mesh).get(), &info));
    EXPECT_EQ(info.face_count, 12U);
    EXPECT_EQ(info.origin[0], -1);
}
