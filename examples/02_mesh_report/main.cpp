// Inspect a mesh for faults, and repair it on request.
// Usage: 02_mesh_report [MESH]; without a file, a box that has a duplicate face and is inside out.

#include <echinus/mesh.hpp>
#include <echinus/mesh_io.hpp>

#include <cstdio>
#include <exception>

namespace {

using namespace echinus;

TriangleMesh broken_box() {
    TriangleMesh box = make_box({1, 1, 1});
    for (Triangle& face : box.faces) face = {face[0], face[2], face[1]};
    box.faces.push_back(box.faces.front());
    return box;
}

void print(const char* title, const MeshReport& report) {
    std::printf("%s: %zu faces, %s, volume %.3f\n", title, report.face_count,
                report.closed ? "closed" : "not closed", report.signed_volume);
    std::printf("  edges with more than two faces: %zu\n", report.nonmanifold_edges.count);
    std::printf("  duplicate faces: %zu", report.duplicate_faces.count);
    for (const auto face : report.duplicate_faces.first_faces) std::printf("  (face %u)", face);
    std::printf("\n");
}

} // namespace

int main(int argc, char** argv) try {
    const TriangleMesh mesh = argc > 1 ? read_mesh(argv[1]) : broken_box();
    print("as it is", inspect(mesh));

    const RepairedMesh repaired = repair(mesh, RepairOptions::all());
    print("repaired", inspect(repaired.mesh));
    std::printf("  dropped %zu duplicate faces and %zu of doubled patches, turned %zu components round\n",
                repaired.report.duplicate_faces_dropped.size(),
                repaired.report.doubled_patch_faces_dropped.size(), repaired.report.components_flipped);
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
