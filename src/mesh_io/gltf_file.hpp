#pragma once

#include "mesh_io/budget.hpp"
#include "mesh_io/mesh_source.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace echinus {

/// A value of a glTF document and the path to it, with which sentences name it: meshes[0].primitives[2]. A
/// value that is not there has no members and no elements. All members throw Error InvalidMesh for a value
/// of another kind than the one asked for.
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
    /// [count] numbers; nothing when the value is not there.
    std::optional<std::vector<double>> numbers(std::size_t count) const;
    std::vector<double> numbers() const; ///< however many
    std::string string() const;          ///< "" when it is not there
    bool boolean() const;                ///< false when it is not there

    /// @param what  completes the sentence that begins with the path: "is no number"
    [[noreturn]] void fail(const std::string& what, ErrorCode code = ErrorCode::InvalidMesh) const;

  private:
    double number() const;

    const MeshSource* source_;
    const nlohmann::json* value_;
    std::string path_;
};

/// A glTF 2.0 file: its document, and the bytes of its buffers, whether they lie in the binary part of a GLB
/// file, in the text as base64, or in a file beside it.
///
/// Not tinygltf (2.7): it reads what is simple, the document, into structures of its own, and leaves to its
/// users all that can go wrong: the bounds, strides and types of accessors, sparse ones, trees of nodes.
class GltfFile {
  public:
    /// @throws Error WrongFormat for other versions and for required extensions that are not read, Damaged
    /// for bytes that are missing and text that is no JSON
    explicit GltfFile(const MeshSource& source);
    GltfFile(const GltfFile&) = delete; // values refer to it
    GltfFile& operator=(const GltfFile&) = delete;

    const MeshSource& source() const { return source_; }
    GltfValue root() const { return {source_, &document_, ""}; }
    /// The element `index` of the root's array `key`, as `user` names it.
    const GltfValue& element(const char* key, const GltfValue& user);
    /// The bytes of a buffer. @throws Error Unreadable when there is no such file, Damaged when it is short
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
    std::map<std::string, std::vector<GltfValue>> arrays_; ///< of the root, once asked for
    std::map<std::size_t, std::string_view> buffers_;      ///< those that were asked for
    std::map<std::size_t, std::string> decoded_;           ///< of buffers that the text holds
    std::map<std::string, std::vector<std::byte>> files_;  ///< beside this one; several buffers may name one
    Budget budget_;
};

} // namespace echinus
