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

/// The distance from the model's surface of the particles in contact: those outside and nearer than two
/// thicknesses.
struct ContactGap {
    std::size_t particle_count = 0;
    double mean = 0, least = 0; ///< in the scene's unit; meaningless without particles
};

/// The relation of a cloth to a model.
struct Verdict {
    std::size_t inside_count = 0; ///< particles inside a model
    double deepest = 0;           ///< distance of the deepest of them from the surface, in the scene's unit
    PairCounts pairs;
    ContactGap gap;
};

/// Counts intersecting pairs, exactly for the present positions, with threads as faces without area.
/// @param models  [collider_count] in their present shape and scale, without the colliders' poses
PairCounts count_pairs(const echinus::Simulation& simulation, std::span<const echinus::TriangleMesh> models);

/// A mesh scaled along its axes. If the scale mirrors it, the orientation of its faces is reversed, so that
/// the inside stays the inside.
echinus::TriangleMesh scaled(echinus::TriangleMesh mesh, const echinus::Vec3d& scale);

/// The reference by which a collider is judged, whatever map the simulation uses.
struct JudgedModel {
    echinus::TriangleMesh mesh; ///< neither scaled nor moved
    echinus::ExactMap map;      ///< of that mesh
};

/// Judges the present state of the cloth by the colliders' meshes: every particle by its winding number and
/// its distance from the surface, both by brute force over all faces; pairs of faces exactly, with threads as
/// faces without area; gaps by the exact maps. A particle inside two colliders counts twice.
/// @param models        [collider_count]
/// @param thread_count  0 for all cores
Verdict judge(const echinus::Simulation& simulation, std::span<const JudgedModel> models,
              unsigned thread_count);

/// The deviation of parts from their size at rest, as a share of that size: 0.01 is 1 %.
struct Strain {
    double mean;
    double percentile_99; ///< 99 of 100 parts deviate no more
    double largest;
};

/// The strain of the material, for either solver: for each triangle of cloth, tetrahedron and piece of a
/// thread, |s - 1| for the principal stretch s farthest from 1. None if there is no material.
std::optional<Strain> material_strain(const echinus::Deformable& deformable);

/// The strain of the edges of all faces and of the pieces of threads, in either direction. None if there are
/// no edges.
std::optional<Strain> edge_strain(const echinus::Deformable& deformable);
