#include "border.hpp"
#include "handles.hpp"

#include <echinus/mesh_io.hpp>

#include <cmath>
#include <cstring>
#include <memory>
#include <vector>

namespace echinus::c {

ECHINUS_REQUIRE_NO_PADDING_AFTER(echinus_vertex_cache_info, samples);

namespace {

VertexCache cache_from(const float* samples, std::size_t sample_count, std::size_t vertex_count,
                       double start_time, double sample_seconds) {
    require(sample_count > 0 && vertex_count > 0, "samples: there is none, or it has no vertex");
    require(std::isfinite(start_time), "start_time is not finite");
    require(std::isfinite(sample_seconds) && sample_seconds > 0, "sample_seconds is not positive and finite");
    const std::size_t count = times(sample_count, vertex_count, "samples");
    return {.start_time = start_time,
            .sample_seconds = sample_seconds,
            .vertex_count = vertex_count,
            .samples = std::make_shared<const std::vector<Vec3f>>(points_from(samples, count, 0, "samples"))};
}

} // namespace

} // namespace echinus::c

using namespace echinus;
using namespace echinus::c;

echinus_status echinus_vertex_cache_create(const float* samples, size_t sample_count, size_t vertex_count,
                                           double start_time, double sample_seconds,
                                           echinus_vertex_cache** cache) {
    return make(__func__, cache,
                [&] { return cache_from(samples, sample_count, vertex_count, start_time, sample_seconds); });
}

echinus_status echinus_vertex_cache_read(const char* path, const echinus_mesh* mesh, double frames_per_second,
                                         echinus_vertex_cache** cache) {
    return make(__func__, cache, [&] {
        require(std::isfinite(frames_per_second) && frames_per_second > 0,
                "frames_per_second is not positive and finite");
        return read_vertex_cache(utf8_path(&at(path, "path")), at(mesh, "mesh").value, frames_per_second);
    });
}

void echinus_vertex_cache_destroy(echinus_vertex_cache* cache) {
    delete cache;
}

echinus_status echinus_vertex_cache_describe(const echinus_vertex_cache* cache,
                                             echinus_vertex_cache_info* info) {
    return guarded(__func__, [&] {
        const VertexCache& described = at(cache, "cache").value;
        write_struct(info,
                     {.size = 0,
                      .sample_count = described.sample_count(),
                      .vertex_count = described.vertex_count,
                      .start_time = described.start_time,
                      .sample_seconds = described.sample_seconds,
                      .samples = reinterpret_cast<const float*>(described.samples->data())},
                     "info");
    });
}

echinus_status echinus_vertex_cache_at(const echinus_vertex_cache* cache, double seconds, float* vertices) {
    return guarded(__func__, [&] {
        const VertexCache& sampled = at(cache, "cache").value;
        require(std::isfinite(seconds), "seconds is not finite");
        require_address(vertices, "vertices");
        const std::vector<Vec3f> places = vertices_at(sampled, seconds);
        std::memcpy(vertices, places.data(), places.size() * sizeof(Vec3f));
    });
}
