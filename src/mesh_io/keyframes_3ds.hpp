#pragma once

#include "mesh_io/chunks_3ds.hpp"
#include "mesh_io/scene_file.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace echinus {

/// A node of the keyframes of a 3DS file: it moves an object.
struct Node3ds {
    std::string object;
    std::size_t number; ///< by which others refer to it
    std::size_t parent; ///< the number of another one; kNoNode3ds for none
    Vec3d pivot;        ///< of the object, at the origin of the node
    NodeMotion motion;
};

inline constexpr std::size_t kNoNode3ds = 0xFFFF;

/// @param keyframes  the chunk of all of them
/// @throws Error Damaged
std::vector<Node3ds> read_nodes_3ds(const MeshSource& source, const Chunk3ds& keyframes);

inline constexpr std::size_t kNotPlaced = static_cast<std::size_t>(-1);

/// Adds the nodes to a scene as they stand at their first keys.
/// @return [nodes.size()] their numbers in scene.nodes; kNotPlaced of those that hang on each other, or on
/// what moves no object: a light, a camera
std::vector<std::size_t> place_nodes_3ds(const std::vector<Node3ds>& nodes, SceneFile& scene);

} // namespace echinus
