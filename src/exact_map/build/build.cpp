#include "directions/lattice.hpp"
#include "exact_map/build/bands.hpp"
#include "exact_map/build/face_tree.hpp"
#include "exact_map/build/open_surface.hpp"
#include "exact_map/build/resolution.hpp"
#include "exact_map/layout.hpp"
#include "files/text.hpp"
#include "geometry/parallel.hpp"
#include "geometry/whole_numbers.hpp"
#include "mesh/mesh_hash.hpp"

#include <echinus/error.hpp>
#include <echinus/mesh.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace echinus {

// Builds an exact map from a mesh: snaps it to the lattice, builds the tree, and finds the bands of the
// cells.

namespace {

/// The length of the average reference's list, that is, the number of faces that a query near the surface
/// tests; measured in maps of few cells.
class ListLengths {
  public:
    ListLengths(unsigned thread_count, BandFinder& finder) : thread_count_(thread_count), finder_(finder) {}

    /// The first centre determines the number of cells; any other for which they take too many bytes counts
    /// as unusable.
    double of(const LatticeMesh& lattice) {
        bool found = find(lattice);
        for (; !found && is_first_; found = find(lattice)) divisions_ /= 2;
        is_first_ = false;
        return found ? expected_tests(bands_) : std::numeric_limits<double>::infinity();
    }

  private:
    bool find(const LatticeMesh& lattice) {
        const std::size_t limit = default_byte_limit(lattice.faces.size(), lattice.vertices.size());
        // The border does not affect the length of lists.
        return finder_.find(lattice, {}, {OctahedralCells(divisions_)}, thread_count_, limit, bands_);
    }

    unsigned thread_count_;
    BandFinder& finder_;
    Bands bands_;
    std::uint32_t divisions_ = 12; ///< more would take long and rank the centres alike
    bool is_first_ = true;
};

/// Snaps the mesh to the lattice of a centre from which queries should test few faces, estimated by maps of
/// few cells. Takes about twenty coarse builds.
/// @throws Error as LatticeSnapper::snap()
void snap_around_best_centre(LatticeSnapper& snapper, std::span<const Vec3f> vertices, unsigned thread_count,
                             BandFinder& finder, LatticeMesh& best) {
    ListLengths lengths(thread_count, finder);
    snap_at_lowest_cost(
        snapper, vertices, [&](const LatticeMesh& lattice) { return lengths.of(lattice); }, best);
}

constexpr std::size_t kNoLimit = std::numeric_limits<std::size_t>::max();

void require_sound(const ExactMapOptions& options) {
    if (options.divisions > ExactMapOptions::kMaxDivisions)
        throw Error(ErrorCode::InvalidOptions, "divisions is " + std::to_string(options.divisions) +
                                                   ", more than " +
                                                   std::to_string(ExactMapOptions::kMaxDivisions));
    if (options.divisions != 0 && options.byte_budget != 0)
        throw Error(ErrorCode::InvalidOptions,
                    "divisions and byte_budget are both given; leave one of them out");
}

/// The size in customary units with three digits: "48.5 MB". Rounded up, so that a map of this many bytes
/// stays within the stated size.
std::string size_text(std::size_t byte_count) {
    constexpr std::array kUnits{"B", "KB", "MB", "GB"};
    std::size_t unit = 0;
    auto size = static_cast<double>(byte_count);
    for (; size >= 1000 && unit + 1 < kUnits.size(); ++unit) size /= 1000;
    const int decimals = unit == 0 || size >= 100 ? 0 : size >= 10 ? 1 : 2;
    constexpr std::array kSteps{1.0, 0.1, 0.01}; // of the last digit, by the number of decimals
    const double step = kSteps[static_cast<std::size_t>(decimals)];
    char text[32];
    std::snprintf(text, sizeof text, "%.*f %s", decimals, std::ceil(size / step) * step, kUnits[unit]);
    return text;
}

std::uint64_t hash_of(std::span<const Vec3f> vertices, std::span<const Triangle> faces, const Vec3d& origin,
                      const ExactMapOptions& options, bool is_closed) {
    constexpr std::uint64_t kWithoutCertainGaps = std::uint64_t{1} << 32;
    const bool finds_gaps = options.find_certain_gaps || is_closed; // a closed surface has no others
    const std::array<std::uint64_t, 4> fields{options.divisions | (finds_gaps ? 0 : kWithoutCertainGaps),
                                              options.byte_budget, static_cast<std::uint64_t>(options.rule),
                                              static_cast<std::uint64_t>(options.centre)};
    return mesh_hash(vertices, faces, origin, XXH64(fields.data(), sizeof fields, 0));
}

struct OwnedArrays {
    Bands bands;
    std::vector<std::uint16_t> outer_limits;
    std::vector<Vec3<std::int32_t>> vertices;
    IndexStorage corners;
    IndexStorage face_numbers;
    std::vector<TreeNode> nodes;
    std::vector<BorderEdge> border;
    OwnedWindingTree winding_tree;
};

/// A view of all arrays except the bands.
ExactMapView surface_of(const OwnedArrays& arrays) {
    ExactMapView view;
    view.vertices = std::span(arrays.vertices).subspan(1);
    view.corners = arrays.corners.view();
    view.face_numbers = arrays.face_numbers.view();
    view.nodes = arrays.nodes;
    view.border = arrays.border;
    if (!arrays.winding_tree.moments.empty()) view.winding_tree = &arrays.winding_tree.tree;
    return view;
}

ExactMapView view_of(const OwnedArrays& arrays, const LatticeMesh& lattice, std::uint32_t divisions,
                     InsideRule rule) {
    ExactMapView view = surface_of(arrays);
    view.centre = lattice.centre;
    view.radius = lattice.radius;
    view.divisions = divisions;
    view.rule = rule;
    view.band_offsets = arrays.bands.offsets;
    view.outer_limits = arrays.outer_limits;
    view.bands = arrays.bands.bands;
    view.winding_below = arrays.bands.winding_below;
    view.references = arrays.bands.references.view();
    view.reference_parts = arrays.bands.reference_parts;
    return view;
}

ExactMapStatistics statistics_of(std::size_t face_count, std::size_t dropped_faces, const Bands& bands) {
    ExactMapStatistics statistics;
    statistics.face_count = kept_as<std::uint32_t>(face_count);
    statistics.dropped_faces = kept_as<std::uint32_t>(dropped_faces);
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

[[noreturn]] void fail_of_intervals() {
    throw Error(ErrorCode::InvalidMesh,
                "the faces pass through cells more than " + std::to_string(BandFinder::kMostIntervals) +
                    " times, which is more than a map can hold; use fewer cells, or drop faces that lie "
                    "on each other");
}

/// The steps from vertices to a map. It keeps what speeds up the next pose of a mesh: the data that depend on
/// the faces alone, the order of the tree, which changes little, and memory.
class MapMaker {
  public:
    /// @param faces  must not move in memory
    /// @param origin  the origin of the frame of all vertices
    MapMaker(std::span<const Triangle> faces, const ExactMapOptions& options, const Vec3d& origin = {})
        : faces_(faces), origin_(origin), options_(options), snapper_(faces) {}

    ExactMap make(std::span<const Vec3f> vertices);

  private:
    void snap(std::span<const Vec3f> vertices);
    void add_collapsed_faces();
    void order_faces();
    void set_surface(std::span<const Vec3f> vertices);
    bool find_bands(std::uint32_t divisions, std::size_t byte_limit);
    std::uint32_t set_bands();
    std::uint32_t set_bands_within(const ByteRange& bytes, std::uint32_t most);

    std::span<const Triangle> faces_;
    Vec3d origin_;
    ExactMapOptions options_;
    LatticeSnapper snapper_;
    LatticeMesh lattice_; ///< faces in the order of the tree, once it is known
    std::size_t dropped_faces_ = 0;
    std::vector<Triangle> faces_before_; ///< scratch: the lattice's faces before order_faces() puts them into
                                         ///< the order of the tree
    std::vector<std::uint32_t> numbers_before_;
    FaceTree tree_;
    BandFinder finder_;
    std::uint64_t source_hash_ = 0;
    std::shared_ptr<OwnedArrays> arrays_;
};

void MapMaker::snap(std::span<const Vec3f> vertices) {
    if (options_.centre == CentreChoice::Search)
        snap_around_best_centre(snapper_, vertices, options_.thread_count, finder_, lattice_);
    else
        snapper_.snap(vertices, lattice_);
    if (lattice_.faces.empty())
        throw Error(ErrorCode::InvalidMesh, "no face is larger than a step of the lattice, " +
                                                number_text(lattice_.frame.step) +
                                                ": the mesh consists of tiny parts that are far apart");
    dropped_faces_ = faces_.size() - lattice_.faces.size();
    if (dropped_faces_ != 0) add_collapsed_faces();
}

/// Faces that shrank to a segment or a point on the lattice do not affect what is inside. But they may still
/// be the nearest surface to a particle: a needle may consist of them.
void MapMaker::add_collapsed_faces() {
    std::vector<bool> kept(faces_.size());
    for (std::uint32_t number : lattice_.face_numbers) kept[number] = true;
    for (std::uint32_t number = 0; number < faces_.size(); ++number) {
        if (kept[number]) continue;
        lattice_.faces.push_back(faces_[number]);
        lattice_.face_numbers.push_back(number);
    }
}

/// Puts the faces of the lattice into the order of the tree, and stores them.
void MapMaker::order_faces() {
    std::swap(lattice_.faces, faces_before_);
    std::swap(lattice_.face_numbers, numbers_before_);
    lattice_.faces.resize(faces_.size());
    lattice_.face_numbers.resize(faces_.size());
    arrays_->corners.reset(3 * faces_.size(), lattice_.vertices.size());
    arrays_->face_numbers.reset(faces_.size(), faces_.size());
    parallel_for(faces_.size(), options_.thread_count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            lattice_.faces[i] = faces_before_[tree_.order[i]];
            lattice_.face_numbers[i] = numbers_before_[tree_.order[i]];
        }
        arrays_->corners.with_numbers([&]<typename Number>(Number* corners) {
            for (std::size_t i = begin; i < end; ++i)
                for (std::size_t k = 0; k < 3; ++k)
                    corners[3 * i + k] = static_cast<Number>(lattice_.faces[i][k]);
        });
        arrays_->face_numbers.with_numbers([&]<typename Number>(Number* numbers) {
            for (std::size_t i = begin; i < end; ++i)
                numbers[i] = static_cast<Number>(lattice_.face_numbers[i]);
        });
    });
}

/// Sets all arrays except the bands.
void MapMaker::set_surface(std::span<const Vec3f> vertices) {
    parallel_invoke(
        options_.thread_count,
        [&] { source_hash_ = hash_of(vertices, faces_, origin_, options_, snapper_.faces_are_closed()); },
        [&] { build_face_tree(lattice_, options_.thread_count, tree_); });
    order_faces();
    arrays_->nodes = tree_.nodes;
    arrays_->border.clear();
    if (!snapper_.faces_are_closed()) arrays_->border = find_border(lattice_);
    arrays_->vertices.clear();
    arrays_->vertices.reserve(1 + lattice_.vertices.size());
    arrays_->vertices.emplace_back(); // so that vector loads can read one number before the first
    for (const LatticePoint& vertex : lattice_.vertices) arrays_->vertices.emplace_back(vertex);
    arrays_->winding_tree = {};
    if (!arrays_->border.empty()) arrays_->winding_tree = make_winding_tree(surface_of(*arrays_));
}

/// @returns  false if the bands alone exceed the limit; the bands in the arrays are then unchanged
bool MapMaker::find_bands(std::uint32_t divisions, std::size_t byte_limit) {
    BandDetail detail{OctahedralCells(divisions)};
    // The map of one division, the last resort, must be small, as default_byte_limit() states.
    if (divisions == 1 && options_.divisions == 0) detail.gap_halvings = 1;
    if (!options_.find_certain_gaps) detail.gap_halvings = GapStates::kNone;
    return finder_.find(lattice_, surface_of(*arrays_), detail, options_.thread_count, byte_limit,
                        arrays_->bands);
}

/// Finds the bands for the requested number of cells. Returns the divisions.
std::uint32_t MapMaker::set_bands() {
    const bool open = !arrays_->border.empty();
    if (options_.byte_budget != 0)
        return set_bands_within({options_.byte_budget, options_.byte_budget},
                                most_useful_divisions(faces_.size(), open));
    if (options_.divisions != 0) {
        if (find_bands(options_.divisions, kNoLimit)) return options_.divisions;
        fail_of_intervals();
    }
    const std::size_t limit = default_byte_limit(faces_.size(), lattice_.vertices.size());
    const std::uint32_t divisions = default_divisions(faces_.size(), open);
    if (find_bands(divisions, limit - surface_of(*arrays_).byte_count())) return divisions;
    return set_bands_within({limit / 4 * 3, limit}, divisions - 1); // the last quarter is not worth the time
}

/// @throws Error InvalidOptions if no map, however coarse, fits
std::uint32_t MapMaker::set_bands_within(const ByteRange& bytes, std::uint32_t most) {
    const std::size_t for_surface = surface_of(*arrays_).byte_count();
    const auto for_bands = [&](std::size_t count) { return count - std::min(count, for_surface); };
    const ByteRange range{for_bands(bytes.enough), for_bands(bytes.limit)};
    const auto divisions =
        finest_within(range, most, [&](std::uint32_t candidate) -> std::optional<std::size_t> {
            if (!find_bands(candidate, range.limit)) return std::nullopt;
            return byte_count(arrays_->bands);
        });
    if (divisions) return *divisions;
    if (!find_bands(1, kNoLimit)) fail_of_intervals();
    const std::size_t needed = for_surface + byte_count(arrays_->bands);
    throw Error(ErrorCode::InvalidOptions, "the coarsest map takes " + size_text(needed) + " (" +
                                               std::to_string(needed) + " bytes), more than the budget");
}

ExactMap MapMaker::make(std::span<const Vec3f> vertices) {
    if (arrays_.use_count() != 1) arrays_ = std::make_shared<OwnedArrays>(); // it is still in use
    snap(vertices);
    set_surface(vertices);
    const std::uint32_t divisions = set_bands();
    set_outer_limits(arrays_->bands.offsets, arrays_->bands.bands, arrays_->outer_limits);
    ExactMapView view = view_of(*arrays_, lattice_, divisions, options_.rule);
    view.origin = origin_;
    return proven(view, statistics_of(faces_.size(), dropped_faces_, arrays_->bands), source_hash_, arrays_);
}

} // namespace

struct ExactMapBuilder::Memory {
    Memory(std::vector<Triangle> faces_, const ExactMapOptions& options)
        : faces(std::move(faces_)), maker(faces, options) {}

    std::vector<Triangle> faces;
    MapMaker maker;
};

ExactMapBuilder::ExactMapBuilder(std::vector<Triangle> faces, const ExactMapOptions& options) {
    require_sound(options);
    memory_ = std::make_unique<Memory>(std::move(faces), options);
}
ExactMapBuilder::~ExactMapBuilder() = default;
ExactMapBuilder::ExactMapBuilder(ExactMapBuilder&&) noexcept = default;
ExactMapBuilder& ExactMapBuilder::operator=(ExactMapBuilder&&) noexcept = default;

ExactMap ExactMapBuilder::rebuild(std::span<const Vec3f> vertices) {
    return memory_->maker.make(vertices);
}

ExactMap::ExactMap(const ExactMapView& view, const ExactMapStatistics& statistics, std::uint64_t source_hash,
                   std::shared_ptr<const void> storage)
    : view_(view), statistics_(statistics), source_hash_(source_hash), storage_(std::move(storage)) {
    if (view_.border.empty() || view_.winding_tree != nullptr) return;
    const auto tree = std::make_shared<const OwnedWindingTree>(make_winding_tree(view_));
    view_.winding_tree = &tree->tree;
    winding_tree_ = tree;
}

ExactMap ExactMap::build(const TriangleMesh& mesh, const ExactMapOptions& options) {
    require_sound(options);
    return MapMaker(mesh.faces, options, mesh.origin).make(mesh.vertices);
}

} // namespace echinus
