#include "handles.hpp"
#include "support/random_points.hpp"
#include "support/temporary_folder.hpp"

#include <echinus/intersections.hpp>
#include <echinus/mesh.hpp>
#include <echinus/mesh_io.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
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
    mesh = make_box({1, 1, 1});
    mesh.vertices[0].y = std::numeric_limits<float>::quiet_NaN();
    expect_refused(create(), ECHINUS_INVALID_MESH, "face");
    mesh.faces.clear();
    expect_refused(create(), ECHINUS_INVALID_MESH, "no face");
    EXPECT_EQ(result, nullptr);
}

TEST(CMeshes, AreReportedAndRepairedAsInCpp) {
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

    echinus_repair_options options;
    echinus_repair_options_init(&options, sizeof options);
    CMesh repaired;
    CArray dropped;
    echinus_repair_report changes{};
    changes.size = sizeof changes;
    expect_ok(echinus_mesh_repair(mesh.get(), &options, out(repaired), &changes, out(dropped)));
    expect_same_mesh(repaired, box); // nothing is repaired unless it is asked for
    EXPECT_EQ(values_of<std::uint32_t>(dropped).size(), 0U);

    options.drop_duplicate_faces = options.drop_doubled_patches = options.flip_inside_out = 1;
    expect_ok(echinus_mesh_repair(mesh.get(), &options, out(repaired), &changes, out(dropped)));
    const RepairedMesh by_cpp = repair(box, RepairOptions::all());
    expect_same_mesh(repaired, by_cpp.mesh);
    EXPECT_TRUE(same_bits(values_of<std::uint32_t>(dropped),
                          std::span<const std::uint32_t>(by_cpp.report.duplicate_faces_dropped)));
    EXPECT_EQ(changes.duplicate_faces_dropped, 1U);
    EXPECT_EQ(changes.components_flipped, 1U);
    expect_ok(echinus_mesh_repair(mesh.get(), &options, out(repaired), nullptr, nullptr));
}

TEST(CMeshes, HaveTheirSeamsClosedAndFacesTurnedAsInCpp) {
    TriangleMesh torn = make_box({1, 2, 3}, 2);
    torn.vertices.push_back(torn.vertices[torn.faces[0][0]] + Vec3f{0, 0, 1e-3F});
    torn.faces[0][0] = static_cast<std::uint32_t>(torn.vertices.size() - 1);
    std::swap(torn.faces[5][0], torn.faces[5][1]);
    echinus_repair_options options;
    echinus_repair_options_init(&options, sizeof options);
    options.close_seams = options.drop_loose_slivers = options.orient_faces = 1;
    options.weld_distance = 2e-3;
    CMesh mended;
    echinus_repair_report changes{};
    changes.size = sizeof changes;
    expect_ok(echinus_mesh_repair(c_mesh_of(torn).get(), &options, out(mended), &changes, nullptr));
    const RepairedMesh by_cpp = repair(
        torn, {.close_seams = true, .weld_distance = 2e-3, .drop_loose_slivers = true, .orient_faces = true});
    expect_same_mesh(mended, by_cpp.mesh);
    EXPECT_EQ(changes.vertices_welded, 1U);
    EXPECT_EQ(changes.faces_turned, 1U);
    EXPECT_EQ(changes.slivers_dropped, 0U);
    EXPECT_EQ(changes.seams_filled, 0U);
    echinus_mesh_report report{};
    report.size = sizeof report;
    expect_ok(echinus_mesh_inspect(mended.get(), &report));
    EXPECT_TRUE(report.closed != 0 && report.orientable != 0);
    options.weld_distance = -1;
    EXPECT_EQ(echinus_mesh_repair(c_mesh_of(torn).get(), &options, out(mended), nullptr, nullptr),
              ECHINUS_INVALID_OPTIONS);
}

TEST(CMeshes, AreMadeSolidAsInCpp) {
    TriangleMesh open = make_box({1, 2, 3}, 2);
    open.faces.pop_back();
    open.vertices.insert(open.vertices.end(), {{5, 0, 0}, {6, 0, 0}, {5, 1, 0}});
    const auto sheet = static_cast<std::uint32_t>(open.vertices.size() - 3);
    open.faces.push_back({sheet, sheet + 1, sheet + 2});
    echinus_repair_options options;
    echinus_repair_options_init(&options, sizeof options);
    options.max_hole_edges = 3;
    options.drop_inner_faces = 1;
    options.sheet_thickness = 0.125;
    CMesh solid;
    echinus_repair_report changes{};
    changes.size = sizeof changes;
    expect_ok(echinus_mesh_repair(c_mesh_of(open).get(), &options, out(solid), &changes, nullptr));
    const RepairedMesh by_cpp =
        repair(open, {.max_hole_edges = 3, .drop_inner_faces = true, .sheet_thickness = 0.125});
    expect_same_mesh(solid, by_cpp.mesh);
    EXPECT_EQ(changes.holes_closed, 1U);
    EXPECT_EQ(changes.holes_left, 1U);
    EXPECT_EQ(changes.sheets_thickened, 1U);
    EXPECT_EQ(changes.faces_added, by_cpp.report.faces_added);

    options.max_hole_edges = 257;
    EXPECT_EQ(echinus_mesh_repair(c_mesh_of(open).get(), &options, out(solid), nullptr, nullptr),
              ECHINUS_INVALID_OPTIONS);

    // A program of before seams, slivers and orientation.
    options.max_hole_edges = 3;
    options.size = offsetof(echinus_repair_options, close_seams);
    options.close_seams = 7; // beyond the size
    changes.size = offsetof(echinus_repair_report, vertices_welded);
    expect_ok(echinus_mesh_repair(c_mesh_of(open).get(), &options, out(solid), &changes, nullptr));
    expect_same_mesh(solid, by_cpp.mesh);

    // A program of before there were any of these.
    options.size = offsetof(echinus_repair_options, max_hole_edges);
    changes.size = offsetof(echinus_repair_report, holes_closed);
    changes.holes_closed = 7;
    expect_ok(echinus_mesh_repair(c_mesh_of(open).get(), &options, out(solid), &changes, nullptr));
    expect_same_mesh(solid, open);
    EXPECT_EQ(changes.holes_closed, 7U);
    options.size -= 1;
    EXPECT_EQ(echinus_mesh_repair(c_mesh_of(open).get(), &options, out(solid), nullptr, nullptr),
              ECHINUS_INVALID_ARGUMENT);
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

TEST_F(CMeshFile, IsWrittenAndReadAsInCpp) {
    const CMesh torus = c_torus();
    for (const char* name : {"torus.obj", "torus.ply", "torus.stl", "torus.off"}) {
        expect_ok(echinus_mesh_write(torus.get(), path(name).c_str()));
        CMesh read;
        expect_ok(echinus_mesh_read(path(name).c_str(), out(read)));
        expect_same_mesh(read, read_mesh(path(name)));
    }
    expect_refused(echinus_mesh_write(torus.get(), path("torus.xyz").c_str()), ECHINUS_WRONG_FORMAT,
                   "torus.xyz");
    expect_refused(echinus_mesh_write(torus.get(), path("no/torus.obj").c_str()), ECHINUS_UNWRITABLE, "no");
}

TEST_F(CMeshFile, IsRefusedWhenTruncatedOrMissing) {
    expect_ok(echinus_mesh_write(c_torus().get(), path("torus.ply").c_str()));
    std::filesystem::resize_file(path("torus.ply"), 2000);
    CMesh mesh;
    expect_refused(echinus_mesh_read(path("torus.ply").c_str(), out(mesh)), ECHINUS_DAMAGED, "torus.ply");
    expect_refused(echinus_mesh_read(path("none.ply").c_str(), out(mesh)), ECHINUS_UNREADABLE, "none.ply");
    expect_refused(echinus_mesh_read(write("m.txt", "text").c_str(), out(mesh)), ECHINUS_WRONG_FORMAT,
                   "m.txt");
    expect_refused(echinus_mesh_read(write("m.off", "OFF\n1 1 0\n0 0 0\n3 0 1 2\n").c_str(), out(mesh)),
                   ECHINUS_INVALID_MESH, "m.off");
    EXPECT_EQ(mesh, nullptr);
}

} // namespace
