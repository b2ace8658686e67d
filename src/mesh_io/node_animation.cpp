#include "mesh_io/node_animation.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace echinus {

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

/// @param name  of what the track moves, for sentences
/// @returns the time of the last key
template <typename Value>
double require_sound(const Track<Value>& track, const std::string& name, const MeshSource& source) {
    for (std::size_t i = 0; i < track.times.size(); ++i) {
        if (!std::isfinite(track.times[i]) || !is_sound(track.values[i]))
            source.fail(ErrorCode::InvalidMesh, "key " + std::to_string(i) + " of the " + name +
                                                    " is not finite or turns nowhere; export the animation "
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

/// The first key, the key before and after a time, or the last: what to interpolate, and how far.
/// @pre the track has keys
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
                    "the file has no animation; export it with one, or take a PC2 file or a folder of OBJ");
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
