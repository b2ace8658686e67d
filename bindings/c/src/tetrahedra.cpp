#include "border.hpp"
#include "handles.hpp"
#include "options.hpp"

#include <echinus/mesh_io.hpp>

#include <array>
#include <memory>
#include <utility>
#include <vector>

struct echinus_embedding {
    echinus::Embedding value;
    std::size_t vertex_count; ///< of the body
};

namespace echinus::c {

static_assert(sizeof(Tetrahedron) == 4 * sizeof(std::uint32_t));
ECHINUS_REQUIRE_NO_PADDING_AFTER(echinus_tetrahedra_file_report, dropped_vertices);
ECHINUS_REQUIRE_NO_PADDING_AFTER(echinus_tetrahedralize_report, removed_tetrahedra);
ECHINUS_REQUIRE_NO_PADDING_AFTER(echinus_tetrahedra_report, greatest_angle_deg);
ECHINUS_REQUIRE_NO_PADDING_AFTER(echinus_boundary_distance, greatest_to_boundary);

namespace {

const TetrahedralMesh& body_at(const echinus_tetrahedra* body) {
    return at(body, "body").value;
}

TetrahedralMesh body_from(const float* vertices, std::size_t vertex_count, std::size_t vertex_stride,
                          const std::uint32_t* tetrahedra, std::size_t tetrahedron_count) {
    TetrahedralMesh mesh{points_from(vertices, vertex_count, vertex_stride, "vertices"), {}};
    const std::span<const std::uint32_t> corners =
        values_at(tetrahedra, times(tetrahedron_count, 4, "tetrahedra"), "tetrahedra");
    for (std::size_t i = 0; i < corners.size(); i += 4)
        mesh.tetrahedra.push_back({corners[i], corners[i + 1], corners[i + 2], corners[i + 3]});
    require_valid_tetrahedra(mesh);
    return mesh;
}

echinus_tetrahedra_report describe(const TetrahedralReport& report) {
    return {.size = 0,
            .tetrahedron_count = report.tetrahedron_count,
            .vertex_count = report.vertex_count,
            .volume = report.volume,
            .least_volume = report.least_volume,
            .shortest_edge = report.shortest_edge,
            .longest_edge = report.longest_edge,
            .least_angle_deg = report.least_angle_deg,
            .greatest_angle_deg = report.greatest_angle_deg};
}

} // namespace

} // namespace echinus::c

using namespace echinus;
using namespace echinus::c;

echinus_status echinus_tetrahedra_create(const float* vertices, size_t vertex_count, size_t vertex_stride,
                                         const uint32_t* tetrahedra, size_t tetrahedron_count,
                                         echinus_tetrahedra** body) {
    return make(__func__, body, [&] {
        return body_from(vertices, vertex_count, vertex_stride, tetrahedra, tetrahedron_count);
    });
}

echinus_status echinus_tetrahedra_read(const char* path, echinus_tetrahedra** body,
                                       echinus_tetrahedra_file_report* report) {
    return make(__func__, body, [&] {
        TetrahedraFile file = read_tetrahedra(utf8_path(&at(path, "path")));
        if (report != nullptr)
            write_struct(report,
                         {.size = 0,
                          .turned_tetrahedra = file.turned_tetrahedra,
                          .dropped_vertices = file.dropped_vertices},
                         "report");
        return std::move(file.mesh);
    });
}
echinus_status echinus_tetrahedra_write(const echinus_tetrahedra* body, const char* path) {
    return guarded(__func__, [&] { write_tetrahedra(utf8_path(&at(path, "path")), body_at(body)); });
}

echinus_status echinus_tetrahedra_box(const double* size, const uint32_t* segments,
                                      echinus_tetrahedra** body) {
    return make(__func__, body, [&] {
        require_address(size, "size");
        require_address(segments, "segments");
        return make_solid_box({size[0], size[1], size[2]}, {segments[0], segments[1], segments[2]});
    });
}

echinus_status echinus_tetrahedralize(const echinus_map* model, const echinus_tetrahedralize_options* options,
                                      echinus_tetrahedra** body, echinus_tetrahedralize_report* report) {
    return make(__func__, body, [&] {
        const ExactMap& map = exact_map_at(model);
        Tetrahedralization made = tetrahedralize(map.view(), options_from(&at(options, "options")));
        if (report != nullptr)
            write_struct(
                report, {.size = 0, .lattice_size = made.size, .removed_tetrahedra = made.removed_tetrahedra},
                "report");
        return std::move(made.mesh);
    });
}

void echinus_tetrahedra_destroy(echinus_tetrahedra* body) {
    delete body;
}

size_t echinus_tetrahedra_vertex_count(const echinus_tetrahedra* body) {
    return body == nullptr ? 0 : body->value.vertices.size();
}
const float* echinus_tetrahedra_vertices(const echinus_tetrahedra* body) {
    return body == nullptr ? nullptr : reinterpret_cast<const float*>(body->value.vertices.data());
}
const double* echinus_tetrahedra_origin(const echinus_tetrahedra* body) {
    return body == nullptr ? nullptr : &body->value.origin.x;
}
size_t echinus_tetrahedra_count(const echinus_tetrahedra* body) {
    return body == nullptr ? 0 : body->value.tetrahedra.size();
}
const uint32_t* echinus_tetrahedra_indices(const echinus_tetrahedra* body) {
    return body == nullptr ? nullptr : reinterpret_cast<const uint32_t*>(body->value.tetrahedra.data());
}

echinus_status echinus_tetrahedra_inspect(const echinus_tetrahedra* body, echinus_tetrahedra_report* report) {
    return guarded(__func__,
                   [&] { write_struct(report, describe(inspect_tetrahedra(body_at(body))), "report"); });
}
echinus_status echinus_tetrahedra_boundary(const echinus_tetrahedra* body, echinus_mesh** mesh) {
    return make(__func__, mesh, [&] { return boundary(body_at(body)); });
}
echinus_status echinus_tetrahedra_measure_distance(const echinus_tetrahedra* body, const echinus_map* model,
                                                   uint32_t thread_count,
                                                   echinus_boundary_distance* distance) {
    return guarded(__func__, [&] {
        const BoundaryDistance found =
            measure_distance(body_at(body), exact_map_at(model).view(), thread_count);
        write_struct(distance,
                     {.size = 0,
                      .mean_to_model = found.mean_to_model,
                      .greatest_to_model = found.greatest_to_model,
                      .mean_to_boundary = found.mean_to_boundary,
                      .greatest_to_boundary = found.greatest_to_boundary},
                     "distance");
    });
}

// ---- Points that move with a body

echinus_status echinus_embedding_create(const echinus_tetrahedra* body, const float* points, size_t count,
                                        size_t stride, uint32_t thread_count, echinus_embedding** embedding) {
    if (embedding != nullptr) *embedding = nullptr;
    return guarded(__func__, [&] {
        at(embedding, "the place for the result");
        const TetrahedralMesh& mesh = body_at(body);
        Embedding found = embed(mesh, batch_at<Vec3f>(points, count, stride, "points"), thread_count);
        *embedding = new echinus_embedding{std::move(found), mesh.vertices.size()};
    });
}

void echinus_embedding_destroy(echinus_embedding* embedding) {
    delete embedding;
}

size_t echinus_embedding_count(const echinus_embedding* embedding) {
    return embedding == nullptr ? 0 : embedding->value.size();
}

echinus_status echinus_embedding_carry(const echinus_embedding* embedding, const float* positions,
                                       size_t position_count, size_t position_stride, uint32_t thread_count,
                                       float* points) {
    return guarded(__func__, [&] {
        const echinus_embedding& carried = at(embedding, "embedding");
        if (position_count != carried.vertex_count)
            throw WrongArgument("position_count is " + std::to_string(position_count) + "; the body has " +
                                std::to_string(carried.vertex_count) + " vertices");
        const std::span<Vec3f> places =
            values_at(reinterpret_cast<Vec3f*>(points), carried.value.size(), "points");
        carry(carried.value, batch_at<Vec3f>(positions, position_count, position_stride, "positions"), places,
              thread_count);
    });
}
