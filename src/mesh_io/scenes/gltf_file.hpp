#pragma once

#include "mesh_io/mesh_source.hpp"

#include <echinus/geometry.hpp>

#include <nlohmann/json.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace echinus {

/// A value of a glTF document and the path to it, by which sentences name it: meshes[0].primitives[2]. An
/// absent value has no members and no elements. All member functions throw Error InvalidMesh if the value is
/// not of the requested kind.
class GltfValue {
  public:
    GltfValue(const MeshSource& source, const nlohmann::json* value, std::string path)
        : source_(&source), value_(value), path_(std::move(path)) {}

    bool exists() const { return value_ != nullptr; }
    const std::string& path() const { return path_; }
    GltfValue member(const char* key) const;
    std::vector<GltfValue> elements() const;

    std::size_t natural_number() const; ///< up to 2^53
    std::optional<std::size_t> optional_number() const;
    /// [count] numbers; none if the value is absent.
    std::optional<std::vector<double>> numbers(std::size_t count) const;
    std::vector<double> numbers() const; ///< any number of them
    std::string string() const;          ///< "" if it is absent
    bool boolean() const;                ///< false if it is absent

    /// @param what  completes the sentence that begins with the path: "is not a number"
    [[noreturn]] void fail(const std::string& what, ErrorCode code = ErrorCode::InvalidMesh) const;

  private:
    double number() const;

    const MeshSource* source_;
    const nlohmann::json* value_;
    std::string path_;
};

/// A glTF 2.0 file: its document, and the bytes of its buffers, which are in the binary part of a GLB file,
/// in the text as base64, or in separate files.
///
/// It does not use tinygltf (2.7), which reads the document, the simple part, into structures of its own, but
/// leaves everything that can go wrong to its users: the bounds, strides and types of accessors, sparse
/// accessors, and trees of nodes.
class GltfFile {
  public:
    /// @throws Error WrongFormat for other versions and for required extensions that are not supported,
    /// Damaged for missing bytes and for text that is not JSON
    explicit GltfFile(const MeshSource& source);
    GltfFile(const GltfFile&) = delete; // values refer to it
    GltfFile& operator=(const GltfFile&) = delete;

    const MeshSource& source() const { return source_; }
    GltfValue root() const { return {source_, &document_, ""}; }
    /// The element `index` of the root's array `key`, as `user` names it.
    const GltfValue& element(const char* key, const GltfValue& user);
    /// The bytes of a buffer. @throws Error Unreadable if there is no such file, Damaged if it is too short
    std::string_view buffer(const GltfValue& user);

    /// Budget::spend()
    void spend(std::size_t count) { budget_.spend(count); }

  private:
    void parse(std::string_view text);
    void require_readable() const;
    std::string_view open_buffer(const GltfValue& buffer, std::size_t number);
    std::string_view read_beside(const GltfValue& buffer, const std::string& uri);

    const MeshSource& source_;
    std::optional<std::string_view> binary_; ///< of a GLB file
    nlohmann::json document_;
    std::map<std::string, std::vector<GltfValue>> arrays_; ///< of the root, after they were requested
    std::map<std::size_t, std::string_view> buffers_;      ///< those that were requested
    std::map<std::size_t, std::string> decoded_;           ///< of buffers that are in the text
    /// The separate files; several buffers may name the same one.
    std::map<std::string, std::vector<std::byte>> files_;
    Budget budget_;
};

/// The numbers of an accessor (glTF 2.0, sections 3.6.2 and 5.1), with any stride, sparse or not. They are
/// read on request.
class GltfAccessor {
  public:
    /// @param user  the value that names the accessor, in sentences
    /// @throws Error Damaged if a buffer ends before the accessor does, InvalidMesh for contradictions
    GltfAccessor(GltfFile& file, const GltfValue& user);

    std::size_t count() const { return count_; }
    std::size_t width() const { return width_; } ///< the number of numbers per element
    bool has_own_bytes() const { return !dense_.bytes.empty(); }

    /// Integers that represent fractions are converted to these (section 3.6.2.2).
    /// @pre element < count(), component < width()
    double number(std::size_t element, std::size_t component) const;
    Vec3d vector(std::size_t element) const {
        return {number(element, 0), number(element, 1), number(element, 2)};
    }
    /// @pre the accessor was required to have whole numbers
    std::uint32_t natural_number(std::size_t element, std::size_t component = 0) const;

    /// @throws Error InvalidMesh
    void require_width(std::size_t width) const;
    void require_count(std::size_t count) const;
    void require_natural_numbers() const;

  private:
    struct Elements {
        std::string_view bytes; ///< from the first element on; empty if all numbers are 0
        std::size_t stride = 0;
    };

    Elements elements_of(const GltfValue& owner, std::size_t count, std::size_t size) const;
    void read_sparse(const GltfValue& sparse);
    const char* find(std::size_t element, std::size_t component) const;

    GltfFile& file_;
    GltfValue user_;
    std::size_t count_, width_;
    std::size_t component_type_;
    std::size_t component_size_;
    bool is_normalized_;
    Elements dense_, replaced_;
    std::vector<std::uint32_t> replaced_elements_; ///< ascending
};

} // namespace echinus
