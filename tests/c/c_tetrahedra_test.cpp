// Tetrahedra in C are those of C++; what is no body is refused.

#include "handles.hpp"
#include "support/temporary_folder.hpp"

#include <echinus/exact_map.hpp>
#include <echinus/tetrahedra.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

using namespace echinus;
using namespace echinus::test;

namespace {

class CTetrahedraFiles : public TemporaryFolderTest {};

constexpr float kCorner[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};

CTetrahedra c_body(double size) {
    echinus_tetrahedralize_options options;
    echinus_tetrahedralize_options_init(&options, sizeof options);
    options.lattice_size = size;
    CTetrahedra body;
    expect_ok(echinus_tetrahedralize(c_map(c_torus()).get(), &options, out(body), nullptr));
    return body;
}

void expect_same(const CTetrahedra& body, const TetrahedralMesh& expected) {
    ASSERT_EQ(echinus_tetrahedra_vertex_count(body.get()), expected.vertices.size());
    ASSERT_EQ(echinus_tetrahedra_count(body.get()), expected.tetrahedra.size());
    EXPECT_EQ(std::memcmp(echinus_tetrahedra_vertices(body.get()), expected.vertices.data(),
                          expected.vertices.size() * sizeof(Vec3f)),
              0);
    EXPECT_EQ(std::memcmp(echinus_tetrahedra_indices(body.get()), expected.tetrahedra.data(),
                          expected.tetrahedra.size() * sizeof(Tetrahedron)),
              0);
}

TEST(CTetrahedra, FillAModelAsInCpp) {
    const ExactMap map = ExactMap::build(make_torus(1.0, 0.4, 60, 24));
    const Tetrahedralization expected = tetrahedralize(map.view(), {.count = 2000});
    echinus_tetrahedralize_options options;
    echinus_tetrahedralize_options_init(&options, sizeof options);
    EXPECT_EQ(options.most_tetrahedra, TetrahedralizeOptions{}.most_tetrahedra);
    options.count = 2000;
    echinus_tetrahedralize_report made{};
    made.size = sizeof made;
    const CMap torus = c_map(c_torus());
    CTetrahedra body;
    expect_ok(echinus_tetrahedralize(torus.get(), &options, out(body), &made));
    expect_same(body, expected.mesh);
    EXPECT_EQ(made.lattice_size, expected.size);
    EXPECT_EQ(made.removed_tetrahedra, expected.removed_tetrahedra);

    echinus_tetrahedra_report report{};
    report.size = sizeof report;
    expect_ok(echinus_tetrahedra_inspect(body.get(), &report));
    const TetrahedralReport inspected = inspect_tetrahedra(expected.mesh);
    EXPECT_EQ(report.tetrahedron_count, inspected.tetrahedron_count);
    EXPECT_EQ(report.vertex_count, inspected.vertex_count);
    EXPECT_EQ(report.volume, inspected.volume);
    EXPECT_EQ(report.least_volume, inspected.least_volume);
    EXPECT_EQ(report.shortest_edge, inspected.shortest_edge);
    EXPECT_EQ(report.longest_edge, inspected.longest_edge);
    EXPECT_EQ(report.least_angle_deg, inspected.least_angle_deg);
    EXPECT_EQ(report.greatest_angle_deg, inspected.greatest_angle_deg);

    echinus_boundary_distance distance{};
    distance.size = sizeof distance;
    expect_ok(echinus_tetrahedra_measure_distance(body.get(), torus.get(), 1, &distance));
    const BoundaryDistance measured = measure_distance(expected.mesh, map.view(), 1);
    EXPECT_EQ(distance.mean_to_model, measured.mean_to_model);
    EXPECT_EQ(distance.greatest_to_model, measured.greatest_to_model);
    EXPECT_EQ(distance.mean_to_boundary, measured.mean_to_boundary);
    EXPECT_EQ(distance.greatest_to_boundary, measured.greatest_to_boundary);
}

TEST(CTetrahedra, HaveABoundaryThatIsAClosedMesh) {
    const double size[3] = {2, 1, 1};
    const std::uint32_t segments[3] = {2, 1, 1};
    CTetrahedra box;
    expect_ok(echinus_tetrahedra_box(size, segments, out(box)));
    expect_same(box, make_solid_box({2, 1, 1}, {2, 1, 1}));
    CMesh surface;
    expect_ok(echinus_tetrahedra_boundary(box.get(), out(surface)));
    echinus_mesh_report report{};
    report.size = sizeof report;
    expect_ok(echinus_mesh_inspect(surface.get(), &report));
    EXPECT_EQ(report.closed, 1);
    EXPECT_DOUBLE_EQ(report.signed_volume, 2);
}

TEST_F(CTetrahedraFiles, ReadBackWithTheSameBits) {
    const CTetrahedra body = c_body(0.2);
    for (const char* name : {"a.msh", "a.vtk"}) {
        expect_ok(echinus_tetrahedra_write(body.get(), path(name).c_str()));
        CTetrahedra read;
        echinus_tetrahedra_file_report report{};
        report.size = sizeof report;
        report.turned_tetrahedra = 7;
        expect_ok(echinus_tetrahedra_read(path(name).c_str(), out(read), &report));
        EXPECT_EQ(report.turned_tetrahedra, 0U);
        EXPECT_EQ(report.dropped_vertices, 0U);
        ASSERT_EQ(echinus_tetrahedra_count(read.get()), echinus_tetrahedra_count(body.get()));
        EXPECT_EQ(std::memcmp(echinus_tetrahedra_indices(read.get()), echinus_tetrahedra_indices(body.get()),
                              echinus_tetrahedra_count(body.get()) * sizeof(Tetrahedron)),
                  0);
    }
    CTetrahedra none;
    expect_refused(echinus_tetrahedra_read(path("none.msh").c_str(), out(none), nullptr), ECHINUS_UNREADABLE,
                   "none.msh");
    expect_refused(echinus_tetrahedra_read(write("torn.vtk", "# vtk\n").c_str(), out(none), nullptr),
                   ECHINUS_WRONG_FORMAT, "torn.vtk");
    expect_refused(echinus_tetrahedra_write(body.get(), path("a.obj").c_str()), ECHINUS_WRONG_FORMAT, ".obj");
    EXPECT_EQ(none, nullptr);
}

TEST(CTetrahedra, ThatAreNotValidAreRefused) {
    CTetrahedra body;
    const auto create = [&](std::initializer_list<std::uint32_t> corners) {
        return echinus_tetrahedra_create(kCorner, 4, 0, corners.begin(), corners.size() / 4, out(body));
    };
    expect_ok(create({0, 1, 2, 3}));
    expect_refused(create({0, 2, 1, 3}), ECHINUS_INVALID_MESH, "tetrahedron 0");
    EXPECT_EQ(body, nullptr);
}

TEST(CTetrahedra, CarryAFinerMeshAlong) {
    const CTetrahedra body = c_body(0.2);
    const TriangleMesh fine = make_torus(1.0, 0.4, 60, 24);
    const std::size_t count = fine.vertices.size();
    CEmbedding embedding;
    expect_ok(echinus_embedding_create(body.get(), &fine.vertices.data()->x, count, 0, 1, out(embedding)));
    EXPECT_EQ(echinus_embedding_count(embedding.get()), count);

    const std::size_t vertex_count = echinus_tetrahedra_vertex_count(body.get());
    const auto* vertices = reinterpret_cast<const Vec3f*>(echinus_tetrahedra_vertices(body.get()));
    std::vector<Vec3f> moved(vertex_count), carried(count);
    for (std::size_t i = 0; i < vertex_count; ++i) moved[i] = vertices[i] * 2.0F + Vec3f(1, 0, 0);
    expect_ok(
        echinus_embedding_carry(embedding.get(), &moved.data()->x, vertex_count, 0, 1, &carried.data()->x));
    for (std::size_t i = 0; i < count; ++i)
        ASSERT_LT(length(carried[i] - (fine.vertices[i] * 2.0F + Vec3f(1, 0, 0))), 1e-4F) << i;
    expect_refused(echinus_embedding_carry(embedding.get(), &moved.data()->x, vertex_count - 1, 0, 1,
                                           &carried.data()->x),
                   ECHINUS_INVALID_ARGUMENT, "position_count is");
}

} // namespace
