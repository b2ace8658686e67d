#pragma once

#include <echinus/simulation.hpp>

#include <optional>
#include <vector>

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
