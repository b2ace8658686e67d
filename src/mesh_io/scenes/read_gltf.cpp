#include "mesh_io/scenes/gltf_file.hpp"
#include "mesh_io/scenes/gltf_shapes.hpp"
#include "mesh_io/scenes/scene_file.hpp"

#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace echinus {

namespace {

/// The values of a channel, with the same number for each key.
class Sampler {
  public:
    /// @param name  of the animation, for sentences
    Sampler(GltfFile& file, const GltfValue& sampler, std::string name)
        : file_(file), input_(file, sampler.member("input")), output_(file, sampler.member("output")),
          is_spline_(sampler.member("interpolation").string() == "CUBICSPLINE"), name_(std::move(name)) {
        input_.require_width(1);
        if (input_.count() == 0) fail("has a channel without keys");
    }

    /// @param make  returns the value for an element of the output, by its index
    template <typename Value, typename Make>
    void read(std::size_t width, Track<Value>& track, Make&& make) const {
        output_.require_width(width);
        require_values(output_.count() == key_count() * values_per_key());
        start(track);
        for (std::size_t key = 0; key < key_count(); ++key)
            track.values.push_back(make(key * values_per_key() + (is_spline_ ? 1 : 0)));
    }

    /// The weights of morph targets: for each key, one for each target.
    void read_weights(Track<std::vector<double>>& track) const {
        output_.require_width(1);
        const std::size_t unit = key_count() * values_per_key();
        require_values(output_.count() > 0 && output_.count() % unit == 0);
        start(track);
        const std::size_t target_count = output_.count() / unit;
        for (std::size_t key = 0; key < key_count(); ++key) {
            const std::size_t first = (key * values_per_key() + (is_spline_ ? 1 : 0)) * target_count;
            std::vector<double>& weights = track.values.emplace_back();
            for (std::size_t i = 0; i < target_count; ++i) weights.push_back(output_.number(first + i, 0));
        }
    }

    const GltfAccessor& output() const { return output_; }

  private:
    std::size_t key_count() const { return input_.count(); }
    std::size_t values_per_key() const { return is_spline_ ? 3 : 1; }

    template <typename Value>
    void start(Track<Value>& track) const {
        if (!track.times.empty()) fail("has two channels for the same thing");
        file_.spend(key_count() + output_.count());
        for (std::size_t key = 0; key < key_count(); ++key) track.times.push_back(input_.number(key, 0));
    }
    void require_values(bool are_whole) const {
        if (!are_whole)
            fail("has a channel with " + std::to_string(output_.count()) + " values for " +
                 std::to_string(key_count()) + " keys; export the file again");
    }
    [[noreturn]] void fail(const std::string& what) const {
        file_.source().fail(ErrorCode::InvalidMesh, name_ + " " + what);
    }

    GltfFile& file_;
    GltfAccessor input_, output_;
    bool is_spline_;
    std::string name_;
};

void read_channel(const Sampler& sampler, const std::string& path, NodeMotion& motion) {
    const GltfAccessor& output = sampler.output();
    const auto vector = [&](std::size_t i) { return output.vector(i); };
    if (path == "translation") sampler.read(3, motion.positions, vector);
    if (path == "scale") sampler.read(3, motion.scales, vector);
    if (path == "rotation")
        sampler.read(4, motion.rotations, [&](std::size_t i) {
            return Rotation{output.number(i, 3), output.number(i, 0), output.number(i, 1),
                            output.number(i, 2)};
        });
    if (path == "weights") sampler.read_weights(motion.weights);
}

/// The animations of a glTF file (glTF 2.0, section 3.11). For splines, the values at the keys are kept.
/// @param numbers  the indices of the file's nodes in scene.nodes; channels of nodes outside the scene are
/// left out
/// @throws Error InvalidMesh
std::vector<SceneAnimation> read_gltf_animations(GltfFile& file, const SceneFile& scene,
                                                 const std::vector<std::size_t>& numbers) {
    std::vector<SceneAnimation> animations;
    const std::vector<GltfValue> nodes = file.root().member("nodes").elements();
    for (const GltfValue& animation : file.root().member("animations").elements()) {
        SceneAnimation& result = animations.emplace_back();
        result.name = animation.member("name").string();
        const std::vector<GltfValue> samplers = animation.member("samplers").elements();
        for (const GltfValue& channel : animation.member("channels").elements()) {
            const GltfValue target = channel.member("target"), node = target.member("node");
            const std::string path = target.member("path").string();
            const std::size_t number = channel.member("sampler").natural_number();
            if (number >= samplers.size())
                channel.fail("refers to sampler " + std::to_string(number) + ", but there are " +
                             std::to_string(samplers.size()));
            if (!node.exists()) continue; // its target is defined by an extension
            const GltfValue& moved = file.element("nodes", node);
            if (moved.member("matrix").exists() && path != "weights")
                moved.fail("is animated and has a matrix; export it with translation, rotation and scale");
            const std::size_t place = numbers[node.natural_number()];
            if (place >= scene.nodes.size()) continue;
            read_channel(Sampler(file, samplers[number], animation.path()), path, result.nodes[place]);
        }
    }
    return animations;
}

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

Vec3d vector_of(const std::vector<double>& numbers) {
    return {numbers[0], numbers[1], numbers[2]};
}

/// Four columns of four numbers (section 3.5.3).
Affine affine_of(const GltfValue& matrix) {
    const std::vector<double> m = *matrix.numbers(16);
    constexpr double kRounding = 1e-6;
    for (const std::size_t i : {3, 7, 11, 15})
        if (std::abs(m[i] - (i == 15 ? 1 : 0)) > kRounding)
            matrix.fail("has a last row other than 0 0 0 1, which moves no mesh");
    return {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}, {m[12], m[13], m[14]}};
}

Rotation rotation_of(const GltfValue& owner, double x, double y, double z, double w) {
    const double square = x * x + y * y + z * z + w * w;
    if (!std::isfinite(square) || square == 0) owner.fail("has a rotation that is 0 or not finite");
    return Rotation{w, x, y, z}.normalised();
}

SceneNode make_node(const GltfValue& node, std::size_t parent) {
    const std::string name = node.member("name").string();
    SceneNode result{name.empty() ? node.path() : in_quotes(name), parent, {}, {}};
    if (const GltfValue matrix = node.member("matrix"); matrix.exists()) {
        result.local = affine_of(matrix);
        return result;
    }
    NodePlacement& placement = result.placement;
    if (const auto position = node.member("translation").numbers(3))
        placement.position = vector_of(*position);
    if (const auto scale = node.member("scale").numbers(3)) placement.scale = vector_of(*scale);
    if (const auto r = node.member("rotation").numbers(4))
        placement.rotation = rotation_of(node, (*r)[0], (*r)[1], (*r)[2], (*r)[3]);
    result.local = placement.affine();
    return result;
}

/// The instances that EXT_mesh_gpu_instancing makes of a node's mesh, in the node; otherwise one.
std::vector<Affine> placements_of(GltfFile& file, const GltfValue& node) {
    const GltfValue extension = node.member("extensions").member("EXT_mesh_gpu_instancing");
    if (!extension.exists()) return {Affine{}};
    if (node.member("skin").exists())
        extension.fail("belongs to a node with a skin, which has no pose of its own");
    const GltfValue attributes = extension.member("attributes");
    std::optional<std::size_t> count;
    const auto open = [&](const char* key, std::size_t width) -> std::optional<GltfAccessor> {
        const GltfValue user = attributes.member(key);
        if (!user.exists()) return std::nullopt;
        GltfAccessor accessor(file, user);
        accessor.require_width(width);
        if (count) accessor.require_count(*count);
        count = accessor.count();
        return accessor;
    };
    const auto positions = open("TRANSLATION", 3), rotations = open("ROTATION", 4), scales = open("SCALE", 3);
    file.spend(count.value_or(0));
    std::vector<Affine> placements;
    for (std::size_t i = 0; i < count.value_or(0); ++i) {
        NodePlacement placement;
        if (positions) placement.position = positions->vector(i);
        if (scales) placement.scale = scales->vector(i);
        if (rotations)
            placement.rotation = rotation_of(extension, rotations->number(i, 0), rotations->number(i, 1),
                                             rotations->number(i, 2), rotations->number(i, 3));
        placements.push_back(placement.affine());
    }
    return placements;
}

class GltfReader {
  public:
    explicit GltfReader(const MeshSource& source) : file_(source), shapes_(file_) {}

    SceneFile read(Wanted wanted) {
        place_nodes();
        for (std::size_t i = 0; i < scene_size_; ++i) add_instances(i);
        scene_.shapes = std::move(shapes_.shapes());
        if (wanted == Wanted::Animation) scene_.animations = read_gltf_animations(file_, scene_, numbers_);
        return std::move(scene_);
    }

  private:
    /// Places the nodes of the scene, and then others, to which skins may refer.
    void place_nodes() {
        all_nodes_ = file_.root().member("nodes").elements();
        if (all_nodes_.empty()) file_.source().fail(ErrorCode::InvalidMesh, "the file has no nodes");
        numbers_.assign(all_nodes_.size(), kNone);
        std::vector<bool> is_child(all_nodes_.size());
        for (const GltfValue& node : all_nodes_)
            for (const GltfValue& child : node.member("children").elements())
                is_child[number_of_node(child)] = true;
        const GltfValue scenes = file_.root().member("scenes"), scene = file_.root().member("scene");
        std::vector<std::size_t> roots;
        for (std::size_t i = 0; i < all_nodes_.size(); ++i)
            if (!is_child[i]) roots.push_back(i);
        if (scene.exists() || !scenes.elements().empty()) {
            const GltfValue chosen =
                scene.exists() ? file_.element("scenes", scene) : scenes.elements().front();
            for (const GltfValue& root : chosen.member("nodes").elements()) place_tree(number_of_node(root));
        } else {
            for (const std::size_t root : roots) place_tree(root);
        }
        scene_size_ = scene_.nodes.size();
        for (const std::size_t root : roots)
            if (numbers_[root] == kNone) place_tree(root);
    }

    std::size_t number_of_node(const GltfValue& user) {
        file_.element("nodes", user); // exists
        return user.natural_number();
    }

    /// Goes depth first, without recursion, since the tree may be deep.
    void place_tree(std::size_t root) {
        struct Pending {
            std::size_t node, parent;
        };
        std::vector<Pending> pending{{root, scene_.nodes.size()}};
        while (!pending.empty()) {
            const auto [node, parent] = pending.back();
            pending.pop_back();
            if (numbers_[node] != kNone)
                all_nodes_[node].fail("has two parents, or is its own ancestor; nodes must form trees");
            numbers_[node] = scene_.nodes.size();
            file_nodes_.push_back(node);
            scene_.nodes.push_back(make_node(all_nodes_[node], parent));
            const std::vector<GltfValue> children = all_nodes_[node].member("children").elements();
            for (auto child = children.rbegin(); child != children.rend(); ++child)
                pending.push_back({number_of_node(*child), numbers_[node]});
        }
    }

    void add_instances(std::size_t number) {
        const GltfValue& node = all_nodes_[file_nodes_[number]];
        const GltfValue mesh = node.member("mesh");
        if (!mesh.exists()) return;
        const std::vector<std::size_t>& shapes = shapes_.shapes_of(mesh);
        if (shapes.empty()) return;
        const GltfValue own_weights = node.member("weights");
        const GltfValue weights =
            own_weights.exists() ? own_weights : file_.element("meshes", mesh).member("weights");
        for (const Affine& placement : placements_of(file_, node))
            for (const std::size_t shape : shapes)
                add_instance({shape, number, placement, std::nullopt, weights.numbers()}, node, weights);
    }

    void add_instance(SceneInstance instance, const GltfValue& node, const GltfValue& weights) {
        const SceneShape& shape = shapes_.shapes()[instance.shape];
        if (weights.exists() && instance.weights.size() != shape.targets.size())
            weights.fail("has " + std::to_string(instance.weights.size()) + " weights for " +
                         std::to_string(shape.targets.size()) + " morph targets");
        file_.spend(1 + shape.vertices.size() + shape.corners.size() + instance.weights.size());
        const GltfValue skin = node.member("skin");
        if (skin.exists() && shape.bone_count > 0) {
            instance.skin = number_of_skin(skin);
            if (shape.bone_count > scene_.skins[*instance.skin].bones.size())
                skin.fail("has " + std::to_string(scene_.skins[*instance.skin].bones.size()) +
                          " joints, but " + shape.name + " refers to joint " +
                          std::to_string(shape.bone_count - 1) + ", numbered from 0");
        }
        scene_.instances.push_back(std::move(instance));
    }

    std::size_t number_of_skin(const GltfValue& user) {
        const GltfValue& skin = file_.element("skins", user);
        const auto [entry, is_new] = skins_.try_emplace(user.natural_number(), scene_.skins.size());
        if (is_new) scene_.skins.push_back(make_skin(skin));
        return entry->second;
    }

    SceneSkin make_skin(const GltfValue& skin) {
        SceneSkin result;
        for (const GltfValue& joint : skin.member("joints").elements()) {
            const std::size_t node = numbers_[number_of_node(joint)];
            if (node == kNone) joint.fail("is a node that is its own ancestor");
            result.bones.push_back({node, {}});
        }
        const GltfValue matrices = skin.member("inverseBindMatrices");
        if (!matrices.exists()) return result; // they are the identity
        const GltfAccessor accessor(file_, matrices);
        accessor.require_width(16);
        if (accessor.count() < result.bones.size()) accessor.require_count(result.bones.size());
        for (std::size_t i = 0; i < result.bones.size(); ++i) {
            const auto column = [&](std::size_t k) {
                return Vec3d{accessor.number(i, 4 * k), accessor.number(i, 4 * k + 1),
                             accessor.number(i, 4 * k + 2)};
            };
            result.bones[i].offset = {column(0), column(1), column(2), column(3)};
        }
        return result;
    }

    GltfFile file_;
    GltfShapes shapes_;
    SceneFile scene_;
    std::vector<GltfValue> all_nodes_; ///< of the file
    /// The numbers of the file's nodes in SceneFile::nodes; kNone for nodes that are left out.
    std::vector<std::size_t> numbers_;
    std::vector<std::size_t> file_nodes_;      ///< the inverse of numbers_
    std::size_t scene_size_ = 0;               ///< nodes of the scene that is shown
    std::map<std::size_t, std::size_t> skins_; ///< numbers in SceneFile::skins
};

} // namespace

SceneFile read_gltf(const MeshSource& source, Wanted wanted) {
    return GltfReader(source).read(wanted);
}

} // namespace echinus
