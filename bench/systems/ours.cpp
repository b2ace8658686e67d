#include "systems/systems.hpp"
#include "systems/ways.hpp"

#include <echinus/distance_map.hpp>
#include <echinus/exact_map.hpp>

using namespace echinus;

namespace {

/// @param divisions  as in ExactMapOptions
System exact_map(Task task, const TriangleMesh& mesh, std::uint32_t divisions) {
    return system_for(task, "exact map", Role::Ours, [=, &mesh] {
        return std::make_shared<ExactMap>(ExactMap::build(mesh, {.divisions = divisions, .thread_count = 1}));
    });
}

/// @param count  spherical: samples along each of the two angles; octahedral: divisions of an edge
System distance_map(Task task, const TriangleMesh& mesh, DirectionGrid grid, std::uint32_t count) {
    DistanceMapOptions options;
    options.grid = grid;
    options.longitude_count = options.colatitude_count = options.divisions = count;
    options.thread_count = 1;
    return system_for(
        task, grid == DirectionGrid::Octahedral ? "octahedral distance map" : "distance map", Role::Ours,
        [=, &mesh] { return std::make_shared<DistanceMap>(DistanceMap::build(mesh, options)); });
}

} // namespace

std::vector<System> systems_for(Task task, const Subject& subject) {
    const TriangleMesh& mesh = subject.mesh;
    const DistanceMapOptions defaults;
    std::vector<System> list{
        exact_map(task, mesh, ExactMapOptions{}.divisions),
        distance_map(task, mesh, DirectionGrid::Spherical, defaults.longitude_count),
        distance_map(task, mesh, DirectionGrid::Octahedral, defaults.divisions),
    };
    list_rivals(task, subject, list);
    return list;
}

std::vector<System> sizes_for(Task task, const TriangleMesh& mesh) {
    std::vector<System> list;
    for (const std::uint32_t divisions : {8U, 12U, 16U, 24U, 32U, 48U, 64U, 96U})
        list.push_back(exact_map(task, mesh, divisions));
    for (const std::uint32_t count : {50U, 100U, 200U, 400U, 800U})
        list.push_back(distance_map(task, mesh, DirectionGrid::Spherical, count));
    for (const std::uint32_t count : {25U, 50U, 100U, 200U, 400U})
        list.push_back(distance_map(task, mesh, DirectionGrid::Octahedral, count));
    list_sizes_of_rivals(task, mesh, list);
    return list;
}
