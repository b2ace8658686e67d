#include "mesh_io/node_animation.hpp"

#include <assimp/anim.h>
#include <assimp/scene.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>
#include <string>

namespace echinus {

namespace {

constexpr double kDefaultTicksPerSecond = 25; // Assimp's convention for files that do not say it

std::string quoted(const aiString& name) {
    return in_quotes(std::string_view(name.C_Str(), std::strlen(name.C_Str())));
}

/// How a channel's list of keys is called in a sentence.
std::string list_name(const char* what, const aiString& node) {
    return std::string(what) + " of the node " + quoted(node);
}

bool is_finite(const aiVector3D& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool is_sound(const aiVectorKey& key) {
    return is_finite(key.mValue);
}

bool is_sound(const aiQuatKey& key) {
    const aiQuaternion& q = key.mValue;
    const double square = double{q.w} * q.w + double{q.x} * q.x + double{q.y} * q.y + double{q.z} * q.z;
    return std::isfinite(square) && square > 0;
}

bool is_sound(const aiMeshMorphKey& key) {
    return std::all_of(key.mWeights, key.mWeights + key.mNumValuesAndWeights,
                       [](double weight) { return std::isfinite(weight); });
}

/// @returns the time of the last key, in ticks
template <typename Key>
double require_sound_keys(std::span<const Key> keys, const std::string& name, const MeshSource& source) {
    for (std::size_t i = 0; i < keys.size(); ++i) {
        if (!std::isfinite(keys[i].mTime) || !is_sound(keys[i]))
            source.fail(ErrorCode::InvalidMesh, "key " + std::to_string(i) + " of the " + name +
                                                    " is not finite or turns nowhere; export the animation "
                                                    "again");
        if (i > 0 && keys[i].mTime < keys[i - 1].mTime)
            source.fail(ErrorCode::InvalidMesh,
                        "keys out of order: of the " + name + ", key " + std::to_string(i) +
                            " comes before the one that precedes it; sort the keys by their time");
    }
    return keys.empty() ? 0 : keys.back().mTime;
}

/// The first key, the key before and after a time, or the last: what to interpolate, and how far.
template <typename Key>
struct Place {
    Place(std::span<const Key> keys, double ticks) {
        const auto after = std::upper_bound(keys.begin(), keys.end(), ticks,
                                            [](double time, const Key& key) { return time < key.mTime; });
        from = to = after == keys.begin() ? &keys.front() : &*(after - 1);
        if (after == keys.begin() || after == keys.end()) return;
        to = &*after;
        share = (ticks - from->mTime) / (to->mTime - from->mTime);
    }

    const Key *from, *to;
    double share = 0;
};

Vec3d vector_of(const aiVector3D& v) {
    return {v.x, v.y, v.z};
}

Vec3d vector_at(std::span<const aiVectorKey> keys, double ticks, const Vec3d& otherwise) {
    if (keys.empty()) return otherwise;
    const Place place(keys, ticks);
    const Vec3d from = vector_of(place.from->mValue);
    return from + (vector_of(place.to->mValue) - from) * place.share;
}

Rotation rotation_of(const aiQuaternion& q) {
    return Rotation{q.w, q.x, q.y, q.z}.normalised();
}

Rotation rotation_at(std::span<const aiQuatKey> keys, double ticks, const Rotation& otherwise) {
    if (keys.empty()) return otherwise;
    const Place place(keys, ticks);
    const Rotation from = rotation_of(place.from->mValue);
    const Vec3d way = (rotation_of(place.to->mValue) * from.inverse()).normalised().vector();
    if (place.share == 0 || way == Vec3d{}) return from;
    return (Rotation::about(way, length(way) * place.share) * from).normalised();
}

/// First scale, then turn, then move.
Transform composed(const Vec3d& position, const Rotation& rotation, const Vec3d& scale) {
    const Vec3d x = rotation.apply({scale.x, 0, 0}), y = rotation.apply({0, scale.y, 0}),
                z = rotation.apply({0, 0, scale.z});
    return {x.x, y.x, z.x, position.x, x.y, y.y, z.y, position.y, x.z, y.z, z.z, position.z, 0, 0, 0, 1};
}

std::span<const aiVectorKey> positions_of(const aiNodeAnim& channel) {
    return {channel.mPositionKeys, channel.mNumPositionKeys};
}
std::span<const aiQuatKey> rotations_of(const aiNodeAnim& channel) {
    return {channel.mRotationKeys, channel.mNumRotationKeys};
}
std::span<const aiVectorKey> scales_of(const aiNodeAnim& channel) {
    return {channel.mScalingKeys, channel.mNumScalingKeys};
}
std::span<const aiMeshMorphKey> keys_of(const aiMeshMorphAnim& channel) {
    return {channel.mKeys, channel.mNumKeys};
}

double last_key(const aiNodeAnim& channel, const MeshSource& source) {
    const aiString& node = channel.mNodeName;
    return std::max({require_sound_keys(positions_of(channel), list_name("positions", node), source),
                     require_sound_keys(rotations_of(channel), list_name("rotations", node), source),
                     require_sound_keys(scales_of(channel), list_name("scales", node), source)});
}

/// The number of the first node with this name, or the number of nodes.
std::size_t find_node(const std::vector<SceneNode>& nodes, const aiString& name) {
    const auto found = std::find_if(nodes.begin(), nodes.end(),
                                    [&](const SceneNode& node) { return node.node->mName == name; });
    return static_cast<std::size_t>(found - nodes.begin());
}

std::string names_of(const aiScene& scene) {
    std::string names;
    for (unsigned i = 0; i < scene.mNumAnimations; ++i)
        names += (i == 0 ? "" : ", ") + quoted(scene.mAnimations[i]->mName);
    return names;
}

} // namespace

const aiAnimation& choose_animation(const SceneFile& file, std::string_view name, const MeshSource& source) {
    const aiScene& scene = file.scene();
    if (scene.mNumAnimations == 0)
        source.fail(ErrorCode::InvalidMesh,
                    "the file has no animation; export it with one, or take a PC2 file or a folder of OBJ");
    if (name.empty() && scene.mNumAnimations > 1)
        source.fail(ErrorCode::InvalidMesh, "the file has " + std::to_string(scene.mNumAnimations) +
                                                " animations; say which: " + names_of(scene));
    for (unsigned i = 0; i < scene.mNumAnimations; ++i)
        if (name.empty() || name == scene.mAnimations[i]->mName.C_Str()) return *scene.mAnimations[i];
    source.fail(ErrorCode::InvalidMesh,
                "the file has no animation " + in_quotes(name) + ", but " + names_of(scene));
}

NodeAnimation::NodeAnimation(const SceneFile& file, const aiAnimation& animation, const MeshSource& source)
    : file_(file),
      ticks_per_second_(animation.mTicksPerSecond != 0 ? animation.mTicksPerSecond : kDefaultTicksPerSecond),
      channels_(file.nodes().size()), morph_channels_(file.nodes().size()) {
    if (!(ticks_per_second_ > 0) || !std::isfinite(ticks_per_second_))
        source.fail(ErrorCode::InvalidMesh, "the animation's ticks per second make no sense");
    double last = 0;
    for (unsigned i = 0; i < animation.mNumChannels; ++i) {
        const aiNodeAnim& channel = *animation.mChannels[i];
        last = std::max(last, last_key(channel, source));
        const std::size_t node = find_node(file.nodes(), channel.mNodeName);
        if (node < channels_.size()) channels_[node] = &channel;
    }
    for (unsigned i = 0; i < animation.mNumMorphMeshChannels; ++i) {
        const aiMeshMorphAnim& channel = *animation.mMorphMeshChannels[i];
        last =
            std::max(last, require_sound_keys(keys_of(channel), list_name("weights", channel.mName), source));
        const std::size_t node = find_node(file.nodes(), channel.mName);
        if (node < channels_.size()) morph_channels_[node] = &channel;
    }
    seconds_ = last / ticks_per_second_;
}

Transform NodeAnimation::local_at(std::size_t node, double seconds) const {
    const Transform rest = SceneFile::rest_transform(*file_.nodes()[node].node);
    const aiNodeAnim* channel = channels_[node];
    if (channel == nullptr) return rest;
    aiVector3t<double> scale, position;
    aiQuaterniont<double> rotation;
    rest.Decompose(scale, rotation, position);
    const double ticks = seconds * ticks_per_second_;
    return composed(
        vector_at(positions_of(*channel), ticks, {position.x, position.y, position.z}),
        rotation_at(rotations_of(*channel), ticks, {rotation.w, rotation.x, rotation.y, rotation.z}),
        vector_at(scales_of(*channel), ticks, {scale.x, scale.y, scale.z}));
}

std::vector<Transform> NodeAnimation::to_world_at(double seconds) const {
    std::vector<Transform> to_world;
    for (std::size_t node = 0; node < channels_.size(); ++node) {
        const Transform parent = node == 0 ? Transform() : to_world[file_.nodes()[node].parent];
        to_world.push_back(parent * local_at(node, seconds));
    }
    return to_world;
}

std::vector<double> NodeAnimation::morph_weights_at(std::size_t node, double seconds) const {
    std::vector<double> weights;
    const aiMeshMorphAnim* channel = morph_channels_[node];
    if (channel == nullptr || channel->mNumKeys == 0) return weights;
    const Place place(keys_of(*channel), seconds * ticks_per_second_);
    const auto add = [&](const aiMeshMorphKey& key, double share) {
        for (unsigned i = 0; i < key.mNumValuesAndWeights; ++i) {
            if (key.mValues[i] >= weights.size()) weights.resize(std::size_t{key.mValues[i]} + 1);
            weights[key.mValues[i]] += share * key.mWeights[i];
        }
    };
    add(*place.from, 1 - place.share);
    if (place.share > 0) add(*place.to, place.share);
    return weights;
}

} // namespace echinus
