#pragma once

// The values behind the handles of the C interface, and the conversions that several of its sources share.

#include "border.hpp"

#include <echinus/any_map.hpp>
#include <echinus/collider.hpp>
#include <echinus/echinus.h>
#include <echinus/mesh.hpp>
#include <echinus/simulation.hpp>
#include <echinus/tetrahedra.hpp>
#include <echinus_scene/scene.hpp>

#include <cstddef>
#include <filesystem>
#include <span>
#include <utility>
#include <vector>

struct echinus_mesh {
    echinus::TriangleMesh value;
};

/// Immutable. Copies share the arrays of a map.
struct echinus_map {
    echinus::ColliderMap value;
};
struct echinus_map_builder {
    echinus::ExactMapBuilder value;
};

/// Valid tetrahedra.
struct echinus_tetrahedra {
    echinus::TetrahedralMesh value;
};

struct echinus_deformable {
    echinus::Deformable value;
};

/// Has at least one sample and one vertex.
struct echinus_vertex_cache {
    echinus::VertexCache value;
};

struct echinus_scene {
    echinus::Scene value;
    std::filesystem::path folder; ///< the folder in which files of the scene may be
};

struct echinus_simulation {
    explicit echinus_simulation(echinus::Simulation simulation) : value(std::move(simulation)) {
        for (const echinus::Collider& collider : value.colliders()) maps.push_back({collider.map});
    }

    echinus::Simulation value;
    /// [collider_count] The maps of colliders that the caller has read, as they were at that time.
    mutable std::vector<echinus_map> maps;
    bool failed = false; ///< whether a step has failed; the simulation can then only be read
};

namespace echinus::c {

// ---- Meshes and deformables

/// Copies of a caller's arrays.
std::vector<Vec3f> points_from(const float* points, std::size_t count, std::size_t stride, const char* name);
std::vector<Triangle> faces_from(const std::uint32_t* faces, std::size_t count, const char* name);

/// The arrays of a deformable, without copying.
echinus_deformable_arrays arrays_of(const Deformable& deformable);

// ---- Maps and their answers

/// The answers have the layouts of C++, which writes them directly.
static_assert(sizeof(echinus_contact) == sizeof(Contact) &&
              offsetof(echinus_contact, point) == offsetof(Contact, point) &&
              offsetof(echinus_contact, normal) == offsetof(Contact, normal) &&
              offsetof(echinus_contact, depth) == offsetof(Contact, depth) &&
              offsetof(echinus_contact, face) == offsetof(Contact, face) &&
              offsetof(echinus_contact, inside) == offsetof(Contact, inside) &&
              offsetof(echinus_contact, certain) == offsetof(Contact, certain) &&
              offsetof(echinus_contact, feature) == offsetof(Contact, feature));
static_assert(sizeof(echinus_sweep_hit) == sizeof(SweepHit) &&
              offsetof(echinus_sweep_hit, fraction) == offsetof(SweepHit, fraction) &&
              offsetof(echinus_sweep_hit, point) == offsetof(SweepHit, point) &&
              offsetof(echinus_sweep_hit, normal) == offsetof(SweepHit, normal) &&
              offsetof(echinus_sweep_hit, face) == offsetof(SweepHit, face) &&
              offsetof(echinus_sweep_hit, entering) == offsetof(SweepHit, entering));

/// Calls a function of the caller when it is destroyed, if it has been armed; until then the caller owns the
/// resource.
class Release {
  public:
    Release(void (*function)(void*), void* context) : function_(function), context_(context) {}
    Release(const Release&) = delete;
    Release& operator=(const Release&) = delete;
    ~Release() {
        if (armed_ && function_ != nullptr) function_(context_);
    }
    void arm() { armed_ = true; }

  private:
    void (*function_)(void*);
    void* context_;
    bool armed_ = false;
};

/// @throws WrongArgument for a map of a different kind
const ExactMap& exact_map_at(const echinus_map* map);
const DistanceMap& distance_map_at(const echinus_map* map);

/// @throws WrongArgument for a custom map
AnyMap any_map_at(const echinus_map* map);

/// Calls body(map) with the exact map or the distance map.
/// @throws WrongArgument for a custom map
template <typename Body>
void with_map(const echinus_map* map, const Body& body) {
    const ColliderMap::Kind& kind = at(map, "map").value.kind;
    if (const auto* exact = std::get_if<ExactMap>(&kind)) return body(*exact);
    if (const auto* distance = std::get_if<DistanceMap>(&kind)) return body(*distance);
    throw WrongArgument("map is a custom map, which only colliders can query");
}

/// A margin, a reach or another search distance.
/// @throws WrongArgument unless it is 0 or more
inline float not_negative(float length, const char* name) {
    if (!(length >= 0))
        throw WrongArgument(std::string(name) + " is " + std::to_string(length) + "; expected 0 or more");
    return length;
}

inline std::span<Contact> contacts_at(echinus_contact* first, std::size_t count) {
    return values_at(reinterpret_cast<Contact*>(first), count, "contacts");
}
inline std::span<SweepHit> hits_at(echinus_sweep_hit* first, std::size_t count) {
    return values_at(reinterpret_cast<SweepHit*>(first), count, "hits");
}

// ---- Colliders

/// A pose without checks; the library checks it.
RigidTransform pose_from(const echinus_pose& pose);
echinus_pose pose_to_c(const RigidTransform& pose);

/// @throws WrongArgument unless it is finite and its rotation of unit length
RigidTransform checked_pose(const echinus_pose& pose, const char* name);

/// Keys without checks; a simulation checks them.
std::vector<PoseKey> keys_from(std::span<const echinus_pose_key> keys);

/// A collider for queries, which do not check it.
/// @throws WrongArgument for values that a query must not receive
Collider collider_at(const echinus_collider* collider);

/// A collider for a simulation, which checks it.
/// @throws WrongArgument for a null map
Collider collider_from(const echinus_collider& collider);
/// The same for an array of the caller's structs, which may be larger than the library's.
std::vector<Collider> colliders_from(const echinus_collider* first, std::size_t count);

} // namespace echinus::c
