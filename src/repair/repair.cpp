#include "repair/repairs.hpp"

#include <echinus/error.hpp>
#include <echinus/mesh.hpp>

#include <cmath>
#include <numeric>
#include <string>
#include <utility>

namespace echinus {

namespace {

/// A mesh that loses faces and remembers which ones it had at the start. Faces that are added at the end are
/// numbered after those.
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
    std::vector<std::uint32_t> original_number_; ///< [face_count], or fewer until the next drop()
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
    if (options.drop_duplicate_faces)
        report.duplicate_faces_dropped = result.drop(find_surplus_faces(result.mesh()));
    if (options.drop_doubled_patches)
        report.doubled_patch_faces_dropped = result.drop(find_doubled_patch_faces(result.mesh()));
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
        require_valid(result.mesh()); // vertices may have left the range of float
    }
    return {std::move(result.mesh()), std::move(report)};
}

} // namespace echinus
