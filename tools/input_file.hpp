#pragma once

#include "console/options.hpp"
#include "input.hpp"

#include <echinus/error.hpp>
#include <echinus/mesh.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

/// A mesh or map argument as a file that the library's readers can open: the file itself, or for "-" a
/// temporary copy of standard input, removed at the end.
class InputFile {
  public:
    /// @param format  the extension for the contents of standard input, such as "obj"; ignored for a file
    /// @throws echinus::Error Unreadable
    InputFile(const std::filesystem::path& argument, const std::string& format);

    /// The name by which the user knows it.
    const std::string& name() const { return name_; }

    /// Calls `read(path)`; in the sentence of an Error the copy is called "standard input".
    template <typename Reader>
    auto read(Reader&& reader) const {
        try {
            return std::forward<Reader>(reader)(path_);
        } catch (const echinus::Error& error) {
            throw echinus::Error(error.code(), renamed(error.what()));
        }
    }

  private:
    std::string renamed(std::string sentence) const;

    std::filesystem::path path_;
    std::string name_;
    std::optional<PartFolder> copy_; ///< the folder that holds it
};

/// Calls `use()`. The sentence of an Error with this code then begins with the file's name, even if the code
/// that found the fault saw only the file's data.
template <typename Use>
auto naming_file(const std::string& name, echinus::ErrorCode code, Use&& use) {
    try {
        return std::forward<Use>(use)();
    } catch (const echinus::Error& error) {
        const bool is_named = std::string(error.what()).starts_with(name);
        if (error.code() != code || is_named) throw;
        throw echinus::Error(error.code(), name + ": " + error.what());
    }
}

/// naming_file() for faults of a mesh.
template <typename Use>
auto naming_mesh(const std::string& name, Use&& use) {
    return naming_file(name, echinus::ErrorCode::InvalidMesh, std::forward<Use>(use));
}

/// Where a mesh comes from, on the command line: a file, or "-" with --format.
struct MeshArgument {
    std::filesystem::path path;
    std::string format;

    /// The name in sentences: the path, or "standard input".
    std::string name() const;

    /// The option --format, which names the format of a mesh on standard input.
    void add_format_option(Command command);
    /// @throws WrongUse for "-" without --format
    void require_format() const;
};

/// @throws echinus::Error as echinus::read_mesh
echinus::TriangleMesh read_mesh(const MeshArgument& argument);

/// Moves a mesh to the frame of the first one, with a warning if it has another: far from 0 each mesh has a
/// frame of its own (TriangleMesh::origin). @param name  of the mesh's file
void move_to_frame(const echinus::Vec3d& origin, echinus::TriangleMesh& mesh, const std::string& name);
