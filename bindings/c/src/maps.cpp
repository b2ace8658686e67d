// Maps: build, look at, destroy.

#include "map.hpp"
#include "mesh.hpp"

namespace echinus::c {

ECHINUS_REQUIRE_NO_PADDING_AFTER(echinus_exact_map_options, reserved);
template <>
inline constexpr std::size_t kFirstSize<echinus_exact_map_options> = offsetof(echinus_exact_map_options,
                                                                              find_certain_gaps);
ECHINUS_REQUIRE_NO_PADDING_AFTER(echinus_distance_map_options, reserved);
ECHINUS_REQUIRE_NO_PADDING_AFTER(echinus_map_info, origin);
template <>
inline constexpr std::size_t kFirstSize<echinus_map_info> = offsetof(echinus_map_info, origin);
ECHINUS_REQUIRE_NO_PADDING_AFTER(echinus_exact_map_statistics, reserved);
ECHINUS_REQUIRE_NO_PADDING_AFTER(echinus_distance_map_statistics, wrong_parity_share);

static_assert(ECHINUS_INSIDE_PARITY == static_cast<int>(InsideRule::Parity) &&
              ECHINUS_CENTRE_SEARCH == static_cast<int>(CentreChoice::Search) &&
              ECHINUS_GRID_OCTAHEDRAL == static_cast<int>(DirectionGrid::Octahedral) &&
              ECHINUS_GRID_CUBE == static_cast<int>(DirectionGrid::Cube) &&
              ECHINUS_GRID_ELLIPSOIDAL == static_cast<int>(DirectionGrid::Ellipsoidal) &&
              ECHINUS_CORRECTION_PAPER == static_cast<int>(VertexCorrection::Paper) &&
              ECHINUS_CORRECTION_SIGNED == static_cast<int>(VertexCorrection::Signed) &&
              ECHINUS_ENTRY_UNORM16 == static_cast<int>(EntryFormat::Unorm16) &&
              ECHINUS_POLE_Y == static_cast<int>(PoleAxis::Y) &&
              ECHINUS_POLE_Z == static_cast<int>(PoleAxis::Z));

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

echinus_exact_map_options as_c(const ExactMapOptions& options) {
    return {.size = 0,
            .divisions = options.divisions,
            .thread_count = options.thread_count,
            .byte_budget = options.byte_budget,
            .rule = static_cast<echinus_inside_rule>(options.rule),
            .centre = static_cast<echinus_centre_choice>(options.centre),
            .find_certain_gaps = options.find_certain_gaps,
            .reserved = 0};
}

ExactMapOptions options_from(const echinus_exact_map_options* options) {
    if (options == nullptr) return {};
    const auto given = read_struct(options, as_c(ExactMapOptions{}), "options");
    require_unused(given.reserved);
    return {.divisions = given.divisions,
            .byte_budget = given.byte_budget,
            .rule = enumerator(given.rule, InsideRule::Parity, "options.rule"),
            .centre = enumerator(given.centre, CentreChoice::Search, "options.centre"),
            .find_certain_gaps = flag(given.find_certain_gaps, "options.find_certain_gaps"),
            .thread_count = given.thread_count};
}

echinus_distance_map_options as_c(const DistanceMapOptions& options) {
    return {.size = 0,
            .grid = static_cast<echinus_direction_grid>(options.grid),
            .longitude_count = options.longitude_count,
            .colatitude_count = options.colatitude_count,
            .divisions = options.divisions,
            .correction = static_cast<echinus_vertex_correction>(options.correction),
            .entry_format = static_cast<echinus_entry_format>(options.entry_format),
            .pole_axis = static_cast<echinus_pole_axis>(options.pole_axis),
            .centre = static_cast<echinus_centre_choice>(options.centre),
            .thread_count = options.thread_count,
            .reserved = 0};
}

DistanceMapOptions options_from(const echinus_distance_map_options* options) {
    if (options == nullptr) return {};
    const auto given = read_struct(options, as_c(DistanceMapOptions{}), "options");
    require_unused(given.reserved);
    return {.grid = enumerator(given.grid, DirectionGrid::Ellipsoidal, "options.grid"),
            .longitude_count = given.longitude_count,
            .colatitude_count = given.colatitude_count,
            .divisions = given.divisions,
            .correction = enumerator(given.correction, VertexCorrection::Signed, "options.correction"),
            .entry_format = enumerator(given.entry_format, EntryFormat::Unorm16, "options.entry_format"),
            .pole_axis = enumerator(given.pole_axis, PoleAxis::Z, "options.pole_axis"),
            .centre = enumerator(given.centre, CentreChoice::Search, "options.centre"),
            .thread_count = given.thread_count};
}

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

void echinus_exact_map_options_init(echinus_exact_map_options* options, size_t size) {
    init_struct(options, size, as_c(ExactMapOptions{}));
}
void echinus_distance_map_options_init(echinus_distance_map_options* options, size_t size) {
    init_struct(options, size, as_c(DistanceMapOptions{}));
}

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
