#pragma once

#include "common/system.hpp"

#include <echinus/mesh.hpp>

namespace echinus {
class DistanceMap;
class ExactMap;
namespace rivals {
class ClassifiedGrid;
class DenseGrid;
} // namespace rivals
} // namespace echinus
class BulletRival;
class CgalRival;
class EmbreeRival;
class FclRival;
class NanoVdbRival;
class OpenVdbRival;

// How each system is asked which particles are inside: a function for each file of contains/.

Ways contains_ways(const echinus::ExactMap& map, std::size_t point_count);
Ways contains_ways(const echinus::DistanceMap& map, std::size_t point_count);
Ways contains_ways(const echinus::rivals::ClassifiedGrid& grid, std::size_t point_count);
Ways contains_ways(const echinus::rivals::DenseGrid& grid, std::size_t point_count);
Ways contains_ways(const NanoVdbRival& grid, std::size_t point_count);
Ways contains_ways(const OpenVdbRival& grid, std::size_t point_count);
Ways contains_ways(const EmbreeRival& embree, std::size_t point_count);
Ways contains_ways(const CgalRival& cgal, std::size_t point_count);
Ways contains_ways(const BulletRival& bullet, std::size_t point_count);
Ways contains_ways(const FclRival& fcl, std::size_t point_count);

/// What every system pays, as two systems.
void list_floors(const echinus::TriangleMesh& mesh, std::vector<System>& list);

// And how for contacts: a function for each file of contacts/.

Ways contacts_ways(const echinus::ExactMap& map, std::size_t point_count);
Ways contacts_ways(const echinus::DistanceMap& map, std::size_t point_count);
Ways contacts_ways(const echinus::rivals::ClassifiedGrid& grid, std::size_t point_count);
Ways contacts_ways(const echinus::rivals::DenseGrid& grid, std::size_t point_count);
Ways contacts_ways(const NanoVdbRival& grid, std::size_t point_count);
Ways contacts_ways(const OpenVdbRival& grid, std::size_t point_count);
Ways contacts_ways(const EmbreeRival& embree, std::size_t point_count);
Ways contacts_ways(const CgalRival& cgal, std::size_t point_count);
Ways contacts_ways(const FclRival& fcl, std::size_t point_count);

// ---- For the lists

/// Asks for the sign alone.
inline constexpr auto kForSigns = [](const auto& holder, std::size_t point_count) {
    return contains_ways(holder, point_count);
};

/// A system that takes part in both tasks, asked for one of them.
template <typename Build>
System system_for(Task task, std::string name, Role role, Build build) {
    if (task == Task::Contains) return system_of(std::move(name), role, build, kForSigns);
    return system_of(std::move(name), role, build, [](const auto& holder, std::size_t point_count) {
        return contacts_ways(holder, point_count);
    });
}
