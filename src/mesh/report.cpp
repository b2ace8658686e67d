#include "geometry/union_find.hpp"
#include "mesh/faces.hpp"
#include "mesh/local_frame.hpp"
#include "mesh/require_valid.hpp"
#include "mesh/seams.hpp"

#include <echinus/mesh.hpp>

#include <algorithm>
#include <cmath>

namespace echinus {

namespace {

/// Sorts the faces, removes duplicates and keeps the first few.
Fault make_fault(std::size_t count, std::vector<std::uint32_t> faces) {
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    faces.resize(std::min(faces.size(), Fault::kFirstFaceCount));
    return {count, std::move(faces)};
}

Fault make_fault(const std::vector<std::uint32_t>& faces) {
    return make_fault(faces.size(), faces);
}

/// The edges with one kind of fault, and all faces at them.
struct EdgeFault {
    std::size_t count = 0;
    std::vector<std::uint32_t> faces;

    void add(std::span<const EdgeUse> uses) {
        ++count;
        for (const EdgeUse& use : uses) faces.push_back(use.face);
    }
    Fault finish() { return make_fault(count, std::move(faces)); }
};

void report_edges(std::span<const EdgeUse> edge_uses, MeshReport& report) {
    EdgeFault border;
    EdgeFault nonmanifold;
    EdgeFault misoriented;
    report.closed = true;
    for_each_edge(edge_uses, [&](std::span<const EdgeUse> uses) {
        if (uses.size() == 1) border.add(uses);
        if (uses.size() > 2) nonmanifold.add(uses);
        if (uses.size() == 2 && !is_balanced(uses)) misoriented.add(uses);
        report.closed = report.closed && is_balanced(uses);
    });
    report.border_edges = border.finish();
    report.nonmanifold_edges = nonmanifold.finish();
    report.misoriented_edges = misoriented.finish();
}

/// Do the faces at each vertex form one fan? Corners of two faces at the same vertex are joined if the faces
/// share an edge. A fan is then one set of corners, so there must be as many sets as vertices.
bool every_vertex_has_one_fan(const TriangleMesh& mesh, std::span<const EdgeUse> edge_uses) {
    UnionFind corners(3 * mesh.faces.size());
    const auto corner_at = [&](const EdgeUse& use, bool low) {
        return 3 * use.face + (use.ascending == low ? use.corner : (use.corner + 1U) % 3);
    };
    for_each_edge(edge_uses, [&](std::span<const EdgeUse> uses) {
        for (const EdgeUse& use : uses.subspan(1))
            for (bool low : {true, false}) corners.join(corner_at(uses[0], low), corner_at(use, low));
    });
    std::vector<bool> is_used(mesh.vertices.size(), false);
    for (const EdgeUse& use : edge_uses) { // each corner of a face begins one of its edges
        const std::uint32_t corner = 3 * use.face + use.corner;
        if (corners.find(corner) != corner) continue;
        const std::uint32_t vertex = mesh.faces[use.face][use.corner];
        if (is_used[vertex]) return false;
        is_used[vertex] = true;
    }
    return true;
}

/// Measured from a nearby point, so that no digits are lost if a mesh is far from the origin.
double signed_volume(const TriangleMesh& mesh, const Vec3d& reference) {
    double sum = 0;
    for (const Triangle& face : mesh.faces) sum += six_volumes(mesh, face, reference);
    return sum / 6;
}

/// Computes MeshReport::rounding_step.
double rounding_step(const TriangleMesh& mesh, double radius) {
    constexpr double kLatticeStep = 0x1p-19; // as a share of the radius: directions/lattice.hpp
    double largest = 0;
    for (const Triangle& face : mesh.faces)
        for (const std::uint32_t vertex : face) {
            const Vec3d p = Vec3d(mesh.vertices[vertex]) + mesh.origin;
            if (Vec3d(Vec3f(p)) != p) return 0;
            largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
        }
    const double rounding = float_rounding(largest);
    return rounding > radius * kLatticeStep ? 2 * rounding : 0;
}

bool is_orientable(std::span<const EdgeUse> edge_uses, std::size_t face_count) {
    const std::vector<bool> patches = find_orientation(edge_uses, face_count).is_orientable;
    return std::find(patches.begin(), patches.end(), false) == patches.end();
}

} // namespace

MeshReport inspect(const TriangleMesh& mesh_as_it_is) {
    require_valid(mesh_as_it_is);
    MeshReport report;
    report.face_count = mesh_as_it_is.faces.size();
    report.vertex_count = mesh_as_it_is.vertices.size();
    report.bounding_sphere = smallest_enclosing_sphere(used_positions(mesh_as_it_is));
    const TriangleMesh mesh = with_common_corners(mesh_as_it_is, seam_width(report.bounding_sphere.radius));
    report.component_count = find_components(mesh).count;
    const std::vector<EdgeUse> edge_uses = sorted_edge_uses(mesh);
    report_edges(edge_uses, report);
    report.manifold = report.nonmanifold_edges.count == 0 && every_vertex_has_one_fan(mesh, edge_uses);
    report.orientable = is_orientable(edge_uses, mesh.faces.size());
    report.duplicate_faces = make_fault(find_duplicate_faces(mesh));
    report.degenerate_faces = make_fault(find_degenerate_faces(mesh));
    report.signed_volume = signed_volume(mesh, report.bounding_sphere.centre);
    report.rounding_step = rounding_step(mesh, report.bounding_sphere.radius);
    return report;
}

} // namespace echinus
