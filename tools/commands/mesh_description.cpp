#include "commands/descriptions.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

using echinus::Fault;
using echinus::MeshReport;
using echinus::RepairReport;
using echinus::Vec3d;

namespace {

struct NamedFault {
    const char* key;
    const char* label;
    const Fault& fault;
};

std::vector<NamedFault> faults_of(const MeshReport& report) {
    return {{"border_edges", "border edges", report.border_edges},
            {"nonmanifold_edges", "edges with more than two faces", report.nonmanifold_edges},
            {"misoriented_edges", "wrongly oriented edges", report.misoriented_edges},
            {"duplicate_faces", "duplicate faces", report.duplicate_faces},
            {"degenerate_faces", "degenerate faces", report.degenerate_faces}};
}

/// "at faces 382, 383", or "first at faces 382, 383" if not all edges or faces at fault are listed.
std::string first_faces(const Fault& fault) {
    const bool all_shown = fault.first_faces.size() < Fault::kFirstFaceCount;
    const bool one = fault.first_faces.size() == 1;
    return fmt::format("{}at {} {}", all_shown ? "" : "first ", one ? "face" : "faces",
                       fmt::join(fault.first_faces, ", "));
}

/// The faults that keep a mesh from being closed.
std::string faults_of_edges(const MeshReport& report) {
    std::vector<std::string> phrases;
    for (const auto& [key, label, fault] : faults_of(report)) {
        const bool of_an_edge = std::string(key).ends_with("_edges");
        if (!of_an_edge || fault.count == 0) continue;
        phrases.push_back(fmt::format("{} {} ({})", fault.count, label, first_faces(fault)));
    }
    return fmt::format("{}", fmt::join(phrases, ", "));
}

} // namespace

Json to_json(const MeshReport& report, const Vec3d& origin) {
    Json object;
    object.add("faces", report.face_count);
    object.add("vertices", report.vertex_count);
    object.add("closed", report.closed);
    object.add("manifold", report.manifold);
    object.add("orientable", report.orientable);
    for (const NamedFault& named : faults_of(report)) object.add(named.key, named.fault.count);
    object.add("components", report.component_count);
    object.add("volume", report.signed_volume);
    const Vec3d centre = report.bounding_sphere.centre + origin;
    object.add("radius", report.bounding_sphere.radius);
    object.add("centre", {centre.x, centre.y, centre.z});
    if (origin != Vec3d{}) object.add("origin", {origin.x, origin.y, origin.z});
    if (report.rounding_step > 0) object.add("rounding_step", report.rounding_step);
    Json first_faces;
    for (const NamedFault& named : faults_of(report)) first_faces.add(named.key, named.fault.first_faces);
    object.add("first_faces", first_faces);
    return object;
}

std::string to_text(const MeshReport& report, const Vec3d& origin, const std::string& title) {
    const echinus::Sphere& sphere = report.bounding_sphere;
    Table table(title);
    table.add("faces", std::to_string(report.face_count));
    table.add("vertices", std::to_string(report.vertex_count));
    table.add("components", std::to_string(report.component_count));
    table.add("closed", yes_or_no(report.closed));
    table.add("manifold", yes_or_no(report.manifold));
    if (!report.orientable) table.add("orientable", "no (one-sided, like a Moebius strip)");
    for (const auto& [key, label, fault] : faults_of(report)) {
        const std::string count = std::to_string(fault.count);
        table.add(label, fault.count == 0 ? count : count + ", " + first_faces(fault));
    }
    table.add("signed volume", fmt::format("{:.6g}", report.signed_volume));
    table.add("bounding sphere",
              origin == Vec3d{}
                  ? fmt::format("centre ({:.6g}, {:.6g}, {:.6g}), radius {:.6g}", sphere.centre.x,
                                sphere.centre.y, sphere.centre.z, sphere.radius)
                  : fmt::format("centre {}, radius {:.6g}", text_of(sphere.centre + origin), sphere.radius));
    if (origin != Vec3d{}) table.add("origin", text_of(origin));
    if (report.rounding_step > 0) table.add("rounding", rounding_text(report.rounding_step));
    return table.text();
}

std::string text_of(const Vec3d& point) {
    return fmt::format("({:.15g}, {:.15g}, {:.15g})", point.x, point.y, point.z);
}

std::string rounding_text(double step) {
    return fmt::format(
        "coordinates are floats, whose spacing is {:.6g} here; finer detail of the file is lost", step);
}

std::string refusal_of_open_mesh(const echinus::TriangleMesh& mesh, const MeshReport& report,
                                 const std::string& with, const std::string& otherwise) {
    return "the mesh is not closed: " + faults_of_edges(report) +
           (report.orientable ? "" : ", and it has one-sided parts, like a Moebius strip") + "; " +
           (foresee_repair(mesh).closed_then ? "fix it with " + with : "fix it elsewhere" + otherwise);
}

Json to_json(const RepairReport& report) {
    return {{"duplicate_faces_dropped", report.duplicate_faces_dropped.size()},
            {"doubled_patch_faces_dropped", report.doubled_patch_faces_dropped.size()},
            {"components_flipped", report.components_flipped},
            {"holes_closed", report.holes_closed},
            {"holes_left", report.holes_left},
            {"inner_faces_dropped", report.inner_faces_dropped.size()},
            {"sheets_thickened", report.sheets_thickened},
            {"faces_added", report.faces_added},
            {"vertices_welded", report.vertices_welded},
            {"slivers_dropped", report.slivers_dropped.size()},
            {"faces_turned", report.faces_turned},
            {"seams_filled", report.seams_filled}};
}

std::string to_text(const RepairReport& report) {
    std::vector<std::string> phrases;
    const auto add = [&](std::size_t count, const char* noun, const char* deed) {
        if (count != 0)
            phrases.push_back(fmt::format("{} {}{} {}", count, noun, count == 1 ? "" : "s", deed));
    };
    add(report.vertices_welded, "corner", "welded");
    add(report.duplicate_faces_dropped.size(), "duplicate face", "dropped");
    add(report.doubled_patch_faces_dropped.size(), "face", "of doubled patches dropped");
    add(report.slivers_dropped.size(), "sliver", "dropped");
    add(report.faces_turned, "face", "turned");
    add(report.seams_filled, "seam", "filled");
    add(report.holes_closed, "hole", "closed");
    add(report.holes_left, "hole", "left");
    add(report.components_flipped, "inside-out component", "turned");
    add(report.inner_faces_dropped.size(), "inner face", "dropped");
    add(report.sheets_thickened, "sheet", "thickened");
    return phrases.empty() ? "nothing to repair" : fmt::format("{}", fmt::join(phrases, ", "));
}

RepairOutlook foresee_repair(const echinus::TriangleMesh& mesh) {
    const echinus::RepairedMesh repaired = repair(mesh, echinus::RepairOptions::all());
    return {repaired.report, inspect(repaired.mesh).closed};
}
