#include "distance_map/build/vertex_layers.hpp"

#include "directions/face_cone.hpp"
#include "directions/samples_near.hpp"

#include <algorithm>
#include <span>

namespace echinus {

namespace {

/// The vertices of a mesh by the sample of the grid that is nearest to them.
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
        constexpr double kHalfACell = 0.5; // from a vertex to the sample it is binned at
        for_each_sample_near(grid, {a, b, c}, kHalfACell, [&](std::uint32_t sample) {
            for (std::uint32_t i : bins.at(sample)) cast_at_vertex(i);
        });
    }
    return layers;
}

} // namespace echinus
