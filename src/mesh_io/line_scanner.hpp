#pragma once

#include "mesh_io/mesh_source.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace echinus {

/// Walks over a text line by line and word by word. Lines end with \n, \r\n or \r; a # begins a comment; a
/// backslash before the end of a line joins it with the next one. Empty lines are passed over.
///
/// Every sentence of an error names the line.
class LineScanner {
  public:
    explicit LineScanner(const MeshSource& source) : source_(source) {}
    /// Begins at an offset, where the line of this number does.
    LineScanner(const MeshSource& source, std::size_t offset, std::size_t line_number)
        : source_(source), next_(offset), next_number_(line_number) {}

    /// Goes to the next line that has a word. False at the end of the text.
    /// @throws Error WrongFormat when the line has control characters and so is no text
    bool next_line();

    /// As above, where the format promises another line.
    /// @throws Error Damaged when there is none; the sentence says that `what` was expected
    void require_line(const std::string& what);

    /// The next word of the line; empty at its end.
    std::string_view next_word();

    bool at_end_of_line();

    /// The next word as a number. Coordinates are rounded to the nearest float.
    /// @throws Error Damaged when there is none; InvalidMesh when it is not finite as a float
    float next_coordinate();

    /// @throws Error Damaged when the next word is no integer of 64 bits
    std::int64_t next_integer(const std::string& what);

    /// The next word as an index below `vertex_count`.
    /// @throws Error Damaged when there is none; InvalidMesh when it is out of range
    std::uint32_t next_vertex_index(std::size_t vertex_count);

    /// Where the next line begins.
    std::size_t offset() const { return next_; }
    std::size_t line_number() const { return line_number_; }

    /// Says that `what` was expected instead of this word, or instead of the line's end where it is empty.
    [[noreturn]] void fail_expecting(const std::string& what, std::string_view word,
                                     ErrorCode code = ErrorCode::Damaged) const;
    [[noreturn]] void fail(ErrorCode code, const std::string& what) const;
    [[noreturn]] void fail_at(std::size_t line_number, ErrorCode code, const std::string& what) const;

  private:
    void take_line();
    void require_text() const;

    const MeshSource& source_;
    std::string_view rest_;       // of the line
    std::size_t next_ = 0;        // offset of the next line
    std::size_t line_number_ = 0; // of the line, from 1
    std::size_t next_number_ = 1; // of the next one: lines that continue count as several
};

/// Reads a whole word as a float, rounded to nearest; an infinite or overflowing one gives infinity.
/// @returns whether it is a number
bool parse_float(std::string_view word, float& value);

} // namespace echinus
