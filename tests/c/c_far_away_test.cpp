#include "handles.hpp"

#include <array>
#include <cstdint>
#include <vector>

using namespace echinus;
using namespace echinus::test;

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
