#pragma once

#include "mesh_io/byte_reader.hpp"
#include "mesh_io/mesh_source.hpp"

#include <echinus/geometry.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

namespace echinus {

/// A chunk of a 3DS file, which has an id, its size with this head, and its content, often other chunks
/// (Autodesk, "3D Studio File Toolkit", chunk list).
struct Chunk3ds {
    std::uint16_t id;
    std::size_t begin, end; ///< the content's
};

/// Calls visit(chunk) for each chunk in another one, from `begin` on.
/// @throws Error Damaged when a chunk reaches beyond the one that it is in
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
                                                std::to_string(end - begin) + " are left where it is");
        visit(Chunk3ds{id, begin + kHeadSize, begin + size});
        begin += size;
    }
}

/// The numbers of one chunk.
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
    /// Up to a zero byte.
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
                                                " has less data than it promises");
    }

    MeshSource bytes_;
    ByteReader reader_;
};

} // namespace echinus
