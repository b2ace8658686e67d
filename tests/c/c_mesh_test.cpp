#include "handles.hpp"
#include "support/meshes.hpp"
#include "support/random_points.hpp"
#include "support/temporary_folder.hpp"

#include <echinus/exact_map.hpp>
#include <echinus/intersections.hpp>
#include <echinus/mesh.hpp>
#include <echinus/mesh_io.hpp>
#include <echinus/surface_collision.hpp>
#include <echinus/tetrahedra.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

using namespace echinus;
using namespace echinus::test;

namespace {

class CMeshFile : public TemporaryFolderTest {};

std::span<const Vec3f> vertices_of(const CMesh& mesh) {
    return {reinterpret_cast<const Vec3f*>(echinus_mesh_vertices(mesh.get())),
            echinus_mesh_vertex_count(mesh.get())};
}
std::span<const Triangle> faces_of(const CMesh& mesh) {
    return {reinterpret_cast<const Triangle*>(echinus_mesh_faces(mesh.get())),
            echinus_mesh_face_count(mesh.get())};
}

void expect_same_mesh(const CMesh& mesh, const TriangleMesh& expected) {
    EXPECT_TRUE(same_bits(vertices_of(mesh), std::span<const Vec3f>(expected.vertices)));
    EXPECT_TRUE(same_bits(faces_of(mesh), std::span<const Triangle>(expected.faces)));
}

/// A box with a duplicate face, inside out.
TriangleMesh broken_box() {
    TriangleMesh box = make_box({1, 1, 1});
    for (Triangle& face : box.faces) face = {face[0], face[2], face[1]};
    box.faces.push_back(box.faces.front());
    return box;
}

TEST(CMeshes, AreThoseOfCpp) {
    CMesh mesh;
    expect_ok(echinus_mesh_torus(1.0, 0.4, 60, 24, out(mesh)));
    expect_same_mesh(mesh, make_torus(1.0, 0.4, 60, 24));
    expect_ok(echinus_mesh_sphere(2.0, 20, 10, out(mesh)));
    expect_same_mesh(mesh, make_sphere(2.0, 20, 10));
    const double size[3] = {1, 2, 3};
    expect_ok(echinus_mesh_box(size, 4, out(mesh)));
    expect_same_mesh(mesh, make_box({1, 2, 3}, 4));
    expect_refused(echinus_mesh_torus(1.0, 2.0, 60, 24, out(mesh)), ECHINUS_INVALID_OPTIONS, "radius");
    EXPECT_EQ(mesh, nullptr);
}

TEST(CMeshes, CopyVerticesOfAnyStride) {
    const TriangleMesh torus = make_torus(1.0, 0.4, 12, 8);
    struct Vertex {
        float u;
        Vec3f position;
        float v;
    };
    std::vector<Vertex> vertices;
    for (const Vec3f& position : torus.vertices) vertices.push_back({7, position, 8});
    CMesh mesh;
    expect_ok(echinus_mesh_create(&vertices.data()->position.x, vertices.size(), sizeof(Vertex),
                                  torus.faces.data()->data(), torus.faces.size(), out(mesh)));
    expect_same_mesh(mesh, torus);
}

TEST(CMeshes, AreRefusedWhenInvalid) {
    TriangleMesh mesh = make_box({1, 1, 1});
    CMesh result;
    const auto create = [&] {
        return echinus_mesh_create(&mesh.vertices.data()->x, mesh.vertices.size(), 0,
                                   mesh.faces.data()->data(), mesh.faces.size(), out(result));
    };
    mesh.faces[3][1] = 8;
    expect_refused(create(), ECHINUS_INVALID_MESH, "face 3");
    mesh.faces.clear();
    expect_refused(create(), ECHINUS_INVALID_MESH, "no face");
    EXPECT_EQ(result, nullptr);
}

TEST(CMeshes, AreReportedAsInCpp) {
    const TriangleMesh box = broken_box();
    const CMesh mesh = c_mesh_of(box);
    const MeshReport expected = inspect(box);
    echinus_mesh_report report{};
    report.size = sizeof report;
    expect_ok(echinus_mesh_inspect(mesh.get(), &report));
    EXPECT_EQ(report.face_count, expected.face_count);
    EXPECT_EQ(report.vertex_count, expected.vertex_count);
    EXPECT_EQ(report.component_count, expected.component_count);
    EXPECT_EQ(report.closed != 0, expected.closed);
    EXPECT_EQ(report.manifold != 0, expected.manifold);
    EXPECT_EQ(report.nonmanifold_edges.count, expected.nonmanifold_edges.count);
    EXPECT_EQ(report.duplicate_faces.count, 1U);
    EXPECT_EQ(report.duplicate_faces.first_face_count, 1U);
    EXPECT_EQ(report.duplicate_faces.first_faces[0], expected.duplicate_faces.first_faces[0]);
    EXPECT_EQ(report.signed_volume, expected.signed_volume);
    EXPECT_EQ(report.radius, expected.bounding_sphere.radius);
    EXPECT_EQ(report.centre[0], expected.bounding_sphere.centre.x);
}

/// A box with each fault that a step of the repair mends, one of them inside.
TriangleMesh faulty_box() {
    TriangleMesh mesh = make_box({1, 2, 3}, 2);
    const auto append = [&](const TriangleMesh& part) {
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.insert(mesh.vertices.end(), part.vertices.begin(), part.vertices.end());
        for (const Triangle& face : part.faces)
            mesh.faces.push_back({first + face[0], first + face[1], first + face[2]});
    };
    mesh.vertices.push_back(mesh.vertices[mesh.faces[0][0]] + Vec3f{0, 0, 1e-3F});
    mesh.faces[0][0] = static_cast<std::uint32_t>(mesh.vertices.size() - 1); // a seam
    std::swap(mesh.faces[5][0], mesh.faces[5][1]);
    append(make_box({0.2, 0.2, 0.2}));
    TriangleMesh inside_out = broken_box();
    for (Vec3f& vertex : inside_out.vertices) vertex.x += 5;
    append(inside_out);
    append({{{9, 0, 0}, {10, 0, 0}, {9, 1, 0}}, {{0, 1, 2}}}); // a sheet
    return mesh;
}

TEST(CMeshes, AreRepairedAsInCpp) {
    const TriangleMesh faulty = faulty_box();
    const CMesh mesh = c_mesh_of(faulty);
    echinus_repair_options options;
    echinus_repair_options_init(&options, sizeof options);
    CMesh repaired;
    CArray dropped;
    echinus_repair_report changes{};
    changes.size = sizeof changes;
    expect_ok(echinus_mesh_repair(mesh.get(), &options, out(repaired), &changes, out(dropped)));
    expect_same_mesh(repaired, faulty); // nothing is repaired unless it is asked for
    EXPECT_EQ(values_of<std::uint32_t>(dropped).size(), 0U);

    options.drop_duplicate_faces = options.drop_doubled_patches = options.flip_inside_out = 1;
    options.close_seams = options.drop_loose_slivers = options.orient_faces = options.drop_inner_faces = 1;
    options.weld_distance = 2e-3;
    options.max_hole_edges = 8;
    options.sheet_thickness = 0.125;
    RepairOptions expected = RepairOptions::all();
    expected.drop_inner_faces = true;
    expected.weld_distance = 2e-3;
    expected.max_hole_edges = 8;
    expected.sheet_thickness = 0.125;
    expect_ok(echinus_mesh_repair(mesh.get(), &options, out(repaired), &changes, out(dropped)));
    const auto& [by_cpp, report] = repair(faulty, expected);
    expect_same_mesh(repaired, by_cpp);
    EXPECT_EQ(changes.duplicate_faces_dropped, report.duplicate_faces_dropped.size());
    EXPECT_EQ(changes.doubled_patch_faces_dropped, report.doubled_patch_faces_dropped.size());
    EXPECT_EQ(changes.inner_faces_dropped, report.inner_faces_dropped.size());
    EXPECT_EQ(changes.slivers_dropped, report.slivers_dropped.size());
    EXPECT_EQ(values_of<std::uint32_t>(dropped).size(),
              changes.duplicate_faces_dropped + changes.doubled_patch_faces_dropped +
                  changes.inner_faces_dropped + changes.slivers_dropped);
    EXPECT_EQ(changes.components_flipped, report.components_flipped);
    EXPECT_EQ(changes.holes_closed, report.holes_closed);
    EXPECT_EQ(changes.holes_left, report.holes_left);
    EXPECT_EQ(changes.sheets_thickened, report.sheets_thickened);
    EXPECT_EQ(changes.faces_added, report.faces_added);
    EXPECT_EQ(changes.vertices_welded, report.vertices_welded);
    EXPECT_EQ(changes.faces_turned, report.faces_turned);
    EXPECT_EQ(changes.seams_filled, report.seams_filled);
    EXPECT_TRUE(changes.duplicate_faces_dropped > 0 && changes.inner_faces_dropped > 0 &&
                changes.components_flipped > 0 && changes.sheets_thickened > 0 &&
                changes.vertices_welded > 0 && changes.faces_turned > 0);
}

TEST(CMeshes, AreWeldedAndJudgedAsInCpp) {
    TriangleMesh soup;
    const TriangleMesh box = make_box({1, 2, 3});
    for (const Triangle& face : box.faces) {
        const auto first = static_cast<std::uint32_t>(soup.vertices.size());
        for (const std::uint32_t corner : face) soup.vertices.push_back(box.vertices[corner]);
        soup.faces.push_back({first, first + 1, first + 2});
    }
    CMesh welded;
    expect_ok(echinus_mesh_weld(c_mesh_of(soup).get(), out(welded)));
    expect_same_mesh(welded, weld(soup));

    Random random(1);
    for (int i = 0; i < 20; ++i) {
        const Vec3d point(in_cube(random, 2));
        double winding = 0, distance = 0;
        expect_ok(echinus_mesh_winding_number(welded.get(), Numbers(point), &winding));
        expect_ok(echinus_mesh_unsigned_distance(welded.get(), Numbers(point), &distance));
        EXPECT_EQ(winding, winding_number(box, point));
        EXPECT_EQ(distance, unsigned_distance(box, point));
    }
}

TEST(CMeshes, IntersectAsInCpp) {
    const TriangleMesh a = make_box({1, 1, 1});
    TriangleMesh b = make_sphere(0.6, 12, 8);
    CArray pairs;
    expect_ok(echinus_mesh_intersecting_pairs(c_mesh_of(a).get(), c_mesh_of(b).get(), out(pairs)));
    const std::vector<FacePair> expected = intersecting_pairs(a, b);
    EXPECT_FALSE(expected.empty());
    EXPECT_TRUE(same_bits(values_of<FacePair>(pairs), std::span<const FacePair>(expected)));

    b.faces.push_back(b.faces.front());
    expect_ok(echinus_mesh_self_intersecting_pairs(c_mesh_of(b).get(), out(pairs)));
    const std::vector<FacePair> self = self_intersecting_pairs(b);
    EXPECT_FALSE(self.empty());
    EXPECT_TRUE(same_bits(values_of<FacePair>(pairs), std::span<const FacePair>(self)));
}

TEST(CMeshes, IntersectAlongTheCurvesOfCpp) {
    const TriangleMesh a = make_box({1, 1, 1});
    TriangleMesh b = make_sphere(0.6, 12, 8);
    CArray pairs, curves, points;
    const auto expect_same = [&](const Intersections& expected) {
        EXPECT_TRUE(same_bits(values_of<FacePair>(pairs), std::span<const FacePair>(expected.pairs)));
        const auto sizes = values_of<echinus_intersection_curve>(curves);
        std::span<const Vec3f> rest = values_of<Vec3f>(points);
        ASSERT_EQ(sizes.size(), expected.curves.size());
        for (std::size_t i = 0; i < sizes.size(); ++i) {
            EXPECT_EQ(sizes[i].closed != 0, expected.curves[i].closed);
            ASSERT_LE(sizes[i].point_count, rest.size());
            EXPECT_TRUE(same_bits(rest.first(sizes[i].point_count),
                                  std::span<const Vec3f>(expected.curves[i].points)));
            rest = rest.subspan(sizes[i].point_count);
        }
        EXPECT_TRUE(rest.empty());
    };
    expect_ok(echinus_mesh_intersections(c_mesh_of(a).get(), c_mesh_of(b).get(), out(pairs), out(curves),
                                         out(points)));
    expect_same(intersections(a, b));
    const auto first = static_cast<std::uint32_t>(b.vertices.size());
    b.vertices.insert(b.vertices.end(), a.vertices.begin(), a.vertices.end());
    for (const auto& [p, q, r] : a.faces) b.faces.push_back({first + p, first + q, first + r});
    expect_ok(echinus_mesh_intersections(c_mesh_of(b).get(), nullptr, out(pairs), out(curves), out(points)));
    EXPECT_FALSE(self_intersections(b).curves.empty());
    expect_same(self_intersections(b));
    expect_ok(echinus_mesh_intersections(c_mesh_of(b).get(), nullptr, nullptr, out(curves), out(points)));
}

TEST(CMeshes, AreCheckedAsInCpp) {
    TriangleMesh open = make_box({1, 1, 1});
    open.faces.pop_back();
    const std::vector<TriangleMesh> meshes{make_sphere(0.6, 12, 8), open, make_sphere(0.1, 9, 5)};
    std::vector<CMesh> handles;
    std::vector<const echinus_mesh*> addresses;
    for (const TriangleMesh& mesh : meshes) addresses.push_back(handles.emplace_back(c_mesh_of(mesh)).get());
    CArray array;
    expect_ok(echinus_check(addresses.data(), addresses.size(), 1, out(array)));
    const auto found = values_of<echinus_checked_meshes>(array);
    const std::vector<CheckedMeshes> expected = check(meshes);
    ASSERT_EQ(found.size(), expected.size());
    ASSERT_EQ(found.size(), 2U);
    for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_EQ(found[i].a, expected[i].a);
        EXPECT_EQ(found[i].b, expected[i].b);
        EXPECT_EQ(found[i].pair_count, expected[i].found.pairs.size());
        EXPECT_EQ(found[i].curve_count, expected[i].found.curves.size());
        EXPECT_EQ(found[i].curve_length, expected[i].found.length);
        EXPECT_EQ(found[i].a_in_b.known != 0, expected[i].a_in_b.known);
        EXPECT_EQ(found[i].b_in_a.vertex_count, expected[i].b_in_a.vertex_count);
        EXPECT_EQ(found[i].b_in_a.deepest_vertex, expected[i].b_in_a.deepest_vertex);
        EXPECT_EQ(found[i].b_in_a.depth, expected[i].b_in_a.depth);
    }
    expect_ok(echinus_check(nullptr, 0, 0, out(array)));
    addresses[1] = nullptr;
    expect_refused(echinus_check(addresses.data(), addresses.size(), 0, out(array)), ECHINUS_INVALID_ARGUMENT,
                   "a mesh");
}

TEST(CMesh, IsPartedAsInCpp) {
    const TriangleMesh sheet = translated(sheet_mesh(9, 9), {0, 0, 0.1F}), ball = make_sphere(0.3, 16, 8);
    const CMesh surface = c_mesh_of(sheet), model = c_mesh_of(ball);
    const echinus_mesh* models[] = {model.get()};
    std::vector<std::uint8_t> pinned(81), layers(81, 4);
    pinned[0] = 1;
    CMesh parted;
    echinus_part_report report{};
    report.size = sizeof report;
    expect_ok(echinus_mesh_part(surface.get(), models, 1, pinned.data(), layers.data(), 0, 1, out(parted),
                                &report));
    TriangleMesh moved = sheet;
    const Parted expected = part(sheet, std::vector{ball}, {.pinned = pinned, .layers = layers});
    moved.vertices = expected.vertices;
    expect_same_mesh(parted, moved);
    EXPECT_EQ(report.own_pairs + report.model_pairs + report.inside_count, 0U);
    EXPECT_EQ(report.largest_stretch, expected.largest_stretch);
    EXPECT_EQ(report.stretched_share, expected.stretched_share);
    expect_refused(echinus_mesh_part(surface.get(), models, 1, nullptr, nullptr, -1, 0, out(parted), nullptr),
                   ECHINUS_INVALID_OPTIONS, "thickness");
    models[0] = nullptr;
    expect_refused(echinus_mesh_part(surface.get(), models, 1, nullptr, nullptr, 0, 0, out(parted), nullptr),
                   ECHINUS_INVALID_ARGUMENT, "a mesh");
}

TEST_F(CMeshFile, IsWrittenAndReadAsInCpp) {
    const CMesh torus = c_torus();
    for (const char* name : {"torus.obj", "torus.ply", "torus.stl", "torus.off"}) {
        expect_ok(echinus_mesh_write(torus.get(), path(name).string().c_str()));
        CMesh read;
        expect_ok(echinus_mesh_read(path(name).string().c_str(), out(read)));
        expect_same_mesh(read, read_mesh(path(name)));
    }
    expect_refused(echinus_mesh_write(torus.get(), path("torus.xyz").string().c_str()), ECHINUS_WRONG_FORMAT,
                   "torus.xyz");
    expect_refused(echinus_mesh_write(torus.get(), path("no/torus.obj").string().c_str()), ECHINUS_UNWRITABLE,
                   "no");
}

} // namespace

// Tetrahedra in C are those of C++; what is no body is refused.

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
        expect_ok(echinus_tetrahedra_write(body.get(), path(name).string().c_str()));
        CTetrahedra read;
        echinus_tetrahedra_file_report report{};
        report.size = sizeof report;
        report.turned_tetrahedra = 7;
        expect_ok(echinus_tetrahedra_read(path(name).string().c_str(), out(read), &report));
        EXPECT_EQ(report.turned_tetrahedra, 0U);
        EXPECT_EQ(report.dropped_vertices, 0U);
        ASSERT_EQ(echinus_tetrahedra_count(read.get()), echinus_tetrahedra_count(body.get()));
        EXPECT_EQ(std::memcmp(echinus_tetrahedra_indices(read.get()), echinus_tetrahedra_indices(body.get()),
                              echinus_tetrahedra_count(body.get()) * sizeof(Tetrahedron)),
                  0);
    }
    CTetrahedra none;
    expect_refused(echinus_tetrahedra_read(path("none.msh").string().c_str(), out(none), nullptr),
                   ECHINUS_UNREADABLE, "none.msh");
    expect_refused(echinus_tetrahedra_read(write("torn.vtk", "# vtk\n").string().c_str(), out(none), nullptr),
                   ECHINUS_WRONG_FORMAT, "torn.vtk");
    expect_refused(echinus_tetrahedra_write(body.get(), path("a.obj").string().c_str()), ECHINUS_WRONG_FORMAT,
                   ".obj");
    EXPECT_EQ(none, nullptr);
}

TEST_F(CTetrahedraFiles, TellWhatTheyWereChangedIn) {
    write("a.node", "5 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n4 9 9 9\n");
    write("a.ele", "1 4 0\n0 0 2 1 3\n");
    CTetrahedra body;
    echinus_tetrahedra_file_report report{};
    report.size = sizeof report;
    expect_ok(echinus_tetrahedra_read(path("a.node").string().c_str(), out(body), &report));
    EXPECT_EQ(report.turned_tetrahedra, 1U);
    EXPECT_EQ(report.dropped_vertices, 1U);
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
