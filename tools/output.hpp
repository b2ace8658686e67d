#pragma once

#include "files/atomic_file.hpp"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <optional>
#include <string_view>

/// The path argument that stands for standard input or standard output.
inline constexpr std::string_view kStandardStream = "-";

/// Where a command's result goes: a file that appears whole or not at all, or standard output for "-".
/// Members throw echinus::Error Unwritable.
class Output {
  public:
    explicit Output(const std::filesystem::path& target);

    void write(const void* data, std::size_t byte_count);
    void write(std::string_view text) { write(text.data(), text.size()); }
    void commit();

  private:
    std::optional<echinus::AtomicFile> file_; // empty: standard output
};

/// Prints on standard output.
/// @throws echinus::Error Unwritable, so that a full disk behind a redirection is noticed
void print(std::string_view text);

/// Prints the object of `--json`, indented, with a newline.
void print_json(const nlohmann::ordered_json& object);

/// Hands what was printed to the system; the last chance to notice that it went nowhere.
void flush_standard_output();
