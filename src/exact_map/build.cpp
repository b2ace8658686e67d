// From a mesh to an exact map: onto the lattice, into a tree, into the cells.

#include "exact_map/bands.hpp"
#include "exact_map/border.hpp"
#include "exact_map/centre_search.hpp"
#include "exact_map/face_tree.hpp"
#include "exact_map/index_storage.hpp"
#include "exact_map/layout.hpp"
#include "exact_map/resolution.hpp"
#include "mesh/mesh_hash.hpp"

#include <echinus/error.hpp>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace echinus {

namespace {

void require_sound(const ExactMapOptions& options) {
    if (options.divisions > ExactMapOptions::kMaxDivisions)
        throw Error(ErrorCode::InvalidOptions, "divisions is " + std::to_string(options.divisions) +
                                                   ", more than " +
                                                   std::to_string(ExactMapOptions::kMaxDivisions));
    if (options.divisions != 0 && options.byte_budget != 0)
        throw Error(ErrorCode::InvalidOptions,
                    "divisions and byte_budget are both given; the one leaves no choice to the other");
}

std::uint64_t hash_of(const TriangleMesh& mesh, const ExactMapOptions& options) {
    const std::array<std::uint64_t, 4> fields{options.divisions, options.byte_budget,
                                              static_cast<std::uint64_t>(options.rule),
                                              static_cast<std::uint64_t>(options.centre)};
    return mesh_hash(mesh, XXH64(fields.data(), sizeof fields, 0));
}

struct OwnedArrays {
    Bands bands;
    std::vector<Vec3<std::int32_t>> vertices;
    IndexStorage corners;
    IndexStorage face_numbers;
    std::vector<TreeNode> nodes;
    std::vector<BorderEdge> border;
};

void reorder(LatticeMesh& lattice, const std::vector<std::uint32_t>& order) {
    std::vector<Triangle> faces;
    std::vector<std::uint32_t> numbers;
    faces.reserve(order.size());
    numbers.reserve(order.size());
    for (std::uint32_t face : order) {
        faces.push_back(lattice.faces[face]);
        numbers.push_back(lattice.face_numbers[face]);
    }
    lattice.faces = std::move(faces);
    lattice.face_numbers = std::move(numbers);
}

void set_numbers(IndexStorage& storage, std::size_t bound, const std::vector<std::uint32_t>& values) {
    storage.reset(values.size(), bound);
    storage.with_numbers([&]<typename Number>(Number* numbers) {
        std::transform(values.begin(), values.end(), numbers,
                       [](std::uint32_t value) { return static_cast<Number>(value); });
    });
}

void set_corners(IndexStorage& storage, std::size_t bound, const std::vector<Triangle>& faces) {
    storage.reset(3 * faces.size(), bound);
    storage.with_numbers([&]<typename Number>(Number* numbers) {
        for (const Triangle& face : faces)
            for (std::uint32_t vertex : face) *numbers++ = static_cast<Number>(vertex);
    });
}

/// Faces that shrank to a segment or a point on the lattice take no part in what is inside. But they are
/// still the nearest surface for who is near them: a needle may consist of them.
void add_collapsed_faces(const TriangleMesh& mesh, LatticeMesh& lattice) {
    std::vector<bool> kept(mesh.faces.size());
    for (std::uint32_t number : lattice.face_numbers) kept[number] = true;
    for (std::uint32_t number = 0; number < mesh.faces.size(); ++number) {
        if (kept[number]) continue;
        lattice.faces.push_back(mesh.faces[number]);
        lattice.face_numbers.push_back(number);
    }
}

LatticeMesh snap(const TriangleMesh& mesh, const ExactMapOptions& options, BandFinder& finder) {
    LatticeMesh lattice = options.centre == CentreChoice::Search
                              ? snap_around_best_centre(mesh, options.thread_count, finder)
                              : snap_to_lattice(mesh);
    if (lattice.faces.empty())
        throw Error(ErrorCode::InvalidMesh, "no face is larger than a step of the lattice, " +
                                                std::to_string(lattice.frame.step) +
                                                ": the mesh is a few specks in a large void");
    add_collapsed_faces(mesh, lattice);
    return lattice;
}

/// Everything of the arrays but the bands.
void set_surface(const TriangleMesh& mesh, LatticeMesh& lattice, unsigned thread_count, FaceTree& tree,
                 OwnedArrays& arrays) {
    build_face_tree(lattice, thread_count, tree);
    reorder(lattice, tree.order);
    arrays.nodes = tree.nodes;
    arrays.border = find_border(lattice);
    arrays.vertices.clear();
    for (const LatticePoint& vertex : lattice.vertices) arrays.vertices.emplace_back(vertex);
    set_corners(arrays.corners, lattice.vertices.size(), lattice.faces);
    set_numbers(arrays.face_numbers, mesh.faces.size(), lattice.face_numbers);
}

ExactMapView view_of(const OwnedArrays& arrays, const LatticeMesh& lattice, std::uint32_t divisions,
                     InsideRule rule) {
    ExactMapView view;
    view.centre = lattice.centre;
    view.radius = lattice.radius;
    view.divisions = divisions;
    view.rule = rule;
    view.band_offsets = arrays.bands.offsets;
    view.bands = arrays.bands.bands;
    view.winding_below = arrays.bands.winding_below;
    view.references = arrays.bands.references.view();
    view.reference_parts = arrays.bands.reference_parts;
    view.vertices = arrays.vertices;
    view.corners = arrays.corners.view();
    view.face_numbers = arrays.face_numbers.view();
    view.nodes = arrays.nodes;
    view.border = arrays.border;
    return view;
}

/// Finds the bands for the wished number of cells. Returns the divisions.
std::uint32_t set_bands(const LatticeMesh& lattice, const ExactMapOptions& options, BandFinder& finder,
                        OwnedArrays& arrays) {
    const auto find = [&](std::uint32_t candidate) {
        finder.find(lattice, arrays.border, OctahedralCells(candidate), options.thread_count, arrays.bands);
    };
    std::uint32_t divisions = options.divisions;
    if (options.byte_budget != 0)
        divisions = divisions_within(
            options.byte_budget, lattice.faces.size(), !arrays.border.empty(), [&](std::uint32_t candidate) {
                find(candidate);
                return view_of(arrays, lattice, candidate, options.rule).byte_count();
            });
    else if (divisions == 0)
        divisions = default_divisions(lattice.faces.size(), !arrays.border.empty());
    find(divisions);
    return divisions;
}

ExactMapStatistics statistics_of(const TriangleMesh& mesh, const LatticeMesh& lattice, const Bands& bands) {
    ExactMapStatistics statistics;
    statistics.face_count = static_cast<std::uint32_t>(mesh.faces.size());
    for (std::uint32_t face = 0; face < lattice.faces.size(); ++face)
        statistics.dropped_faces += is_collapsed(lattice.corners(face)) ? 1 : 0;
    for (std::size_t band = 0; band + 1 < bands.bands.size(); ++band)
        statistics.longest_list = std::max(statistics.longest_list, bands.bands[band + 1].first_reference -
                                                                        bands.bands[band].first_reference);
    const auto band_count = static_cast<float>(bands.bands.size() - 1);
    statistics.mean_list = band_count > 0 ? static_cast<float>(bands.references.size()) / band_count : 0;
    statistics.expected_tests = static_cast<float>(expected_tests(bands));
    double uncertain = 0, uncertain_cells = 0, whole = 0;
    for (const CellVolume& volume : bands.volumes) {
        uncertain += volume.uncertain;
        uncertain_cells += volume.uncertain > 0 ? volume.whole : 0;
        whole += volume.whole;
    }
    if (whole > 0) {
        statistics.certain_share = static_cast<float>(std::max(0.0, 1 - uncertain / whole));
        statistics.uncertain_directions = static_cast<float>(uncertain_cells / whole);
    }
    return statistics;
}

} // namespace

struct ExactMapBuilder::Memory {
    TriangleMesh mesh;
    ExactMapOptions options;
    FaceTree tree; ///< its order: of the map before
    BandFinder finder;
    std::shared_ptr<OwnedArrays> arrays;
    std::optional<ExactMap> map;
};

ExactMapBuilder::ExactMapBuilder(std::vector<Triangle> faces, const ExactMapOptions& options)
    : memory_(std::make_unique<Memory>()) {
    require_sound(options);
    memory_->mesh.faces = std::move(faces);
    memory_->options = options;
}
ExactMapBuilder::~ExactMapBuilder() = default;
ExactMapBuilder::ExactMapBuilder(ExactMapBuilder&&) noexcept = default;
ExactMapBuilder& ExactMapBuilder::operator=(ExactMapBuilder&&) noexcept = default;

const ExactMap& ExactMapBuilder::rebuild(std::span<const Vec3f> vertices) {
    auto& [mesh, options, tree, finder, arrays, map] = *memory_;
    map.reset();
    if (arrays.use_count() != 1) arrays = std::make_shared<OwnedArrays>(); // somebody reads the old ones
    mesh.vertices.assign(vertices.begin(), vertices.end());
    LatticeMesh lattice = snap(mesh, options, finder);
    set_surface(mesh, lattice, options.thread_count, tree, *arrays);
    const std::uint32_t divisions = set_bands(lattice, options, finder, *arrays);
    const ExactMapStatistics statistics = statistics_of(mesh, lattice, arrays->bands);
    return map.emplace(view_of(*arrays, lattice, divisions, options.rule), statistics, hash_of(mesh, options),
                       arrays);
}

ExactMap::ExactMap(const ExactMapView& view, const ExactMapStatistics& statistics, std::uint64_t source_hash,
                   std::shared_ptr<const void> storage)
    : view_(view), statistics_(statistics), source_hash_(source_hash), storage_(std::move(storage)) {}

ExactMap ExactMap::build(const TriangleMesh& mesh, const ExactMapOptions& options) {
    return ExactMapBuilder(mesh.faces, options).rebuild(mesh.vertices);
}

} // namespace echinus
