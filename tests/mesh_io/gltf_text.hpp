#pragma once

#include <echinus/mesh.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace echinus::test {

inline std::string base64(const std::string& bytes) {
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        for (unsigned k = 0; k < 4; ++k)
            text += i + k > bytes.size() ? '=' : kDigits[group >> (18 - 6 * k) & 63U];
    }
    return text;
}

/// The bytes of values, on a little-endian machine.
template <typename Value>
std::string bytes_of(const std::vector<Value>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value)};
}
template <typename Value>
std::string bytes_of(Value value) {
    return bytes_of(std::vector<Value>{value});
}

/// A glTF file by hand. Members are JSON and may be changed at will.
struct GltfText {
    std::string scenes = R"([{"nodes":[0]}])";
    std::string nodes = R"([{"mesh":0}])";
    std::string meshes; ///< array
    std::string more;   ///< members of the root, each with a comma in front
    std::string accessors, views;
    std::string binary;

    /// Appends an accessor of `width` numbers an element with a bufferView of its own.
    /// @param more_of_accessor  members, each with a comma in front
    /// @returns its number
    template <typename Value>
    std::size_t add(const std::vector<Value>& values, std::size_t width = 1,
                    const std::string& more_of_accessor = "") {
        constexpr int kType = std::is_same_v<Value, float>           ? 5126
                              : std::is_same_v<Value, std::int8_t>   ? 5120
                              : std::is_same_v<Value, std::uint8_t>  ? 5121
                              : std::is_same_v<Value, std::int16_t>  ? 5122
                              : std::is_same_v<Value, std::uint16_t> ? 5123
                                                                     : 5125;
        const std::size_t view = add_view(bytes_of(values));
        return add_accessor(R"("bufferView":)" + std::to_string(view) + R"(,"componentType":)" +
                            std::to_string(kType) + R"(,"count":)" + std::to_string(values.size() / width) +
                            R"(,"type":")" + type_of(width) + "\"" + more_of_accessor);
    }
    std::size_t add_accessor(const std::string& members) {
        accessors += (accessors.empty() ? "{" : ",{") + members + "}";
        return accessor_count++;
    }
    std::size_t add_view(const std::string& bytes) {
        binary.resize((binary.size() + 3) / 4 * 4, '\0');
        views += (views.empty() ? "" : ",") + std::string(R"({"buffer":0,"byteOffset":)") +
                 std::to_string(binary.size()) + R"(,"byteLength":)" + std::to_string(bytes.size()) + "}";
        binary += bytes;
        return view_count++;
    }
    /// Appends the vertices and faces of a mesh. @returns attributes and indices of a primitive
    std::string add_mesh(const TriangleMesh& mesh, const std::string& more_attributes = "") {
        std::vector<float> positions;
        for (const Vec3f& p : mesh.vertices) positions.insert(positions.end(), {p.x, p.y, p.z});
        std::vector<std::uint32_t> corners;
        for (const Triangle& face : mesh.faces) corners.insert(corners.end(), face.begin(), face.end());
        const std::string position = std::to_string(add(positions, 3));
        return R"("attributes":{"POSITION":)" + position + more_attributes + R"(},"indices":)" +
               std::to_string(add(corners));
    }

    static const char* type_of(std::size_t width) {
        return width == 1 ? "SCALAR" : width == 3 ? "VEC3" : width == 4 ? "VEC4" : "MAT4";
    }

    /// @param buffer  members of the only buffer but its length
    std::string json(const std::string& buffer) const {
        return R"({"asset":{"version":"2.0"},"scenes":)" + scenes + R"(,"nodes":)" + nodes + R"(,"meshes":)" +
               meshes + R"(,"accessors":[)" + accessors + R"(],"bufferViews":[)" + views +
               R"(],"buffers":[{)" + buffer + (buffer.empty() ? "" : ",") + R"("byteLength":)" +
               std::to_string(binary.size()) + "}]" + more + "}";
    }
    /// With the buffer as base64.
    std::string text() const {
        return json(R"("uri":"data:application/octet-stream;base64,)" + base64(binary) + "\"");
    }
    /// @param padded  to four bytes, as the format demands; otherwise the JSON has an odd length
    std::string glb(bool padded = true) const {
        std::string json_chunk = json("");
        while (json_chunk.size() % 4 != (padded ? 0 : 1)) json_chunk += ' ';
        const auto size = [](const std::string& s) { return bytes_of(static_cast<std::uint32_t>(s.size())); };
        const std::string chunks =
            size(json_chunk) + "JSON" + json_chunk + size(binary) + std::string("BIN\0", 4) + binary;
        return "glTF" + bytes_of(std::uint32_t{2}) +
               bytes_of(static_cast<std::uint32_t>(chunks.size() + 12)) + chunks;
    }

    std::size_t accessor_count = 0, view_count = 0;
};

} // namespace echinus::test
