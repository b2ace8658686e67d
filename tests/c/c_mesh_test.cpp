#include "handles.hpp"
#include "support/random_points.hpp"
#include "support/temporary_folder.hpp"

#include <echinus/intersections.hpp>
#include <echinus/mesh.hpp>
#include <echinus/mesh_io.hpp>

#include <gtest/gtest.h>

#include <cstdint>

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

} // namespace
