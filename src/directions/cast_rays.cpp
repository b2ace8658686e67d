#include "directions/cast_rays.hpp"

#include "directions/face_cone.hpp"
#include "directions/samples_near.hpp"
#include "geometry/parallel.hpp"

#include <echinus/error.hpp>

#include <algorithm>
#include <limits>
#include <mutex>

namespace echinus {

namespace {

struct Crossing {
    std::uint32_t direction;
    float distance;
};

/// Intersects the rays of a grid with faces.
template <typename Grid>
class RayCaster {
  public:
    RayCaster(const LatticeMesh& lattice, const Grid& grid)
        : lattice_(lattice), grid_(grid), directions_(grid.lattice_directions()),
          largest_(grid.largest_entry(lattice.radius)) {
        norms_.reserve(directions_.size());
        for (const LatticePoint& d : directions_)
            norms_.push_back(grid.radial_norm(Vec3d(d)) * lattice.frame.step);
    }

    /// Appends the crossings of all rays with one face.
    void cast_at(const Triangle& face, std::vector<Crossing>& crossings) const {
        const std::array<LatticePoint, 3> corners{lattice_.vertices[face[0]], lattice_.vertices[face[1]],
                                                  lattice_.vertices[face[2]]};
        const FaceCone cone(corners[0], corners[1], corners[2]);
        if (cone.edge_on()) return;
        for_each_sample_near(grid_, corners, 0,
                             [&](std::uint32_t direction) { cast_along(direction, cone, crossings); });
    }

  private:
    void cast_along(std::uint32_t direction, const FaceCone& cone, std::vector<Crossing>& crossings) const {
        const LatticePoint& d = directions_[direction];
        if (!cone.meets(d)) return;
        const double distance = cone.parameter(d) * norms_[direction];
        // Snapping may move a vertex out of the sphere by a lattice step.
        crossings.push_back({direction, std::clamp(static_cast<float>(distance), 0.0F, largest_)});
    }

    const LatticeMesh& lattice_;
    const Grid& grid_;
    std::vector<LatticePoint> directions_;
    std::vector<double>
        norms_; ///< the radial coordinate of each direction's lattice point, in the mesh's unit
    float largest_;
};

using Batches = std::vector<std::vector<Crossing>>;

/// The crossings are in no particular order: the distribution of the faces among threads differs from run to
/// run.
template <typename Grid>
Batches cast_at_all_faces(const LatticeMesh& lattice, const Grid& grid, unsigned thread_count) {
    const RayCaster<Grid> caster(lattice, grid);
    Batches batches;
    std::mutex mutex;
    parallel_for(lattice.faces.size(), thread_count, [&](std::size_t begin, std::size_t end) {
        std::vector<Crossing> crossings;
        for (std::size_t i = begin; i < end; ++i) caster.cast_at(lattice.faces[i], crossings);
        const std::lock_guard lock(mutex);
        batches.push_back(std::move(crossings));
    });
    return batches;
}

/// [direction_count + 1] The index at which each direction's crossings begin.
std::vector<std::uint32_t> offsets_of(const Batches& batches, std::size_t direction_count) {
    std::vector<std::uint32_t> offsets(direction_count + 1);
    std::size_t total = 0;
    for (const auto& batch : batches) {
        total += batch.size();
        for (const Crossing& crossing : batch) ++offsets[crossing.direction + 1];
    }
    if (total > std::numeric_limits<std::uint32_t>::max())
        throw Error(ErrorCode::InvalidMesh, "the rays cross the mesh " + std::to_string(total) +
                                                " times, more than a map can hold; use fewer directions");
    for (std::size_t d = 0; d < direction_count; ++d) offsets[d + 1] += offsets[d];
    return offsets;
}

/// All crossings by direction, in ascending order.
Crossings sorted(const Batches& batches, std::size_t direction_count, unsigned thread_count) {
    Crossings result{offsets_of(batches, direction_count), {}};
    result.distances.resize(result.offsets.back());
    std::vector<std::uint32_t> next(result.offsets.begin(), result.offsets.end() - 1);
    for (const auto& batch : batches)
        for (const Crossing& crossing : batch)
            result.distances[next[crossing.direction]++] = crossing.distance;
    // Sorting also removes the dependence on the timing of threads.
    parallel_for(direction_count, thread_count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t d = begin; d < end; ++d)
            std::sort(result.distances.begin() + result.offsets[d],
                      result.distances.begin() + result.offsets[d + 1]);
    });
    return result;
}

} // namespace

Crossings cast_rays(const LatticeMesh& lattice, const AnyGrid& any_grid, unsigned thread_count) {
    return std::visit(
        [&](const auto& grid) {
            return sorted(cast_at_all_faces(lattice, grid, thread_count), grid.direction_count(),
                          thread_count);
        },
        any_grid);
}

} // namespace echinus
