#pragma once

#include <filesystem>
#include <string>

/// A folder of results that appear all together or not at all: files are written to a temporary folder on the
/// same disk, commit() moves them to their place. Without commit() the destructor removes them, and what the
/// target held before stays as it was.
class OutputFolder {
  public:
    /// @throws echinus::Error Unwritable when the target is a file or no folder can be made there
    explicit OutputFolder(const std::filesystem::path& target);
    OutputFolder(const OutputFolder&) = delete;
    OutputFolder& operator=(const OutputFolder&) = delete;
    ~OutputFolder();

    /// Where to write the file or folder that will be called `name`.
    std::filesystem::path path_of(const std::string& name) const { return temporary_ / name; }
    /// Moves everything that was written into the target, which is made if need be. Files and folders there
    /// of the same names are replaced, others stay.
    void commit();
    /// Removes a result of an earlier run from the target, if it is there. To be called after commit().
    void remove_old(const std::string& name) const;

  private:
    std::filesystem::path target_;
    std::filesystem::path temporary_;
};
