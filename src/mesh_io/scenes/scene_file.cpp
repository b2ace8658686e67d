#include "mesh_io/scenes/scene_file.hpp"

#include "mesh_io/readers.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace echinus {

namespace {

Vec3d absolute(const Vec3d& v) {
    return {std::abs(v.x), std::abs(v.y), std::abs(v.z)};
}

/// Is `product`, which is a b, the identity up to the rounding of a and b, which files contain as floats?
bool is_identity_but_for_rounding(const Affine& product, const Affine& a, const Affine& b) {
    constexpr double kRounding = 0x1p-20; // for a chain of floats with 24 bits each
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

/// The maps that move an instance: one for each bone, or only its node's.
std::vector<Affine> maps_of(const SceneFile& file, const SceneInstance& instance,
                            const std::vector<Affine>& to_world) {
    if (!instance.skin) return {lead(to_world[instance.node], instance.placement)};
    std::vector<Affine> maps;
    for (const Bone& bone : file.skins[*instance.skin].bones)
        maps.push_back(lead(to_world[bone.node], bone.offset));
    return maps;
}

/// v + sum of weight * displacement.
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

/// Instances of skins whose bones differ count as mirrored if all bones mirror them.
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
                            "a vertex of " + shape.name +
                                " is not finite after its transformation; export it again");
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

namespace {

bool is_sound(const Vec3d& value) {
    return is_finite(value);
}

bool is_sound(const Rotation& q) {
    const double square = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
    return std::isfinite(square) && square > 0;
}

bool is_sound(const std::vector<double>& weights) {
    return std::all_of(weights.begin(), weights.end(), [](double weight) { return std::isfinite(weight); });
}

/// @param name  the name of what the track moves, for sentences
/// @returns the time of the last key
template <typename Value>
double require_sound(const Track<Value>& track, const std::string& name, const MeshSource& source) {
    for (std::size_t i = 0; i < track.times.size(); ++i) {
        if (!std::isfinite(track.times[i]) || !is_sound(track.values[i]))
            source.fail(ErrorCode::InvalidMesh,
                        "key " + std::to_string(i) + " of the " + name +
                            " is not finite, or is a rotation of 0; export the animation "
                            "again");
        if (i > 0 && track.times[i] < track.times[i - 1])
            source.fail(ErrorCode::InvalidMesh,
                        "keys out of order: of the " + name + ", key " + std::to_string(i) +
                            " comes before the one that precedes it; sort the keys by their time");
    }
    return track.times.empty() ? 0 : track.times.back();
}

double last_key(const NodeMotion& motion, const std::string& node, const MeshSource& source) {
    return std::max({require_sound(motion.positions, "positions of the node " + node, source),
                     require_sound(motion.rotations, "rotations of the node " + node, source),
                     require_sound(motion.scales, "scales of the node " + node, source),
                     require_sound(motion.weights, "weights of the node " + node, source)});
}

/// The keys between which to interpolate at a time, and the share: the first key, the keys before and after
/// the time, or the last key.
template <typename Value>
struct Place {
    Place(const Track<Value>& track, double seconds) {
        const auto& times = track.times;
        const auto after = std::upper_bound(times.begin(), times.end(), seconds);
        const std::size_t next = static_cast<std::size_t>(after - times.begin());
        from = to = &track.values[next == 0 ? 0 : next - 1];
        if (next == 0 || next == times.size()) return;
        to = &track.values[next];
        share = (seconds - times[next - 1]) / (times[next] - times[next - 1]);
    }

    const Value *from, *to;
    double share = 0;
};

Vec3d vector_at(const Track<Vec3d>& track, double seconds, const Vec3d& otherwise) {
    if (track.times.empty()) return otherwise;
    const Place place(track, seconds);
    return *place.from + (*place.to - *place.from) * place.share;
}

Rotation rotation_at(const Track<Rotation>& track, double seconds, const Rotation& otherwise) {
    if (track.times.empty()) return otherwise;
    const Place place(track, seconds);
    const Rotation from = place.from->normalised();
    const Vec3d way = (place.to->normalised() * from.inverse()).normalised().vector();
    if (place.share == 0 || way == Vec3d{}) return from;
    return (Rotation::about(way, length(way) * place.share) * from).normalised();
}

std::vector<double> weights_at(const Track<std::vector<double>>& track, double seconds) {
    const Place place(track, seconds);
    std::vector<double> weights;
    for (std::size_t i = 0; i < place.from->size(); ++i)
        weights.push_back((*place.from)[i] * (1 - place.share) + (*place.to)[i] * place.share);
    return weights;
}

std::string names_of(const SceneFile& file) {
    std::string names;
    for (const SceneAnimation& animation : file.animations)
        names += (names.empty() ? "" : ", ") + in_quotes(animation.name);
    return names;
}

} // namespace

const SceneAnimation& choose_animation(const SceneFile& file, std::string_view name,
                                       const MeshSource& source) {
    const std::vector<SceneAnimation>& animations = file.animations;
    if (animations.empty())
        source.fail(ErrorCode::InvalidMesh,
                    "the file has no animation; export it with one, or use a PC2 file or a folder of OBJ");
    if (name.empty() && animations.size() > 1)
        source.fail(ErrorCode::InvalidMesh, "the file has " + std::to_string(animations.size()) +
                                                " animations; say which: " + names_of(file));
    for (const SceneAnimation& animation : animations)
        if (name.empty() || name == animation.name) return animation;
    source.fail(ErrorCode::InvalidMesh,
                "the file has no animation " + in_quotes(name) + ", but " + names_of(file));
}

NodeAnimation::NodeAnimation(const SceneFile& file, const SceneAnimation& animation, const MeshSource& source)
    : file_(file), animation_(animation) {
    for (const auto& [node, motion] : animation.nodes)
        seconds_ = std::max(seconds_, last_key(motion, file.nodes[node].name, source));
}

Pose NodeAnimation::pose_at(double seconds) const {
    std::vector<Affine> local;
    for (const SceneNode& node : file_.nodes) local.push_back(node.local);
    for (const auto& [node, motion] : animation_.nodes) {
        if (motion.positions.times.empty() && motion.rotations.times.empty() && motion.scales.times.empty())
            continue;
        const NodePlacement& rest = file_.nodes[node].placement;
        local[node] = NodePlacement{vector_at(motion.positions, seconds, rest.position),
                                    rotation_at(motion.rotations, seconds, rest.rotation),
                                    vector_at(motion.scales, seconds, rest.scale)}
                          .affine();
    }
    Pose pose{to_world(file_, local), {}};
    for (const SceneInstance& instance : file_.instances) {
        const auto moved = animation_.nodes.find(instance.node);
        const bool morphs = moved != animation_.nodes.end() && !moved->second.weights.times.empty();
        pose.weights.push_back(morphs ? weights_at(moved->second.weights, seconds) : instance.weights);
    }
    return pose;
}

} // namespace echinus
