#include "mesh_io/scene_guards.hpp"

#include "mesh_io/byte_reader.hpp"
#include "mesh_io/gltf_animation.hpp"
#include "mesh_io/gltf_indices.hpp"
#include "mesh_io/json_view.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace echinus {

namespace {

void require_moderate(std::size_t found, std::size_t limit, const char* what, const MeshSource& source) {
    if (found > limit)
        source.fail(ErrorCode::Damaged,
                    std::string(what) + ", of which at most " + std::to_string(limit) + " are read");
}

/// Could this string be the key "children"? Escaped letters are not decoded: no program writes them there.
bool may_be_children(std::string_view string) {
    return string == "\"children\"" || string.find("\\u") != std::string_view::npos;
}

/// Extensions of glTF that keep positions in another form than 32-bit floats. Assimp would take the bytes for
/// such floats, or the mesh for empty.
void require_plain_floats(std::string_view string, const MeshSource& source) {
    for (const std::string_view extension :
         {"KHR_mesh_quantization", "KHR_draco_mesh_compression", "EXT_meshopt_compression"})
        if (string.find(extension) != std::string_view::npos)
            source.fail(ErrorCode::WrongFormat, "the file uses the extension " + std::string(extension) +
                                                    ", which is not read; export it without compression");
}

void require_readable_json(std::string_view json, const MeshSource& source) {
    std::size_t depth = 0;
    std::size_t deepest = 0;
    std::size_t parent_count = 0;
    for (std::size_t i = 0; i < json.size(); ++i) {
        const char c = json[i];
        if (c == '[' || c == '{') deepest = std::max(deepest, ++depth);
        if ((c == ']' || c == '}') && depth > 0) --depth;
        if (c != '"') continue;
        const std::size_t end = end_of_json_string(json, i);
        const std::string_view string = json.substr(i, end - i);
        require_plain_floats(string, source);
        if (may_be_children(string)) ++parent_count;
        i = end - 1;
    }
    require_moderate(deepest, kMaxJsonDepth, "the JSON has too many brackets in brackets", source);
    require_moderate(parent_count, kMaxParentNodes, "there are too many nodes with children", source);
}

// Chunks of 3DS (Autodesk, "3D Studio File Toolkit", chunk list): an id, the size with this head, the
// content.
constexpr std::uint16_t kMainChunk = 0x4D4D;
constexpr std::uint16_t kEditor = 0x3D3D;
constexpr std::uint16_t kObject = 0x4000; // a name that ends with a zero byte, then chunks
constexpr std::uint16_t kMesh = 0x4100;
constexpr std::uint16_t kVertexList = 0x4110;
constexpr std::uint16_t kFaceList = 0x4120;
constexpr std::uint16_t kKeyframes = 0xB000;
constexpr std::uint16_t kObjectNode = 0xB002;
constexpr std::size_t kChunkHeadSize = 6;
constexpr std::size_t kFaceSize = 8; // three vertices and flags, of 16 bits each

/// Calls visit(id, begin, end) for the content of each chunk in a range, as far as they are whole.
template <typename Visit>
void for_each_chunk(const MeshSource& source, std::size_t begin, std::size_t end, Visit&& visit) {
    while (begin + kChunkHeadSize <= end) {
        ByteReader head(source, begin, ByteOrder::LittleEndian);
        const auto id = head.next<std::uint16_t>();
        const std::size_t size = head.next<std::uint32_t>();
        if (size < kChunkHeadSize || size > end - begin) return;
        visit(id, begin + kChunkHeadSize, begin + size);
        begin += size;
    }
}

/// The lists of one mesh of a 3DS file.
struct MeshLists {
    std::size_t vertex_count = 0;
    std::vector<std::size_t> face_lists; ///< offsets of the face counts
};

void require_vertices(const MeshSource& source, const std::string& mesh_name, const MeshLists& lists) {
    std::size_t face = 0;
    for (const std::size_t offset : lists.face_lists) {
        ByteReader reader(source, offset, ByteOrder::LittleEndian);
        for (std::size_t left = reader.next<std::uint16_t>(); left > 0; --left, ++face) {
            for (int corner = 0; corner < 3; ++corner) {
                const std::size_t vertex = reader.next<std::uint16_t>();
                if (vertex >= lists.vertex_count)
                    source.fail(ErrorCode::InvalidMesh,
                                "face " + std::to_string(face) + " of the mesh " + in_quotes(mesh_name) +
                                    " refers to vertex " + std::to_string(vertex) + ", but there are " +
                                    std::to_string(lists.vertex_count) + " vertices, numbered from 0");
            }
            reader.skip(sizeof(std::uint16_t)); // flags
        }
    }
}

/// Faces beyond the end of their chunk are refused: many small chunks that declare many faces each would take
/// forever to read.
void require_whole_face_list(const MeshSource& source, std::size_t begin, std::size_t end) {
    const std::size_t face_count = ByteReader(source, begin, ByteOrder::LittleEndian).next<std::uint16_t>();
    if (sizeof(std::uint16_t) + face_count * kFaceSize > end - begin)
        source.fail(ErrorCode::Damaged, "a list of " + std::to_string(face_count) + " faces has only " +
                                            std::to_string(end - begin) + " bytes");
}

/// Assimp joins lists of one kind, in whatever order they come.
void require_vertices_of_mesh(const MeshSource& source, const std::string& mesh_name, std::size_t begin,
                              std::size_t end) {
    MeshLists lists;
    for_each_chunk(source, begin, end, [&](std::uint16_t id, std::size_t content, std::size_t content_end) {
        if (id == kVertexList)
            lists.vertex_count += ByteReader(source, content, ByteOrder::LittleEndian).next<std::uint16_t>();
        if (id != kFaceList) return;
        require_whole_face_list(source, content, content_end);
        lists.face_lists.push_back(content);
    });
    require_vertices(source, mesh_name, lists);
}

void require_vertices_of_object(const MeshSource& source, std::size_t begin, std::size_t end) {
    const std::string_view content = source.bytes.substr(begin, end - begin);
    const std::size_t name_length = content.find('\0');
    if (name_length == std::string_view::npos) return;
    const std::string name(content.substr(0, name_length));
    for_each_chunk(source, begin + name_length + 1, end,
                   [&](std::uint16_t id, std::size_t mesh_begin, std::size_t mesh_end) {
                       if (id == kMesh) require_vertices_of_mesh(source, name, mesh_begin, mesh_end);
                   });
}

constexpr std::size_t kJsonBegin = 20; // after magic, version, length, and the chunk's length and type

/// The content of the chunk after the JSON, if there is one.
std::string_view binary_chunk(const MeshSource& source, std::size_t begin) {
    constexpr std::size_t kHeadSize = 8; // length and type
    ByteReader head(source, begin, ByteOrder::LittleEndian);
    if (head.bytes_left() < kHeadSize) return {};
    const std::size_t length = head.next<std::uint32_t>();
    return source.bytes.substr(begin + kHeadSize, length);
}

} // namespace

void require_beginning_of_gltf(const MeshSource& beginning) {
    const std::size_t first = beginning.bytes.find_first_not_of(" \t\r\n");
    // After nothing but white space the brace may still follow.
    if (first != std::string_view::npos && beginning.bytes[first] != '{')
        beginning.fail(ErrorCode::WrongFormat, "the brace with which a glTF file begins was not found");
}

void require_beginning_of_glb(const MeshSource& beginning) {
    if (!beginning.bytes.starts_with("glTF"))
        beginning.fail(ErrorCode::WrongFormat, "the word glTF with which a GLB file begins was not found");
}

void require_beginning_of_3ds(const MeshSource& beginning) {
    if (beginning.bytes.size() < kChunkHeadSize ||
        ByteReader(beginning, 0, ByteOrder::LittleEndian).next<std::uint16_t>() != kMainChunk)
        beginning.fail(ErrorCode::WrongFormat, "the bytes 4D 4D with which a 3DS file begins were not found");
}

void require_readable_gltf(const MeshSource& source) {
    require_beginning_of_gltf(source);
    require_readable_json(source.bytes, source);
    require_gltf_vertices(source, source.bytes, {});
    require_whole_gltf_animations(source, source.bytes);
}

void require_readable_glb(const MeshSource& source) {
    require_beginning_of_glb(source);
    ByteReader head(source, 8, ByteOrder::LittleEndian);
    const std::size_t length = head.next<std::uint32_t>();
    if (length != source.bytes.size())
        source.fail(ErrorCode::Damaged, "the file says that it has " + std::to_string(length) +
                                            " bytes, but it has " + std::to_string(source.bytes.size()));
    const std::size_t json_length = head.next<std::uint32_t>();
    head.skip(4);
    head.skip(json_length);
    const std::string_view json = source.bytes.substr(kJsonBegin, json_length);
    require_readable_json(json, source);
    require_gltf_vertices(source, json, binary_chunk(source, kJsonBegin + json_length));
    require_whole_gltf_animations(source, json);
}

void require_readable_3ds(const MeshSource& source) {
    require_beginning_of_3ds(source);
    ByteReader head(source, sizeof(kMainChunk), ByteOrder::LittleEndian);
    const std::size_t length = head.next<std::uint32_t>();
    if (length > source.bytes.size())
        source.fail(ErrorCode::Damaged, "the file says that it has " + std::to_string(length) +
                                            " bytes, but it has " + std::to_string(source.bytes.size()));
    std::size_t node_count = 0;
    for_each_chunk(source, kChunkHeadSize, length, [&](std::uint16_t id, std::size_t begin, std::size_t end) {
        if (id != kKeyframes) return;
        for_each_chunk(source, begin, end, [&](std::uint16_t inner_id, std::size_t, std::size_t) {
            if (inner_id == kObjectNode) ++node_count;
        });
    });
    require_moderate(node_count, kMaxParentNodes, "there are too many nodes", source);
    for_each_chunk(source, kChunkHeadSize, length, [&](std::uint16_t id, std::size_t begin, std::size_t end) {
        if (id != kEditor) return;
        for_each_chunk(source, begin, end,
                       [&](std::uint16_t inner_id, std::size_t object_begin, std::size_t object_end) {
                           if (inner_id == kObject)
                               require_vertices_of_object(source, object_begin, object_end);
                       });
    });
}

std::string_view json_of(const MeshSource& gltf) {
    if (!gltf.bytes.starts_with("glTF")) return gltf.bytes;
    ByteReader head(gltf, 12, ByteOrder::LittleEndian);
    const std::size_t length = head.next<std::uint32_t>();
    return gltf.bytes.substr(std::min(kJsonBegin, gltf.bytes.size()), length);
}

} // namespace echinus
