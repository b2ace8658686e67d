#include "mesh_io/scene_file.hpp"

#include "mesh_io/readers.hpp"

#include <algorithm>
#include <cmath>

namespace echinus {

namespace {

Vec3d absolute(const Vec3d& v) {
    return {std::abs(v.x), std::abs(v.y), std::abs(v.z)};
}

/// Is `product`, which is a b, the identity but for the rounding of a and b, which files have as floats?
bool is_identity_but_for_rounding(const Affine& product, const Affine& a, const Affine& b) {
    constexpr double kRounding = 0x1p-20; // of a chain of floats of 24 bits each
    const Affine sizes = Affine{absolute(a.x), absolute(a.y), absolute(a.z), absolute(a.origin)} *
                         Affine{absolute(b.x), absolute(b.y), absolute(b.z), absolute(b.origin)};
    const auto near = [](const Vec3d& found, const Vec3d& expected, const Vec3d& size) {
        const Vec3d error = absolute(found - expected);
        return error.x <= kRounding * size.x && error.y <= kRounding * size.y &&
               error.z <= kRounding * size.z;
    };
    const Affine identity;
    return near(product.x, identity.x, sizes.x) && near(product.y, identity.y, sizes.y) &&
           near(product.z, identity.z, sizes.z) && near(product.origin, identity.origin, sizes.origin);
}

/// The map from a shape to the world by way of a node.
Affine lead(const Affine& to_world, const Affine& offset) {
    const Affine product = to_world * offset;
    return is_identity_but_for_rounding(product, to_world, offset) ? Affine{} : product;
}

bool is_identity(const Affine& map) {
    const Affine identity;
    return map.x == identity.x && map.y == identity.y && map.z == identity.z && map.origin == identity.origin;
}

/// The maps that lead an instance: one for each bone, or only its node's.
std::vector<Affine> maps_of(const SceneFile& file, const SceneInstance& instance,
                            const std::vector<Affine>& to_world) {
    if (!instance.skin) return {lead(to_world[instance.node], instance.placement)};
    std::vector<Affine> maps;
    for (const Bone& bone : file.skins[*instance.skin].bones)
        maps.push_back(lead(to_world[bone.node], bone.offset));
    return maps;
}

/// v + sum of weight displacement.
std::vector<Vec3d> morphed(const SceneShape& shape, const std::vector<double>& weights) {
    std::vector<Vec3d> vertices = shape.vertices;
    for (std::size_t target = 0; target < std::min(weights.size(), shape.targets.size()); ++target) {
        if (weights[target] == 0) continue;
        for (std::size_t i = 0; i < vertices.size(); ++i)
            vertices[i] += shape.targets[target][i] * weights[target];
    }
    return vertices;
}

void lead_by_bones(const SceneShape& shape, const std::vector<Affine>& maps, const MeshSource& source,
                   std::vector<Vec3d>& vertices) {
    if (std::all_of(maps.begin(), maps.end(), is_identity)) return;
    if (shape.boneless_vertex)
        source.fail(ErrorCode::InvalidMesh, "vertex " + std::to_string(*shape.boneless_vertex) + " of " +
                                                shape.name +
                                                " has no bone, though others have; give it weights");
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        Affine sum{{}, {}, {}, {}};
        for (std::uint32_t k = shape.first_influences[i]; k < shape.first_influences[i + 1]; ++k) {
            const auto& [bone, weight] = shape.influences[k];
            sum.x += maps[bone].x * weight;
            sum.y += maps[bone].y * weight;
            sum.z += maps[bone].z * weight;
            sum.origin += maps[bone].origin * weight;
        }
        vertices[i] = sum.apply(vertices[i]);
    }
}

/// Instances of skins whose bones differ count as turned over when all bones are mirrored.
bool is_mirrored(const std::vector<Affine>& maps) {
    return std::all_of(maps.begin(), maps.end(), [](const Affine& map) { return map.determinant() < 0; });
}

void add_polygons(const SceneShape& shape, bool mirrored, std::uint32_t first_vertex, PolygonMesh& polygons) {
    std::size_t begin = 0;
    for (const std::uint32_t count : shape.corner_counts) {
        for (std::uint32_t i = 0; i < count; ++i)
            polygons.corners.push_back(first_vertex + shape.corners[begin + (mirrored ? count - 1 - i : i)]);
        polygons.corner_counts.push_back(count);
        begin += count;
    }
}

} // namespace

SceneFile read_scene_file(const MeshSource& source, Wanted wanted) {
    return lower_case_ending(source.name) == ".3ds" ? read_3ds(source, wanted) : read_gltf(source, wanted);
}

PolygonMesh read_scene(const MeshSource& source) {
    return join(read_scene_file(source, Wanted::Mesh), source);
}

std::vector<Affine> to_world(const SceneFile& file, const std::vector<Affine>& local) {
    std::vector<Affine> result;
    for (std::size_t node = 0; node < local.size(); ++node) {
        const std::size_t parent = file.nodes[node].parent;
        result.push_back(parent == node ? local[node] : result[parent] * local[node]);
    }
    return result;
}

Pose rest_pose(const SceneFile& file) {
    std::vector<Affine> local;
    for (const SceneNode& node : file.nodes) local.push_back(node.local);
    Pose pose{to_world(file, local), {}};
    for (const SceneInstance& instance : file.instances) pose.weights.push_back(instance.weights);
    return pose;
}

std::vector<Vec3d> vertices_in(const SceneFile& file, const Pose& pose, const MeshSource& source) {
    std::vector<Vec3d> all;
    for (std::size_t i = 0; i < file.instances.size(); ++i) {
        const SceneInstance& instance = file.instances[i];
        const SceneShape& shape = file.shapes[instance.shape];
        const std::vector<Affine> maps = maps_of(file, instance, pose.to_world);
        std::vector<Vec3d> vertices = morphed(shape, pose.weights[i]);
        if (instance.skin)
            lead_by_bones(shape, maps, source, vertices);
        else
            for (Vec3d& vertex : vertices) vertex = maps[0].apply(vertex);
        for (const Vec3d& vertex : vertices)
            if (!is_finite(Vec3f(vertex)))
                source.fail(ErrorCode::InvalidMesh,
                            "a vertex of " + shape.name + " is not finite where it stands; export it again");
        all.insert(all.end(), vertices.begin(), vertices.end());
    }
    return all;
}

PolygonMesh join(const SceneFile& file, const MeshSource& source) {
    const Pose pose = rest_pose(file);
    PolygonMesh polygons;
    polygons.vertices = vertices_in(file, pose, source);
    std::uint32_t first_vertex = 0;
    for (const SceneInstance& instance : file.instances) {
        const SceneShape& shape = file.shapes[instance.shape];
        add_polygons(shape, is_mirrored(maps_of(file, instance, pose.to_world)), first_vertex, polygons);
        first_vertex += static_cast<std::uint32_t>(shape.vertices.size());
    }
    return polygons;
}

} // namespace echinus
