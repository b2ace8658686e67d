#pragma once

#include "mesh_io/mesh_source.hpp"

#include <echinus/geometry.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace echinus {

/// Walks over a text line by line and word by word. Lines end with \n, \r\n or \r; a # begins a comment, but
/// not inside a form of NaN or infinity such as 1.#QNAN. Empty lines and a byte order mark of UTF-8 are
/// skipped. The text may end before the file does, since zeros or the Ctrl-Z of DOS may fill up its last
/// block.
///
/// Every sentence of an error names the line. Not copied, since words may be views of its own memory.
class LineScanner {
  public:
    /// Does a backslash before the end of a line join it with the next one? One in a comment never does.
    enum class Continuation { None, Backslash };

    /// @throws Error WrongFormat if the text is UTF-16 or UTF-32
    explicit LineScanner(const MeshSource& source, Continuation continuation = Continuation::None)
        : source_(source), continuation_(continuation), next_(source.bytes.size() - text_of(source).size()) {}
    /// Begins at an offset, which is the start of the line with this number.
    LineScanner(const MeshSource& source, std::size_t offset, std::size_t line_number)
        : source_(source), next_(offset), next_number_(line_number) {}
    LineScanner(const LineScanner&) = delete;
    LineScanner& operator=(const LineScanner&) = delete;

    /// Goes to the next line that has a word. False at the end of the text.
    /// @throws Error WrongFormat if the line has control characters and so is not text
    bool next_line();

    /// As above, if the format requires another line.
    /// @throws Error Damaged if there is none; the sentence says that `what` was expected
    void require_line(const std::string& what);

    /// The number of lines with words that follow this one.
    /// @throws Error as in next_line()
    std::size_t count_lines_left() const;

    /// From now on, a number may be on a later line than the one before it.
    /// @param reason  ends the sentence of every error that names a line; may be empty
    void read_across_lines(std::string reason = {});
    /// From now on, a number has to be on the current line again.
    void read_within_lines();

    /// The next word of the line, which is valid until the next call of next_line(); empty at the end of the
    /// line.
    std::string_view next_word();

    /// Makes the end of the last word the next word again.
    void give_back(std::string_view end);

    bool at_end_of_line();
    void skip_rest_of_line() { rest_ = {}; }

    /// Does the line consist of several lines of the file?
    bool is_joined() const { return !joined_.empty(); }

    /// The next word as a number, which rounds to the float nearest to the text.
    /// @throws Error Damaged if there is none; InvalidMesh if it is not finite as a float
    double next_coordinate();
    /// The next three words as coordinates.
    Vec3d next_position();

    /// Skips a number, which may be infinite or NaN.
    /// @throws Error Damaged if the next word is not a number
    void skip_number();

    /// @throws Error Damaged if the next word is not an integer of 64 bits
    std::int64_t next_integer(const std::string& what);

    /// @throws Error Damaged if the next word is not an integer in [0, 2^32 - 2]
    std::size_t next_count(const std::string& what);

    /// The next word as an index below `vertex_count`.
    /// @throws Error Damaged if there is none; InvalidMesh if it is out of range
    std::uint32_t next_vertex_index(std::size_t vertex_count);

    /// The offset at which the next line begins.
    std::size_t offset() const { return next_; }
    std::size_t line_number() const { return line_number_; }

    /// Says that `what` was expected instead of this word, or instead of the end of the line if the word is
    /// empty.
    [[noreturn]] void fail_expecting(const std::string& what, std::string_view word,
                                     ErrorCode code = ErrorCode::Damaged) const;
    [[noreturn]] void fail(ErrorCode code, const std::string& what) const;
    [[noreturn]] void fail_at(std::size_t line_number, ErrorCode code, const std::string& what) const;

  private:
    std::string_view take_line();
    bool take_continued_line();
    void take_joined_lines();
    std::string_view next_number(const std::string& what);

    const MeshSource& source_;
    Continuation continuation_ = Continuation::None;
    bool reads_across_lines_ = false;
    std::string reason_;
    std::string_view rest_; // the rest of the line
    // The lines that a continued line consists of, with blanks between them; otherwise empty.
    std::string joined_;
    std::size_t next_ = 0;        // offset of the next line
    std::size_t line_number_ = 0; // of the present line, counted from 1
    std::size_t next_number_ = 1; // of the next line; a continued line counts as several
};

/// Reads a whole word as a number: the double nearest to it, or a neighbour of that double, if only the
/// neighbour rounds to the float nearest to the word. Infinite and overflowing numbers give infinity.
/// @returns whether it is a number, possibly NaN
bool parse_number(std::string_view word, double& value);

/// Reads a whole word as an integer.
/// @returns whether it is one
bool parse_integer(std::string_view word, std::int64_t& value);

} // namespace echinus
