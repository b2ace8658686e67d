#pragma once

#include <echinus/export.hpp>
#include <echinus/geometry.hpp>
#include <echinus/simulation.hpp>
#include <echinus/tetrahedra.hpp>

#include <cstdint>
#include <span>
#include <vector>

ECHINUS_EXPORT_BEGIN

/// Soft bodies: organs, rubber, dough. docs/soft_bodies.md describes the method, its limits and
/// measurements.
namespace echinus {

/// The material and initial pose of a soft body. The numbers are in any consistent units; with metres and
/// kilograms they are SI units, and gravity is -9.81.
struct SoftBodyOptions {
    double density = 1000;             ///< mass / length^3; positive. The default is that of water in kg/m^3
    double young_modulus = 1e4;        ///< mass / (length s^2); positive. Soft tissue has 1e3 to 1e5 pascals
    double poisson_ratio = 0.4;        ///< 0 to 0.4999; near 0.5 the volume is preserved
    double damping = 0;                ///< viscosity divided by the shear modulus, seconds; not negative
    RigidTransform pose{};             ///< its rotation has unit length, to within 1e-4
    double scale = 1;                  ///< a vertex starts at pose.to_world(scale * vertex); positive
    std::vector<std::uint32_t> pins{}; ///< vertices that do not move
    std::vector<Attachment> attachments{}; ///< vertices that move with a collider
};

/// Makes a soft body at rest, in O(n log n) time for n tetrahedra. Its particles are the mesh's vertices, and
/// its faces are those of the mesh's boundary(), in the same order. The mass of a vertex is a quarter of the
/// total mass of the tetrahedra around it. Only NewtonOptions can move a body.
/// @throws Error InvalidMesh, naming the tetrahedron or vertex, as require_valid_tetrahedra(), and if a
/// vertex belongs to no tetrahedron; InvalidOptions for options out of range, and for vertices that the mesh
/// does not have
Deformable make_soft_body(const TetrahedralMesh& mesh, const SoftBodyOptions& options);

/// Combines several deformables into one, such as a cloth and an organ, in time proportional to their total
/// size. With CollisionMode::SurfacesAndSelf, they collide with each other. The particles of the parts follow
/// each other in order, and everything that refers to particles is renumbered.
/// @throws Error InvalidOptions for a part that no simulation would accept; the message names the part and
/// its fault
Deformable combine(std::span<const Deformable> parts);

/// Multiplies all masses of a deformable by a finite, positive factor. With NewtonOptions, the masses of
/// cloth come from its ClothMaterial instead.
Deformable with_masses_times(double factor, Deformable deformable);

} // namespace echinus

ECHINUS_EXPORT_END
