#pragma once

#include "geometry/whole_numbers.hpp"
#include "mesh_io/mesh_source.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>

namespace echinus {

enum class ByteOrder { LittleEndian, BigEndian };

/// Reads numbers from bytes, one after the other.
class ByteReader {
  public:
    ByteReader(const MeshSource& source, std::size_t offset, ByteOrder order)
        : source_(source), offset_(std::min(offset, source.bytes.size())), order_(order) {}

    /// @throws Error Damaged when the file ends before
    template <typename Number>
    Number next() {
        std::array<char, sizeof(Number)> bytes{};
        source_.bytes.copy(bytes.data(), sizeof(Number), require(sizeof(Number)));
        const bool host_is_little = std::endian::native == std::endian::little;
        if (host_is_little != (order_ == ByteOrder::LittleEndian)) std::reverse(bytes.begin(), bytes.end());
        return echinus::bit_cast<Number>(bytes); // not std's, found by the argument
    }

    void skip(std::size_t byte_count) { require(byte_count); }

    std::size_t offset() const { return offset_; }
    std::size_t bytes_left() const { return source_.bytes.size() - offset_; }

  private:
    /// Moves over the bytes and gives the offset of the first.
    std::size_t require(std::size_t byte_count) {
        if (byte_count > bytes_left())
            source_.fail(ErrorCode::Damaged, "the file ends at byte " + std::to_string(source_.bytes.size()) +
                                                 ", inside of the data that its head promises");
        offset_ += byte_count;
        return offset_ - byte_count;
    }

    const MeshSource& source_;
    std::size_t offset_;
    ByteOrder order_;
};

} // namespace echinus
