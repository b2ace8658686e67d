#pragma once

#include "mesh_io/mesh_source.hpp"
#include "mesh_io/readers.hpp"

#include <echinus/geometry.hpp>

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace echinus {

/// An affine map of space: x p.x + y p.y + z p.z + origin.
struct Affine {
    Vec3d x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}; ///< columns of the linear part
    Vec3d origin;

    Vec3d apply_linear(const Vec3d& v) const { return x * v.x + y * v.y + z * v.z; }
    Vec3d apply(const Vec3d& p) const { return apply_linear(p) + origin; }
    double determinant() const { return dot(x, cross(y, z)); }
    /// @pre determinant() is not 0
    Affine inverse() const {
        const double scale = 1 / determinant();
        const Vec3d a = cross(y, z) * scale, b = cross(z, x) * scale, c = cross(x, y) * scale; // rows
        Affine result{{a.x, b.x, c.x}, {a.y, b.y, c.y}, {a.z, b.z, c.z}, {}};
        result.origin = -result.apply_linear(origin);
        return result;
    }
};

/// First `b`, then `a`.
inline Affine operator*(const Affine& a, const Affine& b) {
    return {a.apply_linear(b.x), a.apply_linear(b.y), a.apply_linear(b.z), a.apply(b.origin)};
}

/// Scales, then turns, then moves.
struct NodePlacement {
    Vec3d position;
    Rotation rotation;
    Vec3d scale{1, 1, 1};

    Affine affine() const {
        return {rotation.apply({scale.x, 0, 0}), rotation.apply({0, scale.y, 0}),
                rotation.apply({0, 0, scale.z}), position};
    }
};

struct SceneNode {
    std::string name;        ///< for sentences
    std::size_t parent;      ///< before the node in SceneFile::nodes; the node's own number for a root
    NodePlacement placement; ///< at rest, in the parent; not used for a node with a matrix
    Affine local;            ///< at rest, in the parent
};

/// A bone's influence on a vertex.
struct Influence {
    std::uint32_t bone; ///< in SceneSkin::bones
    double weight;
};

/// A mesh in its own frame.
struct SceneShape {
    std::string name; ///< for sentences
    std::vector<Vec3d> vertices;
    std::vector<std::vector<Vec3d>> targets; ///< of morph targets: [target_count][vertex_count] displacements
    std::vector<std::uint32_t> corners;      ///< as in PolygonMesh
    std::vector<std::uint32_t> corner_counts; ///< as in PolygonMesh
    /// Influences on vertex i: from first_influences[i] to before first_influences[i + 1]; their weights sum
    /// to 1. Empty for a mesh without weights.
    std::vector<std::uint32_t> first_influences;
    std::vector<Influence> influences;
    std::size_t bone_count = 0;                 ///< the number of bones that a skin needs
    std::optional<std::size_t> boneless_vertex; ///< a vertex without influences, by its number in the file
};

struct Bone {
    std::size_t node;
    Affine offset; ///< from the mesh to the bone, in the pose in which they were bound
};

struct SceneSkin {
    std::vector<Bone> bones;
};

/// A shape that a node or a skin places.
struct SceneInstance {
    std::size_t shape;
    std::size_t node;
    Affine placement;                ///< in the node
    std::optional<std::size_t> skin; ///< moves the shape instead of the node
    std::vector<double> weights;     ///< [target_count] of the morph targets, at rest
};

/// Values at times, in seconds.
template <typename Value>
struct Track {
    std::vector<double> times;
    std::vector<Value> values; ///< [times.size()]
};

/// A track without keys keeps the node's value at rest.
struct NodeMotion {
    Track<Vec3d> positions;
    Track<Rotation> rotations; ///< of any length but 0
    Track<Vec3d> scales;
    Track<std::vector<double>> weights; ///< of morph targets
};

struct SceneAnimation {
    std::string name;
    std::map<std::size_t, NodeMotion> nodes; ///< by the number of the node
};

/// The contents of a file that places meshes by nodes.
struct SceneFile {
    std::vector<SceneNode> nodes; ///< parents first
    std::vector<SceneShape> shapes;
    std::vector<SceneSkin> skins;
    std::vector<SceneInstance> instances; ///< in the order in which they are joined
    std::vector<SceneAnimation> animations;
};

/// Animations and the shapes for their morphs are read only if they are wanted.
enum class Wanted { Mesh, Animation };

SceneFile read_gltf(const MeshSource& source, Wanted wanted);
SceneFile read_3ds(const MeshSource& source, Wanted wanted);
/// Chooses the reader by the extension of the source's name.
SceneFile read_scene_file(const MeshSource& source, Wanted wanted);

/// The poses of a file's nodes, and the weights of its morph targets.
struct Pose {
    std::vector<Affine> to_world;             ///< [node_count]
    std::vector<std::vector<double>> weights; ///< [instance_count][target_count]
};

/// @param local  [node_count] the poses of the nodes relative to their parents
std::vector<Affine> to_world(const SceneFile& file, const std::vector<Affine>& local);
Pose rest_pose(const SceneFile& file);

/// All vertices in the world, instance after instance: first morphed, then moved by the bones that influence
/// them (linear blend skinning), or by the node if there are no bones. A node or a skin in the pose in which
/// the mesh was bound to it, up to rounding, leaves the vertices as they are in the file, so that coincident
/// vertices remain coincident.
/// @throws Error InvalidMesh if a vertex is not finite as a float, or has no bone although others have
std::vector<Vec3d> vertices_in(const SceneFile& file, const Pose& pose, const MeshSource& source);

/// The polygons of all instances, in the rest pose of the file, as one mesh. Mirrored instances are turned
/// over (glTF 2.0, section 3.7.4).
/// @throws Error InvalidMesh as vertices_in()
PolygonMesh join(const SceneFile& file, const MeshSource& source);

/// The animation with this name, or the only one if the name is empty.
/// @throws Error InvalidMesh if no animation has this name, or if the name is empty and the number of
/// animations is not one
const SceneAnimation& choose_animation(const SceneFile& file, std::string_view name,
                                       const MeshSource& source);

/// How an animation moves the nodes of a file. Between two keys, positions, scales and the weights of morph
/// targets are interpolated linearly, and rotations about one axis, the shorter way round; before the first
/// key and after the last, they are constant. The handles of splines are not used.
class NodeAnimation {
  public:
    /// @throws Error InvalidMesh if keys are out of order or a number is not finite
    NodeAnimation(const SceneFile& file, const SceneAnimation& animation, const MeshSource& source);

    double seconds() const { return seconds_; } ///< of the last key
    Pose pose_at(double seconds) const;

  private:
    const SceneFile& file_;
    const SceneAnimation& animation_;
    double seconds_ = 0;
};

} // namespace echinus
