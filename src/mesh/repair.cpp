#include "mesh/repairs.hpp"

#include <echinus/mesh.hpp>

#include <numeric>
#include <utility>

namespace echinus {

namespace {

/// A mesh that loses faces and remembers which ones it had at the start.
class ShrinkingMesh {
  public:
    explicit ShrinkingMesh(const TriangleMesh& mesh) : mesh_(mesh), original_number_(mesh.faces.size()) {
        std::iota(original_number_.begin(), original_number_.end(), 0U);
    }

    /// @param dropped  current face numbers, ascending
    /// @returns their numbers in the original mesh
    std::vector<std::uint32_t> drop(const std::vector<std::uint32_t>& dropped) {
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
    std::vector<std::uint32_t> original_number_;
};

} // namespace

RepairedMesh repair(const TriangleMesh& mesh, const RepairOptions& options) {
    require_valid(mesh);
    ShrinkingMesh result(mesh);
    RepairReport report;
    if (options.drop_duplicate_faces)
        report.duplicate_faces_dropped = result.drop(find_surplus_faces(result.mesh()));
    if (options.drop_doubled_patches)
        report.doubled_patch_faces_dropped = result.drop(find_doubled_patch_faces(result.mesh()));
    if (options.flip_inside_out) report.components_flipped = flip_inside_out_components(result.mesh());
    return {std::move(result.mesh()), std::move(report)};
}

} // namespace echinus
