#pragma once

#include "output.hpp"

#include <echinus/error.hpp>

#include <filesystem>
#include <fstream>
#include <istream>
#include <string>

/// The name of an input in sentences: its path, or "standard input" for "-".
std::string name_of_input(const std::filesystem::path& path);

/// A file, or standard input for "-", open for reading.
class Input {
  public:
    /// @throws echinus::Error Unreadable
    explicit Input(const std::filesystem::path& path);

    /// Reads up to `byte_count` bytes; fewer only at the end.
    /// @throws echinus::Error Unreadable
    std::size_t read(void* bytes, std::size_t byte_count);
    /// The maximum number of characters in a line, since a device such as /dev/zero is a single endless line.
    static constexpr std::size_t kMaxLineLength = std::size_t{1} << 20;

    /// The next line without its line break (LF or CR LF); false at the end.
    /// @throws echinus::Error Unreadable; Damaged if the line is longer than kMaxLineLength
    bool read_line(std::string& line);
    /// Is this the next byte?
    bool next_is(char byte);
    bool at_end();

    /// Throws an Error whose sentence is "NAME: FINDING".
    [[noreturn]] void fail(echinus::ErrorCode code, const std::string& finding) const;

  private:
    void require_good() const;

    std::string name_;
    std::ifstream file_;
    std::istream& stream_;
};
