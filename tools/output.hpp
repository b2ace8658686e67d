#pragma once

#include "files/atomic_file.hpp"
#include "interruption.hpp"

#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

/// The path argument that stands for standard input or standard output.
inline constexpr std::string_view kStandardStream = "-";

/// The destination of a command's result: a file, which is written atomically, or standard output for "-".
/// Members throw echinus::Error Unwritable.
class Output {
  public:
    explicit Output(const std::filesystem::path& target);

    void write(const void* data, std::size_t byte_count);
    void write(std::string_view text) { write(text.data(), text.size()); }
    void commit();

  private:
    std::optional<echinus::AtomicFile> file_; // empty for standard output
};

/// A part (files/atomic_file.hpp) that is a folder, which only its owner can read. The destructor removes it,
/// and so does an interruption of the program; a part that a killed program left is removed by the next
/// program that makes one in the same folder.
class PartFolder {
  public:
    /// @throws std::filesystem::filesystem_error if no folder can be made there
    explicit PartFolder(const std::filesystem::path& parent);
    PartFolder(const PartFolder&) = delete;
    PartFolder& operator=(const PartFolder&) = delete;
    ~PartFolder();

    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
    int hold_ = -1;
    std::optional<RemovedWhenInterrupted> removal_;
};

/// A folder of results that appear all together or not at all: files are written to a part on the same disk;
/// commit() moves them to their place, and without it they are removed. Other contents of the target stay as
/// they were.
class OutputFolder {
  public:
    /// @throws echinus::Error Unwritable if the target is a file or no folder can be made there
    explicit OutputFolder(const std::filesystem::path& target);

    /// Where to write the file or folder that will be called `name`.
    std::filesystem::path path_of(const std::string& name) const { return part_->path() / name; }
    /// Moves everything that was written into the target, which is created if necessary. Files and folders
    /// there of the same names are replaced, others stay.
    void commit();
    /// Removes a result of an earlier run from the target, if it exists. To be called after commit().
    void remove_old(const std::string& name) const;

  private:
    std::filesystem::path target_;
    std::optional<PartFolder> part_; // never empty; made in the constructor's body, where errors are caught
};

/// Prints on standard output.
/// @throws echinus::Error Unwritable, so that a full disk behind a redirection is noticed
void print(std::string_view text);

/// Flushes the output to the system, which is the last chance to detect an error.
void flush_standard_output();

/// Refuses a result that would replace its own source.
/// @throws WrongUse, as require_ending() does
void require_another_file(const std::filesystem::path& source, const std::filesystem::path& target);

/// Refuses a result that is neither "-" nor a file whose name has one of these endings, such as ".obj", in
/// upper or lower case.
void require_ending(const std::filesystem::path& target, std::initializer_list<std::string_view> endings);

/// Refuses --json together with a result that is written to standard output.
void require_one_result(const std::filesystem::path& target, bool json);
