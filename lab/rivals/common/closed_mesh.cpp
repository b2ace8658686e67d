#include "rivals/common/closed_mesh.hpp"

#include "directions/lattice.hpp"
#include "exact_map/build/open_surface.hpp"

#include <echinus/error.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace echinus::rivals {

void require_closed(const TriangleMesh& mesh, std::string_view system) {
    require_valid(mesh);
    if (!find_border(snap_to_lattice(mesh)).empty())
        throw Error(ErrorCode::InvalidMesh,
                    "the mesh is open; " + std::string(system) + " needs a closed one");
}

double Box::longest_side() const {
    const Vec3d s = size();
    return std::max({s.x, s.y, s.z});
}

Box box_of(const TriangleMesh& mesh) {
    const Vec3f& first = mesh.vertices[mesh.faces.front()[0]];
    Box box{first, first};
    for (const Triangle& face : mesh.faces)
        for (const std::uint32_t v : face) {
            const Vec3f& p = mesh.vertices[v];
            box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
            box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
        }
    return box;
}

std::array<double, 3> nodes_over(const Box& box, double spacing) {
    // A quotient that should be whole may come out a rounding too large, and need not cost a layer of nodes.
    constexpr double kRounding = 1e-9;
    const auto along = [&](double side) {
        return std::max(2.0, std::ceil(side / spacing * (1 - kRounding)) + 1);
    };
    const Vec3d size = box.size();
    return {along(size.x), along(size.y), along(size.z)};
}

double spacing_of_samples(const Box& box, std::uint32_t sample_count, std::uint32_t most) {
    if (sample_count < 2 || sample_count > most)
        throw Error(ErrorCode::InvalidOptions, "there are to be " + std::to_string(sample_count) +
                                                   " samples along the longest side; possible are 2 to " +
                                                   std::to_string(most));
    return box.longest_side() / (sample_count - 1);
}

} // namespace echinus::rivals
