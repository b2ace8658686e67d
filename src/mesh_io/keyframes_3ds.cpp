#include "mesh_io/keyframes_3ds.hpp"

#include <cmath>
#include <map>
#include <string>
#include <utility>

namespace echinus {

namespace {

constexpr std::uint16_t kFirstNode = 0xB001, kObjectNode = 0xB002, kLastNode = 0xB007;
constexpr std::uint16_t kHead = 0xB010, kPivot = 0xB013, kPositions = 0xB020, kRotations = 0xB021,
                        kScales = 0xB022, kNumber = 0xB030;

/// The format has no measure of time; Assimp plays 25 frames per second, too.
constexpr double kFramesPerSecond = 25;

void skip_spline(ChunkReader3ds& reader) {
    constexpr unsigned kTermCount = 5; // tension, continuity, bias, ease to, ease from
    const unsigned present = reader.next_word();
    for (unsigned term = 0; term < kTermCount; ++term)
        if ((present >> term & 1U) != 0) reader.next_float();
}

/// @param next  reads the value of a key
template <typename Value, typename Next>
void read_track(const MeshSource& source, const Chunk3ds& chunk, Track<Value>& track, Next&& next) {
    constexpr std::size_t kFlagsSize = 10;
    ChunkReader3ds reader(source, chunk);
    reader.skip(kFlagsSize);
    track = {};
    for (std::size_t left = reader.next_double_word(); left > 0; --left) {
        track.times.push_back(reader.next_double_word() / kFramesPerSecond);
        skip_spline(reader);
        track.values.push_back(next(reader));
    }
}

/// Each key turns on from the one before it, clockwise as seen against its axis.
void read_rotations(const MeshSource& source, const Chunk3ds& chunk, Track<Rotation>& track) {
    read_track(source, chunk, track, [&](ChunkReader3ds& reader) {
        const double angle = reader.next_float();
        const Vec3d axis = reader.next_vector();
        const Rotation before = track.values.empty() ? Rotation{} : track.values.back();
        if (axis == Vec3d{} || angle == 0) return before;
        if (!std::isfinite(angle) || !is_finite(axis))
            source.fail(ErrorCode::InvalidMesh, "a key of a rotation is not finite; export the file again");
        return (Rotation::about(axis, -angle) * before).normalised();
    });
}

Node3ds read_node(const MeshSource& source, const Chunk3ds& node, std::size_t number) {
    Node3ds result{{}, number, kNoNode3ds, {}, {}};
    const auto vector = [](ChunkReader3ds& reader) { return reader.next_vector(); };
    for_each_chunk_3ds(source, node.begin, node.end, [&](const Chunk3ds& chunk) {
        ChunkReader3ds reader(source, chunk);
        if (chunk.id == kNumber) result.number = reader.next_word();
        if (chunk.id == kHead) {
            result.object = reader.next_name();
            reader.skip(2 * sizeof(std::uint16_t)); // flags
            result.parent = reader.next_word();
        }
        if (chunk.id == kPivot) result.pivot = reader.next_vector();
        if (chunk.id == kPositions) read_track(source, chunk, result.motion.positions, vector);
        if (chunk.id == kScales) read_track(source, chunk, result.motion.scales, vector);
        if (chunk.id == kRotations) read_rotations(source, chunk, result.motion.rotations);
    });
    return result;
}

SceneNode scene_node(const Node3ds& node, std::size_t parent) {
    const auto first = [](const auto& track, auto otherwise) {
        return track.values.empty() ? otherwise : track.values.front();
    };
    SceneNode result{in_quotes(node.object), parent, {}, {}};
    result.placement = {first(node.motion.positions, Vec3d{}), first(node.motion.rotations, Rotation{}),
                        first(node.motion.scales, Vec3d{1, 1, 1})};
    result.local = result.placement.affine();
    return result;
}

} // namespace

std::vector<Node3ds> read_nodes_3ds(const MeshSource& source, const Chunk3ds& keyframes) {
    std::vector<Node3ds> nodes;
    std::size_t number = 0;
    for_each_chunk_3ds(source, keyframes.begin, keyframes.end, [&](const Chunk3ds& chunk) {
        if (chunk.id < kFirstNode || chunk.id > kLastNode) return;
        if (chunk.id == kObjectNode) nodes.push_back(read_node(source, chunk, number));
        ++number; // lights and cameras count
    });
    return nodes;
}

std::vector<std::size_t> place_nodes_3ds(const std::vector<Node3ds>& nodes, SceneFile& scene) {
    std::map<std::size_t, std::vector<std::size_t>> children; // of the node of a number
    for (std::size_t i = nodes.size(); i-- > 0;) children[nodes[i].parent].push_back(i);
    std::vector<std::size_t> places(nodes.size(), kNotPlaced);
    struct Pending {
        std::size_t node, parent;
    };
    std::vector<Pending> pending; // depth first, however deep
    for (const std::size_t root : std::exchange(children[kNoNode3ds], {}))
        pending.push_back({root, kNotPlaced});
    while (!pending.empty()) {
        const auto [node, parent] = pending.back();
        pending.pop_back();
        const std::size_t place = places[node] = scene.nodes.size();
        scene.nodes.push_back(scene_node(nodes[node], parent == kNotPlaced ? place : parent));
        // Of nodes with one number the first has the children.
        for (const std::size_t child : std::exchange(children[nodes[node].number], {}))
            pending.push_back({child, place});
    }
    return places;
}

} // namespace echinus
