#pragma once

#include <echinus/particle_collision.hpp>
#include <echinus/soft_body.hpp>
#include <echinus/surface_collision.hpp>

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace echinus {

/// The name of a collider in errors.
inline std::string name_of(const Collider& collider, std::size_t number) {
    return collider.name.empty() ? "collider " + std::to_string(number) : collider.name;
}

[[noreturn]] void refuse_mesh(const std::string& sentence); ///< throws Error InvalidMesh

// Each throws Error InvalidOptions with a sentence that names the field or the index at fault.

void require_option(bool condition, const std::string& sentence);
/// NaN is outside every range.
void require_within(const char* name, double value, double least, double most);
void require_within(const char* name, const std::optional<double>& value, double least, double most);
void require_within(const char* name, std::span<const double> values, double least, double most);
/// In the caller's unit; equal to the limit for simulations in bindings/options.toml.
inline constexpr double kMostThickness = 1e9;
/// Checks each number that has a range in bindings/options.toml.
/// @param name  of an option that only `solver` has, which is not the chosen solver
/// @throws Error InvalidOptions unless the option has its default
void require_default(const char* name, bool is_default, const char* solver);
void require_ranges(const MeshClothOptions& options);
void require_ranges(const SoftBodyOptions& options);
void require_ranges(const SimulationOptions& options);
void require_ranges(const ParticleCollisionOptions& options);
void require_ranges(const SurfaceCollisionOptions& options);
void require_valid(const SimulationOptions& options);
void require_valid(const Deformable& deformable);
void require_solver(const Deformable& deformable, const SimulationOptions& options);
void require_valid(const std::vector<Collider>& colliders, const SimulationOptions& options);
/// @pre the deformable is valid
void require_valid_attachments(const Deformable& deformable, std::size_t collider_count);
void require_valid_filters(const Deformable& deformable, std::size_t collider_count);
/// @param owner  of the pose; begins the sentence: "collider 0"
void require_valid(const RigidTransform& pose, const std::string& owner);

/// @param owner  of the keys: "collider 0"
void require_valid(const std::vector<PoseKey>& keys, const std::string& owner);
/// @pre the deformable is valid except for its handles
void require_valid_handles(const Deformable& deformable);

/// The name of a collider's cache in errors.
std::string name_of(const VertexCache& cache);
/// @param vertex_count  of the collider's mesh
void require_valid(const VertexCache& cache, std::size_t vertex_count, const std::string& owner);

} // namespace echinus
