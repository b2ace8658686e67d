#pragma once

#include "geometry/whole_numbers.hpp"

#include <echinus/error.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace echinus {

/// A mesh file in memory.
struct MeshSource {
    std::string name; ///< the path, with which every sentence of an error begins
    std::string_view bytes;

    [[noreturn]] void fail(ErrorCode code, const std::string& what) const {
        throw Error(code, name + ": " + what);
    }
};

/// The text of a file, after a byte order mark of UTF-8 if there is one.
/// @throws Error WrongFormat if the text is UTF-16 or UTF-32
std::string_view text_of(const MeshSource& source);

/// The text with ASCII capitals in lower case, independently of the locale.
std::string lower_case(std::string_view text);

/// The extension of a path's name, with the dot, in lower case: ".obj" for "A/Horse.OBJ".
std::string lower_case_ending(const std::filesystem::path& path);

/// The text with ? for bytes that are not printable, for use in a sentence.
std::string printable(std::string_view text);

/// A word of a file for use in a sentence: in quotation marks, printable, cut short.
std::string in_quotes(std::string_view text);

enum class ByteOrder { LittleEndian, BigEndian };

/// Reads numbers from bytes, one after the other.
class ByteReader {
  public:
    ByteReader(const MeshSource& source, std::size_t offset, ByteOrder order)
        : source_(source), offset_(std::min(offset, source.bytes.size())), order_(order) {}

    /// @throws Error Damaged if the file ends before it
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
    /// Advances past the bytes and returns the offset of the first.
    std::size_t require(std::size_t byte_count) {
        if (byte_count > bytes_left())
            source_.fail(ErrorCode::Damaged, "the file ends at byte " + std::to_string(source_.bytes.size()) +
                                                 ", within the data that its header declares");
        offset_ += byte_count;
        return offset_ - byte_count;
    }

    const MeshSource& source_;
    std::size_t offset_;
    ByteOrder order_;
};

/// Counts the vertices, corners and keys that are made from a file, to protect against small files that refer
/// to the same bytes again and again.
class Budget {
  public:
    explicit Budget(const MeshSource& source) : source_(source), byte_count_(source.bytes.size()) {}

    /// Adds bytes that belong to the file but are stored elsewhere.
    void add_bytes(std::size_t count) { byte_count_ += count; }

    /// @throws Error InvalidMesh if the total is out of proportion to the file's size
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
