#pragma once

#include <echinus/export.hpp>
#include <echinus/geometry.hpp>
#include <echinus/simulation.hpp>
#include <echinus/tetrahedra.hpp>

#include <cstdint>
#include <span>
#include <vector>

ECHINUS_EXPORT_BEGIN

/// Soft bodies: organs, rubber, dough. docs/soft_bodies.md has the method, its limits and what was measured.
namespace echinus {

/// The material of a soft body, and where it starts. The numbers are in any units that fit together; with
/// metres and kilograms they are SI units, and gravity is -9.81.
struct SoftBodyOptions {
    double density = 1000;      ///< mass / length^3, of water in kg/m^3; positive
    double young_modulus = 1e4; ///< mass / (length s^2), in pascals; positive. Soft tissue has 1e3 to 1e5
    double poisson_ratio = 0.4; ///< 0 to 0.4999; towards 0.5 the volume is kept
    double damping = 0;         ///< viscosity over the shear modulus, seconds; not negative
    RigidTransform pose{};      ///< its rotation of unit length, to 1e-4
    double scale = 1;           ///< a vertex starts at pose.to_world(scale * vertex); positive
    std::vector<std::uint32_t> pins{};     ///< vertices that never move
    std::vector<Attachment> attachments{}; ///< vertices that move with a collider
};

/// A body at rest. Its particles are the mesh's vertices, its faces the mesh's boundary(), in their order. A
/// vertex has the mass of a quarter of each tetrahedron around it. It needs SolverKind::Newton. Time
/// O(n log n).
/// @throws Error InvalidMesh, naming a tetrahedron or vertex at fault, as require_valid_tetrahedra(), and
/// when a vertex belongs to no tetrahedron; InvalidOptions for options out of range, and for vertices that
/// the mesh does not have
Deformable make_soft_body(const TetrahedralMesh& mesh, const SoftBodyOptions& options);

/// Several deformables as one: cloth and organ, two organs. With self_collision they collide with each other.
/// The particles, and all that names them, follow one part after the other. Time O(n).
/// @throws Error InvalidOptions for a part that no simulation would take, naming the part and what is at
/// fault
Deformable combine(std::span<const Deformable> parts);

/// The same deformable, with all masses times a factor, finite and positive. Newton's cloth has its masses
/// from its ClothMaterial.
Deformable with_masses_times(double factor, Deformable deformable);

} // namespace echinus

ECHINUS_EXPORT_END
