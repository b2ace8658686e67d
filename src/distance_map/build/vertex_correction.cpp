#include "distance_map/build/vertex_correction.hpp"

#include "directions/face_cone.hpp"
#include "directions/samples_near.hpp"
#include "distance_map/interpolation.hpp"
#include "geometry/whole_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace echinus {

namespace {

/// The vertices of a mesh, grouped by the sample of the grid that is nearest to them.
class VertexBins {
  public:
    VertexBins(const LatticeMesh& lattice, const SphericalGrid& grid)
        : offsets_(grid.direction_count() + 1), vertices_(lattice.vertices.size()) {
        std::vector<std::uint32_t> bins;
        bins.reserve(lattice.vertices.size());
        for (const LatticePoint& vertex : lattice.vertices) {
            const SphericalGrid::Cell cell = grid.locate(Vec3f(grid.to_grid(vertex)));
            bins.push_back(cell.corners[SphericalGrid::reference_corner(cell)]);
            ++offsets_[bins.back() + 1];
        }
        for (std::size_t bin = 1; bin < offsets_.size(); ++bin) offsets_[bin] += offsets_[bin - 1];
        std::vector<std::uint32_t> next(offsets_.begin(), offsets_.end() - 1);
        for (std::uint32_t i = 0; i < bins.size(); ++i) vertices_[next[bins[i]]++] = i;
    }

    std::span<const std::uint32_t> at(std::uint32_t sample) const {
        return std::span(vertices_).subspan(offsets_[sample], offsets_[sample + 1] - offsets_[sample]);
    }

  private:
    std::vector<std::uint32_t> offsets_, vertices_;
};

Facing combine(Facing seen, Facing added) {
    return seen == Facing::None || seen == added ? added : Facing::Both;
}

} // namespace

std::vector<VertexLayer> layers_of_vertices(const LatticeMesh& lattice, const SphericalGrid& grid) {
    const VertexBins bins(lattice, grid);
    std::vector<VertexLayer> layers(lattice.vertices.size());
    for (const Triangle& face : lattice.faces) {
        const LatticePoint &a = lattice.vertices[face[0]], &b = lattice.vertices[face[1]],
                           &c = lattice.vertices[face[2]];
        const FaceCone cone(a, b, c);
        const Facing facing = cone.edge_on()   ? Facing::Both
                              : cone.outward() ? Facing::Outward
                                               : Facing::Inward;
        for (std::uint32_t corner : face) layers[corner].facing = combine(layers[corner].facing, facing);
        if (cone.edge_on()) continue;

        const auto cast_at_vertex = [&](std::uint32_t i) {
            const LatticePoint& vertex = lattice.vertices[i];
            if (!cone.meets(vertex)) return;
            ++layers[i].crossing_count;
            const bool is_corner = std::find(face.begin(), face.end(), i) != face.end();
            if (!is_corner && cone.nearer_than(vertex)) ++layers[i].crossings_before;
        };
        constexpr double kHalfACell = 0.5; // distance of a vertex from the sample to whose bin it belongs
        for_each_sample_near(grid, {a, b, c}, kHalfACell, [&](std::uint32_t sample) {
            for (std::uint32_t i : bins.at(sample)) cast_at_vertex(i);
        });
    }
    return layers;
}

// The paper says: "the linear interpolation between the distance values S1 and S2 of the samples D1 and D2
// yields lower distance than the actual distance of the vertex. ... In order to correct this error, the
// distance values S1 and S2 are augmented by the error difference between the interpolated value and the
// distance of the vertex."
//
// The paper leaves the following open; this is our interpretation:
// - Which layer does the vertex belong to? To the one with as many crossings before it as the vertex has on
//   its own ray. The layer nearest to it may be a different one: that of the other side of a thin part.
// - A vertex on a silhouette has faces through which rays leave and faces through which they enter, hence no
//   layer of its own.
// - Vertices whose ray has more or fewer crossings than one of the samples around it are left unchanged: that
//   is the paper's second error situation, which the query handles.
// - If several vertices are in one cell, each sample moves by the largest amount that any of them requires.
// - Increasing a distance errs on the side of the solid only where the ray leaves it. Where the ray enters,
//   Signed decreases the distance.

namespace {

/// A view of the uncorrected entries, for interpolation as in queries.
DistanceMapView as_map(const LatticeMesh& lattice, bool centre_inside, const Crossings& crossings) {
    DistanceMapView map;
    map.radius = lattice.radius;
    map.centre_inside = centre_inside;
    map.entry_offsets = crossings.offsets;
    map.entries_float32 = crossings.distances;
    return map;
}

/// Computes with the grid's interpolant, which is linear between samples.
template <typename Grid>
class Corrector {
  public:
    Corrector(VertexCorrection correction, const LatticeMesh& lattice, const Grid& grid, bool centre_inside,
              const Crossings& crossings)
        : correction_(correction), step_(lattice.frame.step), grid_(grid), centre_inside_(centre_inside),
          map_(as_map(lattice, centre_inside, crossings)), shifts_(crossings.distances.size()) {}

    void consider(const LatticePoint& vertex, const VertexLayer& layer) {
        if (!has_layer_of_its_own(layer)) return;
        const Vec3d d = Vec3d(vertex) * step_;
        const Interpolation<Grid> at = interpolation_at(map_, grid_, grid_.locate(grid_.to_grid(Vec3f(d))));
        if (!(at.usable[0] && at.usable[1] && at.usable[2] && at.usable[3])) return;
        if (at.entry_count != layer.crossing_count) return;
        const std::uint32_t k = layer.crossings_before;
        const float wanted = grid_.interpolant_at(d);
        const float present = interpolated(map_, at, k);
        const bool reached =
            moves_outward(k) ? !Grid::is_farther(wanted, present) : !Grid::is_farther(present, wanted);
        if (reached) return;
        const float missing = std::fabs(wanted - present);
        for (std::uint32_t first : at.first_entry) {
            float& shift = shifts_[first + k];
            shift = std::max(shift, missing);
        }
    }

    /// [entry_count] By how much each entry moves; its layer determines the direction.
    const std::vector<float>& shifts() const { return shifts_; }

    bool moves_outward(std::uint32_t k) const {
        return correction_ == VertexCorrection::Paper || is_outward(centre_inside_, k);
    }

  private:
    /// On a mesh that is open or partly inside out, the direction in which the faces are crossed may differ
    /// from that of the layer; Signed, which depends on the layer, then leaves the vertex unchanged.
    bool has_layer_of_its_own(const VertexLayer& layer) const {
        if (layer.facing != Facing::Outward && layer.facing != Facing::Inward) return false;
        if (layer.crossings_before >= layer.crossing_count) return false;
        if (correction_ == VertexCorrection::Paper) return true;
        return is_outward(centre_inside_, layer.crossings_before) == (layer.facing == Facing::Outward);
    }

    VertexCorrection correction_;
    double step_;
    const Grid& grid_;
    bool centre_inside_;
    DistanceMapView map_;
    std::vector<float> shifts_;
};

/// A grid for finding the faces around the rays of vertices. Any resolution gives the same layers; about as
/// many directions as the map has are suitable.
SphericalGrid finder_like(std::size_t direction_count) {
    const auto side = truncated_to<std::uint32_t>(std::sqrt(static_cast<double>(direction_count)));
    return {side, side, PoleAxis::Z};
}

template <typename Grid>
CorrectionCounts correct(VertexCorrection correction, const LatticeMesh& lattice, const Grid& grid,
                         bool centre_inside, Crossings& crossings) {
    if (correction == VertexCorrection::None) return {};
    Corrector<Grid> corrector(correction, lattice, grid, centre_inside, crossings);
    const std::vector<VertexLayer> layers = layers_of_vertices(lattice, finder_like(grid.direction_count()));
    for (std::size_t i = 0; i < layers.size(); ++i) corrector.consider(lattice.vertices[i], layers[i]);

    CorrectionCounts counts;
    std::vector<float>& entries = crossings.distances;
    for (std::size_t d = 0; d + 1 < crossings.offsets.size(); ++d) {
        const std::uint32_t first = crossings.offsets[d];
        const std::uint32_t last = crossings.offsets[d + 1];
        for (std::uint32_t i = first; i < last; ++i) {
            const float shift = corrector.shifts()[i];
            if (shift == 0) continue;
            // The entry below already has its final value, the one above still its old one; clamping between
            // them preserves the order.
            const float lowest = i == first ? 0 : entries[i - 1];
            const float highest = i + 1 == last ? grid.largest_entry(lattice.radius) : entries[i + 1];
            const float wanted = Grid::moved(entries[i], shift, corrector.moves_outward(i - first));
            entries[i] = std::clamp(wanted, lowest, highest);
            ++counts.corrected_entries;
            if (entries[i] != wanted) ++counts.clamped_entries;
        }
    }
    return counts;
}

} // namespace

CorrectionCounts correct_at_vertices(VertexCorrection correction, const LatticeMesh& lattice,
                                     const AnyGrid& any_grid, bool centre_inside, Crossings& crossings) {
    return std::visit(
        [&](const auto& grid) { return correct(correction, lattice, grid, centre_inside, crossings); },
        any_grid);
}

} // namespace echinus
