// Maps: building, inspecting, destroying, writing and reading.

#include "handles.hpp"
#include "options.hpp"

#include <echinus/map_file.hpp>

namespace echinus::c {

ECHINUS_REQUIRE_NO_PADDING_AFTER(echinus_map_info, origin);
template <>
inline constexpr std::size_t kFirstSize<echinus_map_info> = offsetof(echinus_map_info, origin);
ECHINUS_REQUIRE_NO_PADDING_AFTER(echinus_exact_map_statistics, reserved);
ECHINUS_REQUIRE_NO_PADDING_AFTER(echinus_distance_map_statistics, wrong_parity_share);

const ExactMap& exact_map_at(const echinus_map* map) {
    if (const auto* exact = std::get_if<ExactMap>(&at(map, "map").value.kind)) return *exact;
    throw WrongArgument("map is not an exact map, and only an exact map can answer this");
}
const DistanceMap& distance_map_at(const echinus_map* map) {
    if (const auto* distance = std::get_if<DistanceMap>(&at(map, "map").value.kind)) return *distance;
    throw WrongArgument("map is not a distance map");
}

AnyMap any_map_at(const echinus_map* map) {
    const ColliderMap::Kind& kind = at(map, "map").value.kind;
    if (const auto* exact = std::get_if<ExactMap>(&kind)) return *exact;
    if (const auto* distance = std::get_if<DistanceMap>(&kind)) return *distance;
    throw WrongArgument("map is a custom map, which has no bytes to write");
}

namespace {

template <typename Map>
echinus_map_info describe(const Map& map, echinus_map_kind kind) {
    echinus_map_info info{};
    info.kind = kind;
    put_vector(map.view().centre, info.centre);
    info.radius = map.view().radius;
    info.face_count = map.statistics().face_count;
    info.byte_count = map.view().byte_count();
    info.source_hash = map.source_hash();
    put_vector(map.view().origin, info.origin);
    return info;
}

echinus_map_info describe(const ColliderMap& map) {
    if (const auto* exact = std::get_if<ExactMap>(&map.kind)) return describe(*exact, ECHINUS_MAP_EXACT);
    if (const auto* distance = std::get_if<DistanceMap>(&map.kind))
        return describe(*distance, ECHINUS_MAP_DISTANCE);
    echinus_map_info info{};
    info.kind = ECHINUS_MAP_CUSTOM;
    return info;
}

/// A mesh, and a number for each face.
struct Surface {
    TriangleMesh mesh;
    std::vector<std::uint32_t> classes;
};

Surface surface_of(const ExactMap& map) {
    ExactMapSurface surface = reconstruct_surface(map.view());
    return {std::move(surface.mesh), std::move(surface.longest_list)};
}
Surface surface_of(const DistanceMap& map) {
    MapSurface surface = reconstruct_surface(map.view());
    return {std::move(surface.mesh), std::move(surface.layer)};
}

} // namespace

} // namespace echinus::c

using namespace echinus;
using namespace echinus::c;

echinus_status echinus_map_build_exact(const echinus_mesh* mesh, const echinus_exact_map_options* options,
                                       echinus_map** map) {
    return make(__func__, map, [&]() -> ColliderMap {
        return ExactMap::build(at(mesh, "mesh").value, options_from(options));
    });
}
echinus_status echinus_map_build_distance(const echinus_mesh* mesh,
                                          const echinus_distance_map_options* options, echinus_map** map) {
    return make(__func__, map, [&]() -> ColliderMap {
        return DistanceMap::build(at(mesh, "mesh").value, options_from(options));
    });
}

void echinus_map_destroy(echinus_map* map) {
    delete map;
}

echinus_status echinus_map_describe(const echinus_map* map, echinus_map_info* info) {
    return guarded(__func__, [&] { write_struct(info, describe(at(map, "map").value), "info"); });
}

echinus_status echinus_map_exact_statistics(const echinus_map* map,
                                            echinus_exact_map_statistics* statistics) {
    return guarded(__func__, [&] {
        const ExactMapStatistics& found = exact_map_at(map).statistics();
        write_struct(statistics,
                     {.size = 0,
                      .face_count = found.face_count,
                      .dropped_faces = found.dropped_faces,
                      .longest_list = found.longest_list,
                      .mean_list = found.mean_list,
                      .expected_tests = found.expected_tests,
                      .certain_share = found.certain_share,
                      .uncertain_directions = found.uncertain_directions,
                      .reserved = 0},
                     "statistics");
    });
}
echinus_status echinus_map_distance_statistics(const echinus_map* map,
                                               echinus_distance_map_statistics* statistics) {
    return guarded(__func__, [&] {
        const DistanceMapStatistics& found = distance_map_at(map).statistics();
        write_struct(statistics,
                     {.size = 0,
                      .face_count = found.face_count,
                      .dropped_faces = found.dropped_faces,
                      .max_entries = found.max_entries,
                      .corrected_entries = found.corrected_entries,
                      .clamped_entries = found.clamped_entries,
                      .wrong_parity_share = found.wrong_parity_share},
                     "statistics");
    });
}

echinus_status echinus_map_surface(const echinus_map* map, echinus_mesh** mesh, echinus_array** classes) {
    if (mesh != nullptr) *mesh = nullptr;
    if (classes != nullptr) *classes = nullptr;
    return guarded(__func__, [&] {
        at(mesh, "mesh");
        with_map(map, [&](const auto& kind) {
            Surface surface = surface_of(kind);
            auto handle = std::unique_ptr<echinus_mesh>(new echinus_mesh{std::move(surface.mesh)});
            if (classes != nullptr) *classes = new echinus_array(array_of(std::move(surface.classes)));
            *mesh = handle.release();
        });
    });
}

// ---- The builder

echinus_status echinus_map_builder_create(const uint32_t* faces, size_t face_count,
                                          const echinus_exact_map_options* options,
                                          echinus_map_builder** builder) {
    return make(__func__, builder, [&] {
        return ExactMapBuilder(faces_from(faces, face_count, "faces"), options_from(options));
    });
}
echinus_status echinus_map_builder_rebuild(echinus_map_builder* builder, const float* vertices,
                                           size_t vertex_count, size_t vertex_stride, echinus_map** map) {
    return make(__func__, map, [&]() -> ColliderMap {
        return at(builder, "builder")
            .value.rebuild(points_from(vertices, vertex_count, vertex_stride, "vertices"));
    });
}
void echinus_map_builder_destroy(echinus_map_builder* builder) {
    delete builder;
}

namespace echinus::c {

namespace {

AnyMap view_of(const void* bytes, std::size_t byte_count, std::shared_ptr<const void> storage,
               const char* name) {
    const auto* first = static_cast<const std::byte*>(bytes);
    if (reinterpret_cast<std::uintptr_t>(first) % 8 != 0)
        throw WrongArgument("the address of bytes is not a multiple of 8");
    return load_map(values_at(first, byte_count, "bytes"), std::move(storage), &at(name, "name"));
}

} // namespace

} // namespace echinus::c

echinus_status echinus_map_save(const echinus_map* map, const char* path) {
    return guarded(__func__, [&] { save(any_map_at(map), utf8_path(&at(path, "path"))); });
}

echinus_status echinus_map_serialise(const echinus_map* map, echinus_array** bytes) {
    return make(__func__, bytes, [&] { return array_of(serialise(any_map_at(map))); });
}

echinus_status echinus_map_load(const char* path, echinus_map** map) {
    return make(__func__, map, [&]() -> ColliderMap { return load_map(utf8_path(&at(path, "path"))); });
}

echinus_status echinus_map_view(const void* bytes, size_t byte_count, void (*release)(void* context),
                                void* context, const char* name, echinus_map** map) {
    if (map != nullptr) *map = nullptr;
    return guarded(__func__, [&] {
        at(map, "the place for the result");
        const auto storage = std::make_shared<Release>(release, context);
        *map = new echinus_map{view_of(bytes, byte_count, storage, name)};
        storage->arm();
    });
}
