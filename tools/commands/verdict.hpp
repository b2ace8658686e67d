#pragma once

#include "recording/recording.hpp"

#include <echinus/collider.hpp>
#include <echinus/exact_map.hpp>
#include <echinus/mesh.hpp>
#include <echinus/simulation.hpp>

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

/// Distance of the particles in contact from the model's surface: those outside and nearer than two
/// thicknesses.
struct ContactGap {
    std::size_t particle_count = 0;
    double mean = 0, least = 0; ///< units; meaningless without particles
};

/// How a cloth lies on a model.
struct Verdict {
    std::size_t inside_count = 0; ///< particles inside a model
    double deepest = 0;           ///< distance of the deepest of them from the surface, units
    PairCounts pairs;
    ContactGap gap;
};

/// Decided exactly on the positions as they are now, with threads as faces without area.
/// @param models  [collider_count] as they are now, but not moved
PairCounts count_pairs(const echinus::Simulation& simulation, std::span<const echinus::TriangleMesh> models);

/// A mesh stretched along its axes. Where that mirrors it, its faces are turned round, so that what was
/// inside stays inside.
echinus::TriangleMesh scaled(echinus::TriangleMesh mesh, const echinus::Vec3d& scale);

/// The reference by which a collider is judged, whatever map the simulation uses.
struct JudgedModel {
    echinus::TriangleMesh mesh; ///< neither scaled nor moved
    echinus::ExactMap map;      ///< of that mesh
};

/// Judges the cloth as it lies now by the colliders' meshes: every particle by its winding number and its
/// distance from the surface, both brute force over all faces; pairs of faces exactly, with threads as faces
/// without area; gaps by the exact maps. A particle inside two colliders counts twice.
/// @param models        [collider_count]
/// @param thread_count  0: all cores
Verdict judge(const echinus::Simulation& simulation, std::span<const JudgedModel> models,
              unsigned thread_count);

/// How far parts are from their size at rest, as a share of it: 0.01 is 1 %.
struct Strain {
    double mean;
    double percentile_99; ///< of 100 parts 99 have no more
    double largest;
};

/// Of the material, whichever solver moves it: of each triangle of cloth, tetrahedron and piece of a thread
/// the principal stretch that is farthest from 1, less 1, without its sign. None where there is no material.
std::optional<Strain> material_strain(const echinus::Deformable& deformable);

/// Of the edges of all faces and the pieces of threads, longer or shorter. None where there are none.
std::optional<Strain> edge_strain(const echinus::Deformable& deformable);
