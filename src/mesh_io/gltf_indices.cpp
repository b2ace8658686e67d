#include "mesh_io/gltf_indices.hpp"

#include "files/read_file.hpp"
#include "mesh_io/byte_reader.hpp"
#include "mesh_io/json_view.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

namespace echinus {

namespace {

namespace fs = std::filesystem;

/// Ignores characters without meaning, such as the padding and the backslash of an escaped solidus.
std::string decode_base64(std::string_view text) {
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    std::uint32_t bits = 0;
    unsigned bit_count = 0;
    for (const char c : text) {
        const std::size_t digit = kDigits.find(c);
        if (digit == std::string_view::npos) continue;
        bits = bits << 6U | static_cast<std::uint32_t>(digit);
        bit_count += 6;
        if (bit_count < 8) continue;
        bit_count -= 8;
        bytes.push_back(static_cast<char>(bits >> bit_count & 0xFFU));
    }
    return bytes;
}

/// The bytes of one buffer, wherever they lie.
class GltfBuffer {
  public:
    GltfBuffer(const MeshSource& source, const JsonView& buffer, std::string_view binary) {
        const std::optional<std::string_view> uri = buffer.member("uri").string();
        if (!uri)
            bytes_ = binary;
        else if (uri->starts_with("data:"))
            bytes_ = decoded_ = decode_base64(uri->substr(std::min(uri->find(','), uri->size())));
        else
            read(fs::path(source.name).parent_path() / *uri);
    }
    GltfBuffer(const GltfBuffer&) = delete; // the bytes may be its own
    GltfBuffer& operator=(const GltfBuffer&) = delete;

    std::string_view bytes() const { return bytes_; }

  private:
    void read(const fs::path& file) {
        std::error_code ignored;
        if (!fs::is_regular_file(file, ignored)) return; // Assimp says so
        try {
            file_ = read_file(file);
        } catch (const Error&) {
            return; // it fails in Assimp, too
        }
        bytes_ = {reinterpret_cast<const char*>(file_.data()), file_.size()};
    }

    std::string decoded_;
    std::vector<std::byte> file_;
    std::string_view bytes_;
};

std::size_t number_or_zero(const JsonView& value) {
    return value.natural_number().value_or(0);
}

/// 5121, 5123 and 5125 are OpenGL's names of the types of indices.
std::size_t index_size(const JsonView& accessor) {
    const std::size_t type = number_or_zero(accessor.member("componentType"));
    return type == 5121 ? 1 : type == 5123 ? 2 : type == 5125 ? 4 : 0;
}

std::uint32_t index_at(const MeshSource& buffer, std::size_t offset, std::size_t size) {
    ByteReader reader(buffer, offset, ByteOrder::LittleEndian);
    if (size == 1) return reader.next<std::uint8_t>();
    if (size == 2) return reader.next<std::uint16_t>();
    return reader.next<std::uint32_t>();
}

class GltfIndices {
  public:
    GltfIndices(const MeshSource& source, const JsonView& root, std::string_view binary)
        : source_(source), binary_(binary), accessors_(root.member("accessors").elements()),
          views_(root.member("bufferViews").elements()), buffers_(root.member("buffers").elements()),
          opened_(buffers_.size()), largest_(accessors_.size()) {}

    void require_vertices(const JsonView& primitive, std::size_t mesh) {
        const auto indices = primitive.member("indices").natural_number();
        const auto positions = primitive.member("attributes").member("POSITION").natural_number();
        if (!indices || !positions || *indices >= accessors_.size() || *positions >= accessors_.size())
            return;
        const std::size_t vertex_count = number_or_zero(accessors_[*positions].member("count"));
        const std::optional<std::uint32_t> largest = largest_index(*indices);
        if (largest && *largest >= vertex_count)
            source_.fail(ErrorCode::InvalidMesh, "a face of mesh " + std::to_string(mesh) +
                                                     " refers to vertex " + std::to_string(*largest) +
                                                     ", but there are " + std::to_string(vertex_count) +
                                                     " vertices, numbered from 0");
    }

  private:
    /// Cached: many primitives may name one accessor, and each look-up reads all of it.
    std::optional<std::uint32_t> largest_index(std::size_t accessor) {
        if (!largest_[accessor]) largest_[accessor] = find_largest(accessors_[accessor]);
        return *largest_[accessor];
    }

    std::optional<std::uint32_t> find_largest(const JsonView& accessor) {
        const auto view_number = accessor.member("bufferView").natural_number();
        if (!view_number || *view_number >= views_.size() || accessor.member("sparse").exists()) return {};
        const JsonView& view = views_[*view_number];
        const std::size_t number = number_or_zero(view.member("buffer"));
        if (number >= buffers_.size()) return {};
        std::string_view bytes = buffer(number);
        for (const JsonView& start : {view, accessor})
            bytes.remove_prefix(
                std::min<std::size_t>(number_or_zero(start.member("byteOffset")), bytes.size()));
        return find_largest(bytes, accessor, number_or_zero(view.member("byteStride")));
    }

    std::optional<std::uint32_t> find_largest(std::string_view bytes, const JsonView& accessor,
                                              std::size_t stride) const {
        const std::size_t count = number_or_zero(accessor.member("count"));
        const std::size_t size = index_size(accessor);
        if (stride == 0) stride = size;
        if (count == 0 || size == 0 || size > bytes.size()) return {};
        if (count - 1 > (bytes.size() - size) / stride) return {};
        const MeshSource buffer{source_.name, bytes};
        std::uint32_t largest = 0;
        for (std::size_t i = 0; i < count; ++i)
            largest = std::max(largest, index_at(buffer, i * stride, size));
        return largest;
    }

    std::string_view buffer(std::size_t number) {
        if (!opened_[number])
            opened_[number] = std::make_unique<GltfBuffer>(source_, buffers_[number], binary_);
        return opened_[number]->bytes();
    }

    const MeshSource& source_;
    std::string_view binary_;
    std::vector<JsonView> accessors_, views_, buffers_;
    std::vector<std::unique_ptr<GltfBuffer>> opened_;
    std::vector<std::optional<std::optional<std::uint32_t>>> largest_; ///< of each accessor, once looked for
};

} // namespace

void require_gltf_vertices(const MeshSource& source, std::string_view json, std::string_view binary) {
    const JsonView root(json);
    GltfIndices indices(source, root, binary);
    const std::vector<JsonView> meshes = root.member("meshes").elements();
    for (std::size_t mesh = 0; mesh < meshes.size(); ++mesh)
        for (const JsonView& primitive : meshes[mesh].member("primitives").elements())
            indices.require_vertices(primitive, mesh);
}

} // namespace echinus
