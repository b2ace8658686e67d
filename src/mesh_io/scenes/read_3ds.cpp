#include "mesh_io/mesh_source.hpp"
#include "mesh_io/readers.hpp"
#include "mesh_io/scenes/scene_file.hpp"

#include <echinus/geometry.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace echinus {

namespace {

/// A chunk of a 3DS file, which has an id, its size including this head, and its content, often other chunks
/// (Autodesk, "3D Studio File Toolkit", chunk list).
struct Chunk3ds {
    std::uint16_t id;
    std::size_t begin, end; ///< of the content
};

/// Calls visit(chunk) for each chunk inside another one, from `begin` on.
/// @throws Error Damaged if a chunk extends beyond the one that contains it
template <typename Visit>
void for_each_chunk_3ds(const MeshSource& source, std::size_t begin, std::size_t end, Visit&& visit) {
    constexpr std::size_t kHeadSize = 6;
    while (begin + kHeadSize <= end) {
        ByteReader head(source, begin, ByteOrder::LittleEndian);
        const auto id = head.next<std::uint16_t>();
        const std::size_t size = head.next<std::uint32_t>();
        if (size < kHeadSize || size > end - begin)
            source.fail(ErrorCode::Damaged, "the chunk at byte " + std::to_string(begin) +
                                                " says that it has " + std::to_string(size) + " bytes, but " +
                                                std::to_string(end - begin) + " remain there");
        visit(Chunk3ds{id, begin + kHeadSize, begin + size});
        begin += size;
    }
}

/// Reads the numbers of one chunk.
class ChunkReader3ds {
  public:
    ChunkReader3ds(const MeshSource& source, const Chunk3ds& chunk)
        : bytes_{source.name, source.bytes.substr(0, chunk.end)},
          reader_(bytes_, chunk.begin, ByteOrder::LittleEndian) {}
    ChunkReader3ds(const ChunkReader3ds&) = delete; // the reader refers to the bytes
    ChunkReader3ds& operator=(const ChunkReader3ds&) = delete;

    std::uint16_t next_word() { return next<std::uint16_t>(); }
    std::uint32_t next_double_word() { return next<std::uint32_t>(); }
    double next_float() { return double{next<float>()}; }
    Vec3d next_vector() {
        const double x = next_float(), y = next_float(), z = next_float();
        return {x, y, z};
    }
    /// Reads a name up to a zero byte.
    std::string next_name() {
        std::string name;
        for (char c = next<char>(); c != '\0'; c = next<char>()) name += c;
        return name;
    }
    void skip(std::size_t byte_count) {
        require(byte_count);
        reader_.skip(byte_count);
    }

    std::size_t offset() const { return reader_.offset(); }
    std::size_t bytes_left() const { return reader_.bytes_left(); }

  private:
    template <typename Number>
    Number next() {
        require(sizeof(Number));
        return reader_.next<Number>();
    }
    void require(std::size_t byte_count) const {
        if (byte_count > bytes_left())
            bytes_.fail(ErrorCode::Damaged, "the chunk that ends at byte " +
                                                std::to_string(bytes_.bytes.size()) +
                                                " has less data than it declares");
    }

    MeshSource bytes_;
    ByteReader reader_;
};

/// A node of the keyframes of a 3DS file: it moves an object.
struct Node3ds {
    std::string object;
    std::size_t number; ///< by which other nodes refer to it
    std::size_t parent; ///< the number of the parent node; kNoNode3ds for none
    Vec3d pivot;        ///< of the object, at the origin of the node
    NodeMotion motion;
};

inline constexpr std::size_t kNoNode3ds = 0xFFFF;

inline constexpr std::size_t kNotPlaced = static_cast<std::size_t>(-1);

constexpr std::uint16_t kFirstNode = 0xB001, kObjectNode = 0xB002, kLastNode = 0xB007;
constexpr std::uint16_t kHead = 0xB010, kPivot = 0xB013, kPositions = 0xB020, kRotations = 0xB021,
                        kScales = 0xB022, kNumber = 0xB030;

/// The format does not specify a frame rate; Assimp assumes 25 frames per second, too.
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

/// Each key adds a rotation to that of the one before it, clockwise as seen against its axis.
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

/// @param keyframes  the chunk of all keyframes
/// @throws Error Damaged
std::vector<Node3ds> read_nodes_3ds(const MeshSource& source, const Chunk3ds& keyframes) {
    std::vector<Node3ds> nodes;
    std::size_t number = 0;
    for_each_chunk_3ds(source, keyframes.begin, keyframes.end, [&](const Chunk3ds& chunk) {
        if (chunk.id < kFirstNode || chunk.id > kLastNode) return;
        if (chunk.id == kObjectNode) nodes.push_back(read_node(source, chunk, number));
        ++number; // lights and cameras are counted, too
    });
    return nodes;
}

/// Adds the nodes to a scene, in the poses of their first keys.
/// @return [nodes.size()] their numbers in scene.nodes; kNotPlaced for nodes that are each other's ancestors,
/// or descendants of a node that moves no object, such as a light or a camera
std::vector<std::size_t> place_nodes_3ds(const std::vector<Node3ds>& nodes, SceneFile& scene) {
    std::map<std::size_t, std::vector<std::size_t>> children; // by the number of the parent node
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
        // If several nodes have the same number, the first gets the children.
        for (const std::size_t child : std::exchange(children[nodes[node].number], {}))
            pending.push_back({child, place});
    }
    return places;
}

// Chunks of 3DS (Autodesk, "3D Studio File Toolkit", chunk list).
constexpr std::uint16_t kMain = 0x4D4D;
constexpr std::uint16_t kEditor = 0x3D3D;
constexpr std::uint16_t kObject = 0x4000; // a name, then chunks
constexpr std::uint16_t kMesh = 0x4100;
constexpr std::uint16_t kVertexList = 0x4110;
constexpr std::uint16_t kFaceList = 0x4120;
constexpr std::uint16_t kMatrix = 0x4160;
constexpr std::uint16_t kKeyframes = 0xB000;

/// The length of a list, all of whose elements must be in its chunk.
std::size_t next_count(ChunkReader3ds& reader, const char* of_what, std::size_t element_size,
                       const MeshSource& source) {
    const std::size_t count = reader.next_word();
    if (count * element_size > reader.bytes_left())
        source.fail(ErrorCode::Damaged, "a list of " + std::to_string(count) + " " + of_what + " has only " +
                                            std::to_string(reader.bytes_left()) + " bytes");
    return count;
}

void read_vertices(const MeshSource& source, const Chunk3ds& chunk, const std::string& mesh,
                   std::vector<Vec3d>& vertices) {
    ChunkReader3ds reader(source, chunk);
    for (std::size_t left = next_count(reader, "vertices", 3 * sizeof(float), source); left > 0; --left) {
        vertices.push_back(reader.next_vector());
        if (!is_finite(vertices.back()))
            source.fail(ErrorCode::InvalidMesh,
                        "vertex " + std::to_string(vertices.size() - 1) + " of " + mesh + " is not finite");
    }
}

void read_faces(const MeshSource& source, const Chunk3ds& chunk, std::vector<std::uint32_t>& corners) {
    ChunkReader3ds reader(source, chunk);
    for (std::size_t left = next_count(reader, "faces", 4 * sizeof(std::uint16_t), source); left > 0;
         --left) {
        for (int corner = 0; corner < 3; ++corner) corners.push_back(reader.next_word());
        reader.skip(sizeof(std::uint16_t)); // flags
    }
}

/// Three axes and the origin.
Affine read_matrix(const MeshSource& source, const Chunk3ds& chunk) {
    ChunkReader3ds reader(source, chunk);
    Affine matrix;
    for (Vec3d* column : {&matrix.x, &matrix.y, &matrix.z, &matrix.origin}) *column = reader.next_vector();
    return matrix;
}

/// Positions are those in the world, independently of keyframes. Lists of one kind are joined, in any order.
/// Each face gets vertices of its own, so that the welded mesh has them in the order of the faces.
/// @param matrix  out: the matrix from the object's own frame to the world, if there is one
SceneShape read_shape(const MeshSource& source, const Chunk3ds& mesh, const std::string& name,
                      Affine& matrix) {
    SceneShape shape;
    shape.name = "the mesh " + in_quotes(name);
    std::vector<Vec3d> vertices;
    std::vector<std::uint32_t> corners;
    for_each_chunk_3ds(source, mesh.begin, mesh.end, [&](const Chunk3ds& chunk) {
        if (chunk.id == kVertexList) read_vertices(source, chunk, shape.name, vertices);
        if (chunk.id == kFaceList) read_faces(source, chunk, corners);
        if (chunk.id == kMatrix) matrix = read_matrix(source, chunk);
    });
    for (std::size_t i = 0; i < corners.size(); ++i) {
        if (corners[i] >= vertices.size())
            source.fail(ErrorCode::InvalidMesh, "face " + std::to_string(i / 3) + " of " + shape.name +
                                                    " refers to vertex " + std::to_string(corners[i]) +
                                                    ", but there are " + std::to_string(vertices.size()) +
                                                    " vertices, numbered from 0");
        shape.vertices.push_back(vertices[corners[i]]);
        shape.corners.push_back(static_cast<std::uint32_t>(i));
    }
    shape.corner_counts.assign(corners.size() / 3, 3);
    return shape;
}

class Reader3ds {
  public:
    explicit Reader3ds(const MeshSource& source) : source_(source) {}

    SceneFile read(Wanted wanted) {
        read_main_chunk();
        scene_.nodes.push_back({"", 0, {}, {}}); // the node of all objects without keyframes
        places_ = place_nodes_3ds(nodes_, scene_);
        for (std::size_t i = 0; i < nodes_.size(); ++i) nodes_of_objects_[nodes_[i].object].push_back(i);
        std::map<std::string, std::size_t> object_counts, placed_counts;
        for (const std::string& name : object_names_) ++object_counts[name];
        for (std::size_t object = 0; object < object_names_.size(); ++object) {
            const std::string& name = object_names_[object];
            std::vector<std::size_t> nodes = nodes_of_objects_[name];
            const std::size_t number = placed_counts[name]++;
            // If several objects have the same name, each gets one node, in their order; for a single object,
            // all nodes but the first place copies.
            if (object_counts[name] > 1)
                nodes = number < nodes.size() ? std::vector{nodes[number]} : std::vector<std::size_t>{};
            add_instances(object, nodes, wanted);
        }
        if (wanted == Wanted::Animation) add_animation();
        return std::move(scene_);
    }

  private:
    void read_main_chunk() {
        ByteReader head(source_, sizeof(kMain), ByteOrder::LittleEndian);
        const std::size_t length = head.next<std::uint32_t>();
        if (length > source_.bytes.size())
            source_.fail(ErrorCode::Damaged, "the file says that it has " + std::to_string(length) +
                                                 " bytes, but it has " +
                                                 std::to_string(source_.bytes.size()));
        for_each_chunk_3ds(source_, head.offset(), length, [&](const Chunk3ds& chunk) {
            if (chunk.id == kKeyframes) nodes_ = read_nodes_3ds(source_, chunk);
            if (chunk.id == kEditor)
                for_each_chunk_3ds(source_, chunk.begin, chunk.end, [&](const Chunk3ds& object) {
                    if (object.id == kObject) read_object(object);
                });
        });
    }

    void read_object(const Chunk3ds& object) {
        ChunkReader3ds reader(source_, object);
        const std::string name = reader.next_name();
        for_each_chunk_3ds(source_, reader.offset(), object.end, [&](const Chunk3ds& chunk) {
            if (chunk.id != kMesh) return;
            object_names_.push_back(name);
            scene_.shapes.push_back(read_shape(source_, chunk, name, matrices_.emplace_back()));
        });
    }

    /// At rest, an object is where the file places it, and its further nodes place copies; in an animation,
    /// all of its nodes move it.
    void add_instances(std::size_t object, const std::vector<std::size_t>& nodes, Wanted wanted) {
        const bool stays = nodes.empty() || wanted == Wanted::Mesh;
        if (stays) scene_.instances.push_back({object, 0, {}, {}, {}});
        for (std::size_t i = stays ? 1 : 0; i < nodes.size(); ++i) {
            budget_.spend(scene_.shapes[object].corners.size() + 1);
            if (places_[nodes[i]] == kNotPlaced)
                fail(object,
                     "belong to a node below a light, a camera or itself; export it without a parent");
            scene_.instances.push_back({object, places_[nodes[i]], from_world(object, nodes[i]), {}, {}});
        }
    }

    /// The map from the positions in the file to the frame of a node.
    Affine from_world(std::size_t object, std::size_t node) const {
        Affine frame = matrices_[object];
        // In this case only the placement of the object is mirrored, not its motion.
        if (frame.determinant() < 0) frame.x = -frame.x;
        frame.origin = frame.apply(nodes_[node].pivot);
        if (!std::isnormal(frame.determinant()))
            fail(object, "move a frame whose scale is 0; export it with a matrix that can be inverted");
        return frame.inverse();
    }

    [[noreturn]] void fail(std::size_t object, const std::string& what) const {
        source_.fail(ErrorCode::InvalidMesh,
                     "the keyframes of the object " + in_quotes(object_names_[object]) + " " + what);
    }

    void add_animation() {
        SceneAnimation animation{"keyframes", {}};
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
            const NodeMotion& motion = nodes_[i].motion;
            const std::size_t key_count = std::max(
                {motion.positions.times.size(), motion.rotations.times.size(), motion.scales.times.size()});
            if (key_count > 1 && places_[i] != kNotPlaced) animation.nodes[places_[i]] = motion;
        }
        if (!animation.nodes.empty()) scene_.animations.push_back(std::move(animation));
    }

    const MeshSource& source_;
    Budget budget_{source_};
    SceneFile scene_;
    std::vector<std::string> object_names_; ///< of the shapes
    std::vector<Affine> matrices_;          ///< of the shapes
    std::vector<Node3ds> nodes_;
    std::vector<std::size_t> places_; ///< of the nodes, in scene_.nodes
    std::map<std::string, std::vector<std::size_t>> nodes_of_objects_;
};

} // namespace

void require_beginning_of_3ds(const MeshSource& beginning) {
    if (beginning.bytes.size() < sizeof(kMain) + sizeof(std::uint32_t) ||
        ByteReader(beginning, 0, ByteOrder::LittleEndian).next<std::uint16_t>() != kMain)
        beginning.fail(ErrorCode::WrongFormat, "the bytes 4D 4D with which a 3DS file begins were not found");
}

SceneFile read_3ds(const MeshSource& source, Wanted wanted) {
    require_beginning_of_3ds(source);
    return Reader3ds(source).read(wanted);
}

} // namespace echinus
