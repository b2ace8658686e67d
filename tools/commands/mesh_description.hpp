#pragma once

#include "json.hpp"

#include <echinus/mesh.hpp>

#include <string>

/// The description of a mesh by `info`, as the object of --json.
Json to_json(const echinus::MeshReport& report);

/// The same as a table for people, with the first faces at fault.
std::string to_text(const echinus::MeshReport& report, const std::string& title);

/// "24 edges with more than two faces (first at faces 382, 383)": the faults that keep a mesh from being
/// closed.
std::string describe_openness(const echinus::MeshReport& report);

/// The report of repair(), done or planned, as an object.
Json to_json(const echinus::RepairReport& report);

/// The same as a phrase: "2 duplicate faces dropped, 1 inside-out component turned", or "nothing to mend".
std::string to_text(const echinus::RepairReport& report);

/// What --repair would do to a mesh, and whether the result is closed.
struct RepairOutlook {
    echinus::RepairReport report;
    bool closed_then = false;
};
RepairOutlook foresee_repair(const echinus::TriangleMesh& mesh);
