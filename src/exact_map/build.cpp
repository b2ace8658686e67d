#include "exact_map/bands.hpp"
#include "exact_map/border.hpp"
#include "exact_map/face_tree.hpp"
#include "exact_map/layout.hpp"

#include <echinus/error.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace echinus {

namespace {

/// Cells enough that a band near the surface holds a handful of faces, and not so many that they outweigh the
/// mesh: a bit more cells than faces.
std::uint32_t default_divisions(std::size_t face_count) {
    const double divisions = std::sqrt(1.2 * static_cast<double>(face_count) / 8);
    return std::clamp(static_cast<std::uint32_t>(std::lround(divisions)), 4U, ExactMapOptions::kMaxDivisions);
}

/// An IndexArray's storage.
class Indices {
  public:
    Indices(const std::vector<std::uint32_t>& values, std::size_t bound) {
        if (bound <= 65536)
            narrow_.assign(values.begin(), values.end());
        else
            wide_ = values;
    }
    IndexArray view() const { return {narrow_, wide_}; }

  private:
    std::vector<std::uint16_t> narrow_;
    std::vector<std::uint32_t> wide_;
};

struct OwnedArrays {
    Bands bands;
    Indices references;
    std::vector<Vec3<std::int32_t>> vertices;
    Indices corners;
    Indices face_numbers;
    std::vector<TreeNode> nodes;
    std::vector<BorderEdge> border;
};

void reorder(LatticeMesh& lattice, const std::vector<std::uint32_t>& order) {
    std::vector<Triangle> faces;
    std::vector<std::uint32_t> numbers;
    for (std::uint32_t face : order) {
        faces.push_back(lattice.faces[face]);
        numbers.push_back(lattice.face_numbers[face]);
    }
    lattice.faces = std::move(faces);
    lattice.face_numbers = std::move(numbers);
}

std::vector<std::uint32_t> flattened(const std::vector<Triangle>& faces) {
    std::vector<std::uint32_t> corners;
    corners.reserve(3 * faces.size());
    for (const Triangle& face : faces) corners.insert(corners.end(), face.begin(), face.end());
    return corners;
}

} // namespace

ExactMap::ExactMap(const ExactMapView& view, const ExactMapStatistics& statistics, std::uint64_t source_hash,
                   std::shared_ptr<const void> storage)
    : view_(view), statistics_(statistics), source_hash_(source_hash), storage_(std::move(storage)) {}

ExactMap ExactMap::build(const TriangleMesh& mesh, const ExactMapOptions& options) {
    if (options.divisions > ExactMapOptions::kMaxDivisions)
        throw Error(ErrorCode::InvalidOptions, "divisions is " + std::to_string(options.divisions) +
                                                   ", more than " +
                                                   std::to_string(ExactMapOptions::kMaxDivisions));
    LatticeMesh lattice = snap_to_lattice(mesh);
    FaceTree tree = build_face_tree(lattice);
    reorder(lattice, tree.order);
    const std::vector<BorderEdge> border = find_border(lattice);
    const std::uint32_t divisions =
        options.divisions != 0 ? options.divisions : default_divisions(lattice.faces.size());
    const OctahedralCells cells(divisions);
    Bands bands = find_bands(lattice, border, cells, options.thread_count);

    Indices references(bands.references, lattice.faces.size());
    std::vector<Vec3<std::int32_t>> vertices;
    for (const LatticePoint& v : lattice.vertices) vertices.emplace_back(v);
    const auto arrays = std::make_shared<OwnedArrays>(
        OwnedArrays{std::move(bands), std::move(references), std::move(vertices),
                    Indices(flattened(lattice.faces), lattice.vertices.size()),
                    Indices(lattice.face_numbers, mesh.faces.size()), std::move(tree.nodes), border});

    ExactMapView view;
    view.centre = lattice.centre;
    view.radius = lattice.radius;
    view.divisions = divisions;
    view.rule = options.rule;
    view.band_offsets = arrays->bands.offsets;
    view.bands = arrays->bands.bands;
    view.winding_below = arrays->bands.winding_below;
    view.references = arrays->references.view();
    view.reference_parts = arrays->bands.reference_parts;
    view.vertices = arrays->vertices;
    view.corners = arrays->corners.view();
    view.face_numbers = arrays->face_numbers.view();
    view.nodes = arrays->nodes;
    view.border = arrays->border;
    return {view, {}, 0, arrays};
}

} // namespace echinus
