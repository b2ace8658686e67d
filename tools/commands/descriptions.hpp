#pragma once

#include "console/json.hpp"

#include <echinus/any_map.hpp>
#include <echinus/map_file.hpp>
#include <echinus/mesh.hpp>

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

/// A table for people, with a column of labels and a column of values.
class Table {
  public:
    explicit Table(std::string title) : title_(std::move(title)) {}

    void add(std::string label, std::string value) { rows_.emplace_back(std::move(label), std::move(value)); }

    /// The title, followed by the indented rows with aligned values.
    std::string text() const {
        std::size_t width = 0;
        for (const auto& [label, value] : rows_) width = std::max(width, label.size());
        std::string text = title_ + "\n";
        for (const auto& [label, value] : rows_)
            text += "  " + label + std::string(width - label.size() + 2, ' ') + value + "\n";
        return text;
    }

  private:
    std::string title_;
    std::vector<std::pair<std::string, std::string>> rows_;
};

inline const char* yes_or_no(bool value) {
    return value ? "yes" : "no";
}

/// The description of a mesh by `info`, as the object of --json.
/// @param origin  the origin of the mesh
Json to_json(const echinus::MeshReport& report, const echinus::Vec3d& origin);

/// The same as a table for people, with the first faces at fault.
std::string to_text(const echinus::MeshReport& report, const echinus::Vec3d& origin,
                    const std::string& title);

/// "(1, 2, 3)"
std::string text_of(const echinus::Vec3d& point);

/// Warns of a MeshReport::rounding_step.
std::string rounding_text(double step);

/// Why a mesh that is not closed cannot be used, and what would help: "the mesh is not closed: 24 edges with
/// more than two faces (first at faces 382, 383); fix it with --repair", or "...; fix it elsewhere" if
/// repair() would not close it.
/// @param with       the option that makes a command repair the mesh, such as "--repair"
/// @param otherwise  what else helps if repair() does not, or empty
std::string refusal_of_open_mesh(const echinus::TriangleMesh& mesh, const echinus::MeshReport& report,
                                 const std::string& with, const std::string& otherwise = "");

/// The report of repair(), carried out or planned, as an object.
Json to_json(const echinus::RepairReport& report);

/// The same as a phrase: "2 duplicate faces dropped, 1 inside-out component turned", or "nothing to repair".
std::string to_text(const echinus::RepairReport& report);

/// The repairs that --repair would make, and whether the result is closed.
struct RepairOutlook {
    echinus::RepairReport report;
    bool closed_then = false;
};
RepairOutlook foresee_repair(const echinus::TriangleMesh& mesh);

/// The description of a map by `build` and `info`.
struct MapDescription {
    const echinus::AnyMap& map;
    echinus::MapFileNotes notes;
    std::uint64_t file_bytes = 0;
};

/// The object of --json.
Json to_json(const MapDescription& description);

/// A table for people, including, for a distance map, the histogram of the entries per direction.
std::string to_text(const MapDescription& description, const std::string& title);
