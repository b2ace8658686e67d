#pragma once

#include <echinus/collider.hpp>
#include <echinus/mesh.hpp>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

/// One system as the collider of a simulation.
struct Contestant {
    std::string label;
    std::string setting; ///< resolution and the like, in words
    std::size_t bytes = 0;
    echinus::ColliderMap map; ///< what the cloth falls on
    /// The same structure where only its contacts are wanted.
    std::shared_ptr<const echinus::CustomMap> asked;
    /// Its run ends once it is timed: too slow to be waited for.
    bool only_timed = false;
};

/// Every system of rivals/systems/ around one mesh, at its usual settings; those that come in sizes at the
/// paper's.
/// @param thickness  of the scene, in the mesh's unit
/// @throws Error as their builds do
std::vector<Contestant> build_contestants(const echinus::TriangleMesh& mesh, double thickness);
