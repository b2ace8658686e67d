// Queries of triangles against the surface of an exact map.

#include "handles.hpp"

#include <echinus/surface_queries.hpp>

#include <algorithm>

namespace echinus::c {

static_assert(sizeof(TrianglePoints) == 9 * sizeof(float));
static_assert(sizeof(echinus_clearance) == sizeof(Clearance) &&
              offsetof(echinus_clearance, distance) == offsetof(Clearance, distance) &&
              offsetof(echinus_clearance, face) == offsetof(Clearance, face));
static_assert(sizeof(echinus_triangle_sweep_hit) == sizeof(TriangleSweepHit) &&
              offsetof(echinus_triangle_sweep_hit, fraction) == offsetof(TriangleSweepHit, fraction) &&
              offsetof(echinus_triangle_sweep_hit, face) == offsetof(TriangleSweepHit, face));

namespace {

/// @throws WrongArgument for an index that is too large
void require_in_range(std::span<const Triangle> triangles, std::size_t vertex_count) {
    for (std::size_t i = 0; i < triangles.size(); ++i)
        if (std::ranges::max(triangles[i]) >= vertex_count)
            throw WrongArgument("triangle " + std::to_string(i) + " refers to vertex " +
                                std::to_string(std::ranges::max(triangles[i])) + " of " +
                                std::to_string(vertex_count));
}

} // namespace

} // namespace echinus::c

using namespace echinus;
using namespace echinus::c;

echinus_status echinus_map_intersects(const echinus_map* map, const float* triangles, size_t count,
                                      size_t stride, uint32_t thread_count, uint8_t* intersecting) {
    return guarded(__func__, [&] {
        const ExactMapView& view = exact_map_at(map).view();
        const auto batch = batch_at<TrianglePoints>(triangles, count, stride, "triangles");
        const std::span<uint8_t> answers = values_at(intersecting, count, "intersecting");
        intersects_batch(view, batch, answers, thread_count);
    });
}

echinus_status echinus_map_clearance(const echinus_map* map, const float* triangles, size_t count,
                                     size_t stride, float farthest, uint32_t thread_count,
                                     echinus_clearance* clearances) {
    return guarded(__func__, [&] {
        const ExactMapView& view = exact_map_at(map).view();
        not_negative(farthest, "farthest");
        const auto batch = batch_at<TrianglePoints>(triangles, count, stride, "triangles");
        const auto answers = values_at(reinterpret_cast<Clearance*>(clearances), count, "clearances");
        clearance_batch(view, batch, farthest, answers, thread_count);
    });
}

echinus_status echinus_map_sweep_triangles(const echinus_map* map, const float* from, size_t from_stride,
                                           const float* to, size_t to_stride, size_t count,
                                           uint32_t thread_count, echinus_triangle_sweep_hit* hits) {
    return guarded(__func__, [&] {
        const ExactMapView& view = exact_map_at(map).view();
        const auto starts = batch_at<TrianglePoints>(from, count, from_stride, "from");
        const auto ends = batch_at<TrianglePoints>(to, count, to_stride, "to");
        const auto found = values_at(reinterpret_cast<TriangleSweepHit*>(hits), count, "hits");
        sweep_batch(view, starts, ends, found, thread_count);
    });
}

echinus_status echinus_map_faces_within(const echinus_map* map, const float* vertices, size_t vertex_count,
                                        size_t vertex_stride, const uint32_t* triangles,
                                        size_t triangle_count, float reach, uint32_t thread_count,
                                        echinus_array** offsets, echinus_array** faces) {
    if (offsets != nullptr) *offsets = nullptr;
    if (faces != nullptr) *faces = nullptr;
    return guarded(__func__, [&] {
        at(offsets, "offsets");
        at(faces, "faces");
        const ExactMapView& view = exact_map_at(map).view();
        const auto corners = faces_from(triangles, triangle_count, "triangles");
        require_in_range(corners, vertex_count);
        FaceLists lists;
        faces_within_batch(view, batch_at<Vec3f>(vertices, vertex_count, vertex_stride, "vertices"), corners,
                           not_negative(reach, "reach"), lists, thread_count);
        auto begins = std::make_unique<echinus_array>(array_of(std::move(lists.offsets)));
        *faces = new echinus_array(array_of(std::move(lists.faces)));
        *offsets = begins.release();
    });
}
