#include "exact_map/layout.hpp"
#include "geometry/box.hpp"
#include "geometry/elementary.hpp"
#include "geometry/parallel.hpp"
#include "geometry/whole_numbers.hpp"
#include "tetrahedra/body_lattice.hpp"
#include "tetrahedra/mend.hpp"

#include <echinus/error.hpp>
#include <echinus/tetrahedra.hpp>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace echinus {

namespace {

/// A set of numbers below a limit, which also counts its members below a given one. It takes one and a half
/// bits for each number below the limit.
class RankedSet {
  public:
    explicit RankedSet(std::size_t limit) : words_(limit / 64 + 1), ranks_(words_.size()) {}

    void insert(std::uint64_t number) { words_[number / 64] |= bit(number); }

    /// Must be called after the last insert().
    /// @returns  the number of members. @pre fewer than 2^32
    std::uint32_t count_ranks() {
        std::uint32_t count = 0;
        for (std::size_t i = 0; i < words_.size(); ++i) {
            ranks_[i] = count;
            count += static_cast<std::uint32_t>(std::popcount(words_[i]));
        }
        return count;
    }

    std::uint32_t rank(std::uint64_t number) const {
        const std::uint64_t below = words_[number / 64] & (bit(number) - 1);
        return ranks_[number / 64] + static_cast<std::uint32_t>(std::popcount(below));
    }

    /// Calls visit(number) for each member, ascending.
    template <typename Visit>
    void for_each(Visit&& visit) const {
        for (std::size_t i = 0; i < words_.size(); ++i)
            for (std::uint64_t rest = words_[i]; rest != 0; rest &= rest - 1)
                visit(64 * i + static_cast<std::uint64_t>(std::countr_zero(rest)));
    }

  private:
    static std::uint64_t bit(std::uint64_t number) { return std::uint64_t{1} << number % 64; }

    std::vector<std::uint64_t> words_;
    std::vector<std::uint32_t> ranks_; ///< the rank of the first number of each word
};

/// Approximate shares of the total time at which the steps are complete.
constexpr double kSidesShare = 0.5, kCutsShare = 0.7, kStencilsShare = 0.8;

using Box = AlignedBox<double>;

Box box_of(const ExactMapView& map) {
    Box box;
    const LatticeFrame frame = frame_of(map);
    for (std::size_t i = 0; i < map.corners.size(); ++i)
        box.add(frame.to_local(Vec3d(map.vertices[map.corners[i]])));
    return box;
}

double volume_of(const Box& box) {
    const Vec3d sides = box.sides();
    return sides.x * sides.y * sides.z;
}

void require_options(const TetrahedralizeOptions& options) {
    if (!(options.size >= 0) || !std::isfinite(options.size))
        throw Error(ErrorCode::InvalidOptions, "the size of tetrahedra must be finite and positive");
    if ((options.size > 0) == (options.count > 0))
        throw Error(ErrorCode::InvalidOptions,
                    "either the size of the tetrahedra or their count must be given, and positive");
    if (options.count > options.most_tetrahedra)
        throw Error(ErrorCode::InvalidOptions, std::to_string(options.count) +
                                                   " tetrahedra are more than the limit of " +
                                                   std::to_string(options.most_tetrahedra));
}

void require_size(const Box& box, double size) {
    if (size < box.largest_coordinate() / 4096)
        throw Error(ErrorCode::InvalidOptions,
                    "tetrahedra of the size " + std::to_string(size) +
                        " are too small for coordinates of up to " +
                        std::to_string(box.largest_coordinate()) +
                        " as floats; choose a larger size or move the model to the origin");
    const double vertex_count = BodyLattice::vertex_count_around(box.low, box.high, size);
    if (vertex_count > static_cast<double>(TetrahedralizeOptions::kMaxLatticeVertices))
        throw Error(ErrorCode::InvalidOptions,
                    "with the size " + std::to_string(size) + " the lattice around the model has " +
                        std::to_string(vertex_count) + " vertices, more than the limit of " +
                        std::to_string(TetrahedralizeOptions::kMaxLatticeVertices) +
                        "; choose a larger size");
}

/// The tetrahedra of all slabs, one after the other.
std::vector<StencilTetrahedron> cut_lattice(const BodyLattice& lattice, const LatticeSides& sides,
                                            const CutPoints& cuts, const TetrahedralizeOptions& options) {
    std::vector<std::vector<StencilTetrahedron>> of_slab(lattice.slab_count());
    std::atomic<std::size_t> count = 0;
    const auto cut_slab = [&](std::size_t slab) {
        const BodyLattice::Vertex begin = slab * lattice.slab_size(), end = begin + lattice.slab_size();
        for (BodyLattice::Vertex vertex = begin; vertex < end; vertex += 2) // the corners of cubes
            for_each_tetrahedron_at(lattice.place_of(vertex),
                                    [&](const std::array<BodyLattice::Place, 4>& corners) {
                                        for (const BodyLattice::Place& place : corners)
                                            if (!lattice.contains(place)) return;
                                        add_stencil(lattice, sides, cuts, corners, of_slab[slab]);
                                    });
        count += of_slab[slab].size();
        if (count > options.most_tetrahedra)
            throw Error(ErrorCode::InvalidOptions, "with the size " + std::to_string(lattice.size()) +
                                                       " there are more tetrahedra than the limit of " +
                                                       std::to_string(options.most_tetrahedra) +
                                                       "; choose a larger size");
    };
    parallel_for(of_slab.size(), options.thread_count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t slab = begin; slab < end; ++slab) cut_slab(slab);
    });
    std::vector<StencilTetrahedron> all;
    all.reserve(count);
    for (std::vector<StencilTetrahedron>& tetrahedra : of_slab) {
        all.insert(all.end(), tetrahedra.begin(), tetrahedra.end());
        tetrahedra = {};
    }
    return all;
}

/// Numbers the vertices: first those of the lattice in its order, then the cut points.
TetrahedralMesh number_vertices(const BodyLattice& lattice, const CutPoints& cuts,
                                const std::vector<StencilTetrahedron>& tetrahedra) {
    RankedSet vertices(lattice.vertex_count()), points(cuts.size());
    const auto set_of = [&](StencilCorner corner) -> RankedSet& {
        return corner.is_cut_point() ? points : vertices;
    };
    for (const StencilTetrahedron& corners : tetrahedra)
        for (const StencilCorner corner : corners) set_of(corner).insert(corner.number());
    const std::uint32_t vertex_count = vertices.count_ranks();
    TetrahedralMesh mesh;
    mesh.vertices.reserve(vertex_count + points.count_ranks());
    vertices.for_each([&](std::uint64_t vertex) {
        mesh.vertices.emplace_back(cuts.position_of(lattice.place_of(vertex)));
    });
    points.for_each([&](std::uint64_t point) { mesh.vertices.emplace_back(cuts.position(point)); });
    mesh.tetrahedra.reserve(tetrahedra.size());
    for (const StencilTetrahedron& corners : tetrahedra) {
        Tetrahedron& numbers = mesh.tetrahedra.emplace_back();
        for (std::size_t i = 0; i < 4; ++i)
            numbers[i] =
                set_of(corners[i]).rank(corners[i].number()) + (corners[i].is_cut_point() ? vertex_count : 0);
    }
    return mesh;
}

/// One attempt; the result has no tetrahedra if no vertex of the lattice is inside.
Tetrahedralization stuff(const ExactMapView& map, const Box& box, double size,
                         const TetrahedralizeOptions& options) {
    const auto report = [&](double share) {
        if (options.progress) options.progress(share);
    };
    require_size(box, size);
    const BodyLattice lattice(box.low, box.high, size);
    LatticeSides sides =
        find_sides(map, lattice, options.thread_count, [&](double share) { report(kSidesShare * share); });
    const auto find = [&](const Vec3d& outside, const Vec3d& inside) {
        return find_entry(map, outside, inside);
    };
    CutPoints cuts(lattice, sides, find, options.thread_count);
    cuts.warp(sides);
    report(kCutsShare);
    Tetrahedralization result{number_vertices(lattice, cuts, cut_lattice(lattice, sides, cuts, options)),
                              size, 0};
    report(kStencilsShare);
    result.removed_tetrahedra = remove_pinches(result.mesh);
    drop_unused_vertices(result.mesh);
    report(1);
    return result;
}

/// Tries sizes until the count is close enough: the count is inversely proportional to the cube of the size,
/// and grows slightly faster while the lattice misses parts of the model.
Tetrahedralization stuff_count(const ExactMapView& map, const Box& box,
                               const TetrahedralizeOptions& options) {
    constexpr int kMostTries = 16;
    constexpr double kTolerance = 0.05, kMostVerticesTried = 1 << 22;
    const auto wanted = static_cast<double>(options.count);
    // A thin model needs sizes at which its box would hold far more elements than the model itself.
    const double most_vertices = std::max(kMostVerticesTried, 256 * wanted);
    const auto miss = [&](const Tetrahedralization& body) {
        if (body.mesh.tetrahedra.empty()) return std::numeric_limits<double>::infinity();
        return std::abs(static_cast<double>(body.mesh.tetrahedra.size()) / wanted - 1);
    };
    // Starts as if the model filled its box, where twelve tetrahedra fill a cube; so the first size is too
    // large rather than too small.
    double size = std::max(portable_cbrt(12 * volume_of(box) / wanted), box.largest_coordinate() / 2048);
    Tetrahedralization best;
    for (int i = 0; i < kMostTries; ++i) {
        if (i > 0 && BodyLattice::vertex_count_around(box.low, box.high, size) > most_vertices) break;
        Tetrahedralization body = stuff(map, box, size, options);
        const auto count = static_cast<double>(body.mesh.tetrahedra.size());
        size *= std::clamp(portable_cbrt(count / wanted), 0.5, 2.0);
        if (i == 0 || miss(body) < miss(best)) best = std::move(body);
        if (miss(best) <= kTolerance) break;
    }
    return best;
}

/// Numbers vertices along an axis, so that neighbours have similar numbers and parts of the body are
/// contiguous in memory.
void number_along(double Vec3d::*axis, TetrahedralMesh& mesh) {
    std::vector<std::pair<double, std::uint32_t>> order;
    for (const Vec3f& vertex : mesh.vertices)
        order.emplace_back(Vec3d(vertex).*axis, kept_as<std::uint32_t>(order.size()));
    std::sort(order.begin(), order.end());
    std::vector<std::uint32_t> number_of(order.size());
    std::vector<Vec3f> vertices;
    vertices.reserve(order.size());
    for (const auto& [along, vertex] : order) {
        number_of[vertex] = kept_as<std::uint32_t>(vertices.size());
        vertices.push_back(mesh.vertices[vertex]);
    }
    mesh.vertices = std::move(vertices);
    for (Tetrahedron& tetrahedron : mesh.tetrahedra)
        for (std::uint32_t& vertex : tetrahedron) vertex = number_of[vertex];
}

} // namespace

Tetrahedralization tetrahedralize(const ExactMapView& model, const TetrahedralizeOptions& options) {
    require_options(options);
    const Box box = box_of(model);
    Tetrahedralization body =
        options.count > 0 ? stuff_count(model, box, options) : stuff(model, box, options.size, options);
    if (!body.mesh.tetrahedra.empty()) {
        number_along(box.longest_axis(), body.mesh);
        body.mesh.origin = model.origin;
        return body;
    }
    if (options.count > 0)
        throw Error(ErrorCode::InvalidMesh,
                    "no size was found at which about " + std::to_string(options.count) +
                        " tetrahedra fit into the model: it is too thin for so few, or encloses nothing; "
                        "choose a larger count, or a size");
    throw Error(
        ErrorCode::InvalidMesh,
        "no tetrahedra of the size " + std::to_string(body.size) +
            " fit into the model: it is thinner than that, or encloses nothing; choose a smaller size");
}

} // namespace echinus
