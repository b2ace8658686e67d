#include "rivals/bullet.hpp"
#include "rivals/cgal.hpp"
#include "rivals/embree.hpp"
#include "rivals/fcl.hpp"
#include "rivals/systems/classified_grid/classified_grid.hpp"
#include "rivals/systems/dense_grid/dense_grid.hpp"
#include "rivals/vdb.hpp"
#include "systems/systems.hpp"
#include "systems/ways.hpp"

#include <echinus/distance_map.hpp>
#include <echinus/exact_map.hpp>

using namespace echinus;
using rivals::ClassifiedGrid;
using rivals::DenseGrid;

namespace {

System dense_grid(Task task, std::string name, const TriangleMesh& mesh, std::size_t bytes) {
    return system_for(task, std::move(name), Role::Rival,
                      [=, &mesh] { return std::make_shared<DenseGrid>(DenseGrid::with_bytes(mesh, bytes)); });
}

void list_dense_grids(Task task, const Subject& subject, std::vector<System>& list) {
    const TriangleMesh& mesh = subject.mesh;
    if (task == Task::Contacts) {
        const DistanceMap map = DistanceMap::build(mesh);
        list.push_back(
            dense_grid(task, "dense grid as many bytes as the distance map", mesh, map.view().byte_count()));
    }
    // The bytes that the paper gives for its map of the horse.
    list.push_back(dense_grid(task, "dense grid 0.63 MB", mesh, 630'000));
    if (subject.large) return;
    // As many samples across the bounding sphere as the paper's distance field has.
    list.push_back(
        system_for(task, "dense grid 2R/200", Role::Rival, [&mesh, spacing = subject.radius * 2 / 200] {
            return std::make_shared<DenseGrid>(DenseGrid::with_spacing(mesh, spacing));
        }));
}

System classified_grid(Task task, const TriangleMesh& mesh, std::size_t bytes) {
    return system_for(task, "classified grid", Role::Rival, [=, &mesh] {
        return std::make_shared<ClassifiedGrid>(ClassifiedGrid::build(mesh, bytes));
    });
}

/// A library's structure, which the mesh alone determines.
template <typename Rival>
System library(Task task, const char* name, const TriangleMesh& mesh) {
    return system_for(task, name, Role::Rival, [&mesh] { return std::make_shared<Rival>(mesh); });
}

} // namespace

void list_rivals(Task task, const Subject& subject, std::vector<System>& list) {
    const TriangleMesh& mesh = subject.mesh;
    const ExactMap map = ExactMap::build(mesh);
    list.push_back(classified_grid(task, mesh, map.view().byte_count()));
    list_dense_grids(task, subject, list);
#ifdef ECHINUS_BENCH_VDB
    if (!subject.large) {
        list.push_back(library<NanoVdbRival>(task, "NanoVDB 2R/200", mesh));
        list.push_back(library<OpenVdbRival>(task, "OpenVDB 2R/200", mesh));
    }
#endif
    list.push_back(library<EmbreeRival>(task, "Embree", mesh));
    if (!subject.large) {
        list.push_back(library<CgalRival>(task, "CGAL", mesh));
#ifdef ECHINUS_BENCH_BULLET
        if (task == Task::Contains) // it has no nearest point
            list.push_back(system_of(
                "Bullet", Role::Rival, [&mesh] { return std::make_shared<BulletRival>(mesh); }, kForSigns));
#endif
#ifdef ECHINUS_BENCH_FCL
        list.push_back(library<FclRival>(task, "FCL", mesh));
#endif
    }
    if (task == Task::Contains) list_floors(mesh, list);
}

void list_sizes_of_rivals(Task task, const TriangleMesh& mesh, std::vector<System>& list) {
    for (const std::size_t bytes : {40'000U, 160'000U, 630'000U, 2'500'000U, 6'400'000U})
        list.push_back(dense_grid(task, "dense grid", mesh, bytes));
    for (const std::size_t bytes : {170'000U, 220'000U, 280'000U, 400'000U, 800'000U, 1'600'000U})
        list.push_back(classified_grid(task, mesh, bytes));
}
