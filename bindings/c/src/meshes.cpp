#include "border.hpp"
#include "handles.hpp"
#include "options.hpp"

#include <echinus/intersections.hpp>
#include <echinus/mesh_io.hpp>
#include <echinus/surface_collision.hpp>

#include <algorithm>
#include <memory>
#include <utility>

namespace echinus::c {

static_assert(sizeof(Vec3f) == 3 * sizeof(float) && sizeof(Vec3d) == 3 * sizeof(double) &&
              sizeof(Triangle) == 3 * sizeof(std::uint32_t) && sizeof(FacePair) == 2 * sizeof(std::uint32_t));
ECHINUS_REQUIRE_NO_PADDING_AFTER(echinus_mesh_report, reserved);
ECHINUS_REQUIRE_NO_PADDING_AFTER(echinus_repair_report, seams_filled);
ECHINUS_REQUIRE_NO_PADDING_AFTER(echinus_part_report, largest_stretch);
template <>
inline constexpr std::size_t kFirstSize<echinus_mesh_report> = offsetof(echinus_mesh_report, rounding_step);
template <>
inline constexpr std::size_t kFirstSize<echinus_repair_report> = offsetof(echinus_repair_report,
                                                                          holes_closed);
static_assert(ECHINUS_FIRST_FACE_COUNT == Fault::kFirstFaceCount);

std::vector<Vec3f> points_from(const float* points, std::size_t count, std::size_t stride, const char* name) {
    const StridedSpan<const Vec3f> batch = batch_at<Vec3f>(points, count, stride, name);
    std::vector<Vec3f> result(count);
    for (std::size_t i = 0; i < count; ++i) result[i] = batch[i];
    return result;
}

std::vector<Triangle> faces_from(const std::uint32_t* faces, std::size_t count, const char* name) {
    const std::span<const std::uint32_t> corners = values_at(faces, times(count, 3, name), name);
    std::vector<Triangle> result(count);
    for (std::size_t i = 0; i < count; ++i)
        result[i] = {corners[3 * i], corners[3 * i + 1], corners[3 * i + 2]};
    return result;
}

namespace {

std::span<const Vec3d> doubles_at(const double* points, std::size_t count, const char* name) {
    return values_at(reinterpret_cast<const Vec3d*>(points), count, name);
}

const TriangleMesh& mesh_at(const echinus_mesh* mesh) {
    return at(mesh, "mesh").value;
}

echinus_fault describe(const Fault& fault) {
    echinus_fault result{};
    result.count = fault.count;
    result.first_face_count = static_cast<std::uint32_t>(fault.first_faces.size());
    std::copy(fault.first_faces.begin(), fault.first_faces.end(), result.first_faces);
    return result;
}

echinus_mesh_report describe(const MeshReport& report) {
    echinus_mesh_report result{};
    result.face_count = report.face_count;
    result.vertex_count = report.vertex_count;
    result.component_count = report.component_count;
    result.closed = report.closed ? 1 : 0;
    result.manifold = report.manifold ? 1 : 0;
    result.border_edges = describe(report.border_edges);
    result.nonmanifold_edges = describe(report.nonmanifold_edges);
    result.misoriented_edges = describe(report.misoriented_edges);
    result.duplicate_faces = describe(report.duplicate_faces);
    result.degenerate_faces = describe(report.degenerate_faces);
    result.signed_volume = report.signed_volume;
    put_vector(report.bounding_sphere.centre, result.centre);
    result.radius = report.bounding_sphere.radius;
    result.rounding_step = report.rounding_step;
    result.orientable = report.orientable ? 1 : 0;
    return result;
}

echinus_repair_report describe(const RepairReport& report) {
    return {.size = 0,
            .duplicate_faces_dropped = report.duplicate_faces_dropped.size(),
            .doubled_patch_faces_dropped = report.doubled_patch_faces_dropped.size(),
            .components_flipped = report.components_flipped,
            .holes_closed = report.holes_closed,
            .holes_left = report.holes_left,
            .inner_faces_dropped = report.inner_faces_dropped.size(),
            .sheets_thickened = report.sheets_thickened,
            .faces_added = report.faces_added,
            .vertices_welded = report.vertices_welded,
            .slivers_dropped = report.slivers_dropped.size(),
            .faces_turned = report.faces_turned,
            .seams_filled = report.seams_filled};
}

std::vector<std::uint32_t> dropped_faces(const RepairReport& report) {
    std::vector<std::uint32_t> result;
    for (const auto& faces : {report.duplicate_faces_dropped, report.doubled_patch_faces_dropped,
                              report.slivers_dropped, report.inner_faces_dropped})
        result.insert(result.end(), faces.begin(), faces.end());
    std::sort(result.begin(), result.end());
    return result;
}

/// The array for a result that the caller need not request.
template <typename T>
std::unique_ptr<echinus_array> array_unless_null(echinus_array** result, std::vector<T> values) {
    return result == nullptr ? nullptr : std::make_unique<echinus_array>(array_of(std::move(values)));
}

std::vector<echinus_intersection_curve> describe(const std::vector<IntersectionCurve>& curves) {
    std::vector<echinus_intersection_curve> result;
    for (const IntersectionCurve& curve : curves)
        result.push_back({static_cast<std::uint32_t>(curve.points.size()), curve.closed ? 1 : 0});
    return result;
}

std::vector<Vec3f> points_of(const std::vector<IntersectionCurve>& curves) {
    std::vector<Vec3f> points;
    for (const IntersectionCurve& curve : curves)
        points.insert(points.end(), curve.points.begin(), curve.points.end());
    return points;
}

echinus_penetration describe(const Penetration& penetration) {
    return {penetration.known ? 1 : 0, penetration.vertex_count, penetration.deepest_vertex,
            penetration.depth};
}

std::vector<TriangleMesh> meshes_at(const echinus_mesh* const* first, std::size_t count, const char* name) {
    std::vector<TriangleMesh> copies;
    for (const echinus_mesh* mesh : values_at(first, count, name)) copies.push_back(at(mesh, "a mesh").value);
    return copies;
}

echinus_part_report describe(const Parted& parted) {
    std::size_t model_pairs = 0;
    for (const std::vector<FacePair>& pairs : parted.model_pairs) model_pairs += pairs.size();
    return {.size = 0,
            .own_pairs = parted.own_pairs.size(),
            .model_pairs = model_pairs,
            .inside_count = parted.inside.size(),
            .stretched_share = parted.stretched_share,
            .largest_stretch = parted.largest_stretch};
}

std::vector<echinus_checked_meshes> describe(const std::vector<CheckedMeshes>& found) {
    std::vector<echinus_checked_meshes> result;
    for (const CheckedMeshes& pair : found)
        result.push_back({pair.a, pair.b, pair.found.pairs.size(), pair.found.curves.size(),
                          pair.found.length, describe(pair.a_in_b), describe(pair.b_in_a)});
    return result;
}

} // namespace

} // namespace echinus::c

using namespace echinus;
using namespace echinus::c;

echinus_status echinus_mesh_create(const float* vertices, size_t vertex_count, size_t vertex_stride,
                                   const uint32_t* faces, size_t face_count, echinus_mesh** mesh) {
    return make(__func__, mesh, [&] {
        TriangleMesh result{points_from(vertices, vertex_count, vertex_stride, "vertices"),
                            faces_from(faces, face_count, "faces")};
        require_valid(result);
        return result;
    });
}

echinus_status echinus_mesh_create_double(const double* vertices, size_t vertex_count, const uint32_t* faces,
                                          size_t face_count, echinus_mesh** mesh) {
    return make(__func__, mesh, [&] {
        TriangleMesh result = local_mesh(doubles_at(vertices, vertex_count, "vertices"),
                                         faces_from(faces, face_count, "faces"));
        require_valid(result);
        return result;
    });
}

echinus_status echinus_mesh_read(const char* path, echinus_mesh** mesh) {
    return make(__func__, mesh, [&] { return read_mesh(utf8_path(&at(path, "path"))); });
}

echinus_status echinus_mesh_write(const echinus_mesh* mesh, const char* path) {
    return guarded(__func__, [&] { write_mesh(utf8_path(&at(path, "path")), mesh_at(mesh)); });
}

echinus_status echinus_mesh_torus(double major_radius, double minor_radius, uint32_t major_segments,
                                  uint32_t minor_segments, echinus_mesh** mesh) {
    return make(__func__, mesh,
                [&] { return make_torus(major_radius, minor_radius, major_segments, minor_segments); });
}
echinus_status echinus_mesh_sphere(double radius, uint32_t meridian_count, uint32_t parallel_count,
                                   echinus_mesh** mesh) {
    return make(__func__, mesh, [&] { return make_sphere(radius, meridian_count, parallel_count); });
}
echinus_status echinus_mesh_box(const double* size, uint32_t segments, echinus_mesh** mesh) {
    return make(__func__, mesh, [&] {
        at(size, "size");
        return make_box({size[0], size[1], size[2]}, segments);
    });
}

void echinus_mesh_destroy(echinus_mesh* mesh) {
    delete mesh;
}

size_t echinus_mesh_vertex_count(const echinus_mesh* mesh) {
    return mesh == nullptr ? 0 : mesh->value.vertices.size();
}
const float* echinus_mesh_vertices(const echinus_mesh* mesh) {
    return mesh == nullptr ? nullptr : reinterpret_cast<const float*>(mesh->value.vertices.data());
}
const double* echinus_mesh_origin(const echinus_mesh* mesh) {
    return mesh == nullptr ? nullptr : &mesh->value.origin.x;
}
echinus_status echinus_to_local(const double* points, size_t count, const double* origin, float* local) {
    return guarded(__func__, [&] {
        const Vec3d& at_origin = reinterpret_cast<const Vec3d&>(at(origin, "origin"));
        const std::span<const Vec3d> from = doubles_at(points, count, "points");
        const std::span<Vec3f> to = values_at(reinterpret_cast<Vec3f*>(local), count, "local");
        for (std::size_t i = 0; i < count; ++i) to[i] = to_local(from[i], at_origin);
    });
}
size_t echinus_mesh_face_count(const echinus_mesh* mesh) {
    return mesh == nullptr ? 0 : mesh->value.faces.size();
}
const uint32_t* echinus_mesh_faces(const echinus_mesh* mesh) {
    return mesh == nullptr ? nullptr : reinterpret_cast<const uint32_t*>(mesh->value.faces.data());
}

echinus_status echinus_mesh_inspect(const echinus_mesh* mesh, echinus_mesh_report* report) {
    return guarded(__func__, [&] { write_struct(report, describe(inspect(mesh_at(mesh))), "report"); });
}

echinus_status echinus_mesh_repair(const echinus_mesh* mesh, const echinus_repair_options* options,
                                   echinus_mesh** repaired, echinus_repair_report* report,
                                   echinus_array** dropped) {
    if (repaired != nullptr) *repaired = nullptr;
    if (dropped != nullptr) *dropped = nullptr;
    return guarded(__func__, [&] {
        at(repaired, "repaired");
        RepairedMesh result = repair(mesh_at(mesh), options_from(&at(options, "options")));
        auto handle = std::unique_ptr<echinus_mesh>(new echinus_mesh{std::move(result.mesh)});
        if (report != nullptr) write_struct(report, describe(result.report), "report");
        if (dropped != nullptr) *dropped = new echinus_array(array_of(dropped_faces(result.report)));
        *repaired = handle.release();
    });
}

echinus_status echinus_mesh_part(const echinus_mesh* mesh, const echinus_mesh* const* models,
                                 size_t model_count, const uint8_t* pinned, const uint8_t* layers,
                                 double thickness, uint32_t thread_count, echinus_mesh** parted,
                                 echinus_part_report* report) {
    if (parted != nullptr) *parted = nullptr;
    return guarded(__func__, [&] {
        at(parted, "parted");
        TriangleMesh surface = mesh_at(mesh);
        PartOptions options{.thread_count = thread_count};
        if (thickness != 0) options.thickness = thickness;
        if (pinned != nullptr) options.pinned.assign(pinned, pinned + surface.vertices.size());
        if (layers != nullptr) options.layers.assign(layers, layers + surface.vertices.size());
        Parted result = part(surface, meshes_at(models, model_count, "models"), options);
        surface.vertices = std::move(result.vertices);
        auto handle = std::unique_ptr<echinus_mesh>(new echinus_mesh{std::move(surface)});
        if (report != nullptr) write_struct(report, describe(result), "report");
        *parted = handle.release();
    });
}

echinus_status echinus_mesh_weld(const echinus_mesh* mesh, echinus_mesh** welded) {
    return make(__func__, welded, [&] { return weld(mesh_at(mesh)); });
}

echinus_status echinus_mesh_winding_number(const echinus_mesh* mesh, const double* point,
                                           double* winding_number_of_point) {
    return guarded(__func__, [&] {
        at(point, "point");
        at(winding_number_of_point, "winding_number") =
            winding_number(mesh_at(mesh), {point[0], point[1], point[2]});
    });
}
echinus_status echinus_mesh_unsigned_distance(const echinus_mesh* mesh, const double* point,
                                              double* distance) {
    return guarded(__func__, [&] {
        at(point, "point");
        at(distance, "distance") = unsigned_distance(mesh_at(mesh), {point[0], point[1], point[2]});
    });
}

echinus_status echinus_mesh_intersecting_pairs(const echinus_mesh* a, const echinus_mesh* b,
                                               echinus_array** pairs) {
    return make(__func__, pairs,
                [&] { return array_of(intersecting_pairs(at(a, "a").value, at(b, "b").value)); });
}
echinus_status echinus_mesh_self_intersecting_pairs(const echinus_mesh* mesh, echinus_array** pairs) {
    return make(__func__, pairs, [&] { return array_of(self_intersecting_pairs(mesh_at(mesh))); });
}

echinus_status echinus_mesh_intersections(const echinus_mesh* a, const echinus_mesh* b, echinus_array** pairs,
                                          echinus_array** curves, echinus_array** points) {
    for (echinus_array** result : {pairs, curves, points})
        if (result != nullptr) *result = nullptr;
    return guarded(__func__, [&] {
        at(curves, "curves");
        at(points, "points");
        const TriangleMesh& mesh = at(a, "a").value;
        Intersections found = b == nullptr ? self_intersections(mesh) : intersections(mesh, b->value);
        auto own_pairs = array_unless_null(pairs, std::move(found.pairs));
        auto own_curves = array_unless_null(curves, describe(found.curves));
        *points = array_unless_null(points, points_of(found.curves)).release();
        *curves = own_curves.release();
        if (pairs != nullptr) *pairs = own_pairs.release();
    });
}

echinus_status echinus_check(const echinus_mesh* const* meshes, size_t mesh_count, uint32_t thread_count,
                             echinus_array** found) {
    return make(__func__, found, [&] {
        return array_of(
            describe(check(meshes_at(meshes, mesh_count, "meshes"), {.thread_count = thread_count})));
    });
}
