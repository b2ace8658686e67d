// The paper says: "the linear interpolation between the distance values S1 and S2 of the samples D1 and D2
// yields lower distance than the actual distance of the vertex. ... In order to correct this error, the
// distance values S1 and S2 are augmented by the error difference between the interpolated value and the
// distance of the vertex."
//
// What it leaves open, and our reading:
// - Which layer is the vertex's? The one whose interpolated distance is nearest to it. Signed: nearest among
// the layers
//   that are crossed the way the vertex's faces are; a vertex on a silhouette, with faces of both kinds, has
//   none.
// - Vertices between samples of different counts are left alone: that is the paper's second error situation,
// which the
//   query treats.
// - Several vertices in one cell: each sample moves by the largest amount that one of them asks for.
// - Increasing errs on the side of the solid only where the ray leaves it. Where it enters, Signed decreases.

#include "distance_map/vertex_correction.hpp"

#include "directions/crossing.hpp"
#include "distance_map/interpolation.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace echinus {

namespace {

/// How the rays cross the faces around a vertex.
enum class Facing : std::uint8_t { None, Outward, Inward, Both };

std::vector<Facing> facings_of(const LatticeMesh& lattice) {
    std::vector<Facing> facings(lattice.vertices.size(), Facing::None);
    for (const Triangle& face : lattice.faces) {
        const FaceCone cone(lattice.vertices[face[0]], lattice.vertices[face[1]], lattice.vertices[face[2]]);
        const Facing facing = cone.edge_on()   ? Facing::Both
                              : cone.outward() ? Facing::Outward
                                               : Facing::Inward;
        for (std::uint32_t vertex : face) {
            Facing& seen = facings[vertex];
            seen = seen == Facing::None || seen == facing ? facing : Facing::Both;
        }
    }
    return facings;
}

/// The uncorrected entries, as the query sees them.
DistanceMapView as_map(const LatticeMesh& lattice, const SphericalGrid& grid, bool centre_inside,
                       const Crossings& crossings) {
    DistanceMapView map;
    map.radius = lattice.radius;
    map.longitude_count = grid.longitude_count();
    map.colatitude_count = grid.colatitude_count();
    map.centre_inside = centre_inside;
    map.entry_offsets = crossings.offsets;
    map.entries_float32 = crossings.distances;
    return map;
}

struct Layer {
    std::uint32_t k;
    float missing; ///< distance of the vertex minus the interpolated distance
};

class Corrector {
  public:
    Corrector(VertexCorrection correction, const LatticeMesh& lattice, const SphericalGrid& grid,
              bool centre_inside, const Crossings& crossings)
        : correction_(correction), step_(lattice.step), grid_(grid), centre_inside_(centre_inside),
          map_(as_map(lattice, grid, centre_inside, crossings)), shifts_(crossings.distances.size()) {}

    void consider(const LatticePoint& vertex, Facing facing) {
        const Vec3d d = Vec3d(vertex) * step_;
        const Interpolation at = interpolation_at(map_, grid_.locate(grid_.to_grid(Vec3f(d))));
        if (!(at.usable[0] && at.usable[1] && at.usable[2] && at.usable[3])) return;
        const std::optional<Layer> layer = layer_of(at, static_cast<float>(length(d)), facing);
        if (!layer || !is_missed(*layer)) return;
        for (std::uint32_t first : at.first_entry) {
            float& shift = shifts_[first + layer->k];
            shift = std::max(shift, std::fabs(layer->missing));
        }
    }

    /// [entry_count] by how much each entry moves; the way is given by its layer.
    const std::vector<float>& shifts() const { return shifts_; }

    bool moves_outward(std::uint32_t k) const {
        return correction_ == VertexCorrection::Paper || is_outward(centre_inside_, k);
    }

  private:
    std::optional<Layer> layer_of(const Interpolation& at, float distance, Facing facing) const {
        std::optional<Layer> nearest;
        for (std::uint32_t k = 0; k < at.entry_count; ++k) {
            if (correction_ == VertexCorrection::Signed && facing != facing_of_layer(k)) continue;
            const float missing = distance - interpolated_entry(map_, at, k);
            if (!nearest || std::fabs(missing) < std::fabs(nearest->missing)) nearest = Layer{k, missing};
        }
        return nearest;
    }
    Facing facing_of_layer(std::uint32_t k) const {
        return is_outward(centre_inside_, k) ? Facing::Outward : Facing::Inward;
    }
    bool is_missed(const Layer& layer) const {
        return moves_outward(layer.k) ? layer.missing > 0 : layer.missing < 0;
    }

    VertexCorrection correction_;
    double step_;
    const SphericalGrid& grid_;
    bool centre_inside_;
    DistanceMapView map_;
    std::vector<float> shifts_;
};

} // namespace

CorrectionCounts correct_at_vertices(VertexCorrection correction, const LatticeMesh& lattice,
                                     const SphericalGrid& grid, bool centre_inside, Crossings& crossings) {
    if (correction == VertexCorrection::None) return {};
    Corrector corrector(correction, lattice, grid, centre_inside, crossings);
    const std::vector<Facing> facings = facings_of(lattice);
    for (std::size_t i = 0; i < facings.size(); ++i)
        if (facings[i] != Facing::None) corrector.consider(lattice.vertices[i], facings[i]);

    CorrectionCounts counts;
    std::vector<float>& entries = crossings.distances;
    for (std::size_t d = 0; d + 1 < crossings.offsets.size(); ++d) {
        const std::uint32_t first = crossings.offsets[d];
        const std::uint32_t last = crossings.offsets[d + 1];
        for (std::uint32_t i = first; i < last; ++i) {
            const float shift = corrector.shifts()[i];
            if (shift == 0) continue;
            // The entry below has its final value, the one above its old one: between them order is kept.
            const float lowest = i == first ? 0 : entries[i - 1];
            const float highest = i + 1 == last ? lattice.radius : entries[i + 1];
            const float wanted = corrector.moves_outward(i - first) ? entries[i] + shift : entries[i] - shift;
            entries[i] = std::clamp(wanted, lowest, highest);
            ++counts.corrected_entries;
            if (entries[i] != wanted) ++counts.clamped_entries;
        }
    }
    return counts;
}

} // namespace echinus
