#pragma once

#include "mesh_io/mesh_source.hpp"

#include <algorithm>
#include <cstddef>
#include <string>

namespace echinus {

/// Counts the vertices, corners and keys that are made of a file, against small files that name the same
/// bytes again and again.
class Budget {
  public:
    explicit Budget(const MeshSource& source) : source_(source), byte_count_(source.bytes.size()) {}

    /// Bytes that belong to the file but lie elsewhere.
    void add_bytes(std::size_t count) { byte_count_ += count; }

    /// @throws Error InvalidMesh when all that is made is out of proportion to the file's size
    void spend(std::size_t count) {
        constexpr std::size_t kFree = std::size_t{1} << 22, kForByte = 32;
        constexpr std::size_t kMost = std::size_t{1} << 31; // vertices are numbered by 32 bits
        const std::size_t most = std::min(kMost, kFree + kForByte * byte_count_);
        if (count > most - spent_)
            source_.fail(ErrorCode::InvalidMesh,
                         "the file names the same data so often that more than " + std::to_string(most) +
                             " vertices and corners would be made of it; export it with fewer copies");
        spent_ += count;
    }

  private:
    const MeshSource& source_;
    std::size_t byte_count_;
    std::size_t spent_ = 0;
};

} // namespace echinus
