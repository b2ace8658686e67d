#include "files/text.hpp"
#include "mesh/faces.hpp"
#include "mesh/require_valid.hpp"
#include "mesh/seams.hpp"
#include "repair/repairs.hpp"

#include <echinus/error.hpp>
#include <echinus/mesh.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

namespace echinus {

namespace {

/// A mesh that loses faces and remembers their original numbers. Faces that are added at the end get the
/// numbers after those.
class ChangingMesh {
  public:
    explicit ChangingMesh(const TriangleMesh& mesh)
        : mesh_(mesh), next_number_(static_cast<std::uint32_t>(mesh.faces.size())),
          original_number_(mesh.faces.size()) {
        std::iota(original_number_.begin(), original_number_.end(), 0U);
    }

    /// @param dropped  current face numbers, ascending
    /// @returns their numbers in the original mesh
    std::vector<std::uint32_t> drop(const std::vector<std::uint32_t>& dropped) {
        while (original_number_.size() < mesh_.faces.size()) original_number_.push_back(next_number_++);
        std::vector<std::uint32_t> original;
        std::size_t kept = 0;
        for (std::uint32_t face = 0; face < mesh_.faces.size(); ++face)
            if (original.size() < dropped.size() && dropped[original.size()] == face) {
                original.push_back(original_number_[face]);
            } else {
                mesh_.faces[kept] = mesh_.faces[face];
                original_number_[kept++] = original_number_[face];
            }
        mesh_.faces.resize(kept);
        original_number_.resize(kept);
        return original;
    }

    TriangleMesh& mesh() { return mesh_; }

  private:
    TriangleMesh mesh_;
    std::uint32_t next_number_;
    std::vector<std::uint32_t> original_number_; ///< [face_count], or shorter until the next drop()
};

void require_in_range(const RepairOptions& options) {
    if (options.max_hole_edges > RepairOptions::kMaxHoleEdges)
        throw Error(ErrorCode::InvalidOptions, "holes of up to " + std::to_string(options.max_hole_edges) +
                                                   " edges cannot be closed; at most " +
                                                   std::to_string(RepairOptions::kMaxHoleEdges) +
                                                   " are possible: close larger ones in a modelling program");
    if (!(options.sheet_thickness >= 0 && std::isfinite(options.sheet_thickness)))
        throw Error(ErrorCode::InvalidOptions,
                    "the thickness of sheets is negative or not finite; it must be a "
                    "finite length, or 0 to leave sheets as they are");
    if (!(options.weld_distance >= 0 && std::isfinite(options.weld_distance)))
        throw Error(ErrorCode::InvalidOptions,
                    "the distance within which vertices are welded is negative or not finite; it must be a "
                    "finite length, or 0 for what maps do not resolve");
}

/// The largest width of a seam. @pre require_valid(mesh)
double width_of_seams(const TriangleMesh& mesh, double weld_distance) {
    const double radius = smallest_enclosing_sphere(used_positions(mesh)).radius;
    if (weld_distance > radius)
        throw Error(ErrorCode::InvalidOptions,
                    "vertices cannot be welded within " + number_text(weld_distance) +
                        ", more than the radius of the mesh's bounding sphere, " + number_text(radius));
    return std::max(weld_distance, seam_width(radius));
}

/// The faces with two equal corners that had three before.
std::vector<std::uint32_t> find_collapsed_faces(const TriangleMesh& before, const TriangleMesh& after) {
    std::vector<std::uint32_t> collapsed;
    for (std::uint32_t face = 0; face < after.faces.size(); ++face)
        if (has_equal_corners(after.faces[face]) && !has_equal_corners(before.faces[face]))
            collapsed.push_back(face);
    return collapsed;
}

/// The number of vertices that faces used before but no longer use.
std::size_t count_given_up(const TriangleMesh& before, const TriangleMesh& after) {
    const UsedVertices used_before(before.faces, before.vertices.size());
    const UsedVertices used_after(after.faces, after.vertices.size());
    std::size_t count = 0;
    for (std::size_t vertex = 0; vertex < before.vertices.size(); ++vertex)
        count += used_before[vertex] && !used_after[vertex] ? 1 : 0;
    return count;
}

/// Welds seams and drops the faces that lose their area by that, unless all faces would be dropped.
void weld(ChangingMesh& mesh, double width, RepairReport& report) {
    TriangleMesh welded = with_common_corners(mesh.mesh(), width);
    const std::vector<std::uint32_t> collapsed = find_collapsed_faces(mesh.mesh(), welded);
    if (collapsed.size() == welded.faces.size()) return;
    report.vertices_welded = count_given_up(mesh.mesh(), welded);
    mesh.mesh() = std::move(welded);
    report.slivers_dropped = mesh.drop(collapsed);
}

/// Drops faces and adds their numbers to a list. Returns whether there were any.
bool drop(ChangingMesh& mesh, const std::vector<std::uint32_t>& faces, std::vector<std::uint32_t>& list) {
    const std::vector<std::uint32_t> dropped = mesh.drop(faces);
    list.insert(list.end(), dropped.begin(), dropped.end());
    std::sort(list.begin(), list.end());
    return !dropped.empty();
}

/// Performs once each repair that may have to be repeated after others: for example, a face may become
/// orientable only once the seam next to it is filled. Returns whether anything changed. If so, the edges are
/// balanced better, or equally well with fewer faces, so that repetition terminates.
bool mend_once(ChangingMesh& mesh, const RepairOptions& options, double width, RepairReport& report) {
    bool changed = false;
    if (options.drop_duplicate_faces)
        changed |= drop(mesh, find_surplus_faces(mesh.mesh()), report.duplicate_faces_dropped);
    if (options.drop_doubled_patches)
        changed |= drop(mesh, find_doubled_patch_faces(mesh.mesh()), report.doubled_patch_faces_dropped);
    if (options.drop_loose_slivers)
        changed |= drop(mesh, find_loose_slivers(mesh.mesh()), report.slivers_dropped);
    if (options.orient_faces) {
        const std::size_t count = orient_faces(mesh.mesh());
        report.faces_turned += count;
        changed |= count != 0;
    }
    if (options.close_seams) {
        const std::size_t count_before = mesh.mesh().faces.size();
        report.seams_filled += fill_seams(mesh.mesh(), width);
        report.faces_added += mesh.mesh().faces.size() - count_before;
        changed |= mesh.mesh().faces.size() != count_before;
    }
    return changed;
}

} // namespace

RepairedMesh repair(const TriangleMesh& mesh, const RepairOptions& options) {
    require_in_range(options);
    require_valid(mesh);
    ChangingMesh result(mesh);
    RepairReport report;
    const auto count_added = [&](std::size_t count_before) {
        report.faces_added += result.mesh().faces.size() - count_before;
    };
    const double width = options.close_seams ? width_of_seams(mesh, options.weld_distance) : 0;
    if (options.close_seams) weld(result, width, report);
    while (mend_once(result, options, width, report)) {
    }
    if (options.max_hole_edges != 0) {
        const std::size_t count_before = result.mesh().faces.size();
        const ClosedHoles holes = close_small_holes(result.mesh(), options.max_hole_edges);
        report.holes_closed = holes.closed;
        report.holes_left = holes.left;
        count_added(count_before);
    }
    if (options.flip_inside_out) report.components_flipped = flip_inside_out_components(result.mesh());
    if (options.drop_inner_faces) report.inner_faces_dropped = result.drop(find_inner_faces(result.mesh()));
    if (options.sheet_thickness > 0) {
        const std::size_t count_before = result.mesh().faces.size();
        report.sheets_thickened = thicken_sheets(result.mesh(), options.sheet_thickness);
        count_added(count_before);
        require_valid(result.mesh()); // vertices may have exceeded the range of float
    }
    return {std::move(result.mesh()), std::move(report)};
}

} // namespace echinus
