#pragma once

#include <echinus/mesh.hpp>

#include <array>
#include <cstdint>
#include <string_view>

/// Common first checks of the builders of several systems.
namespace echinus::rivals {

/// Throws unless the mesh has an inside: for an open one, the answers of every system are an accident of its
/// rule. Closed is what MeshReport::closed says, for which faces need not share vertices.
/// @param system  for the sentence, such as "a dense grid"
/// @throws Error InvalidMesh as inspect() does, for an open mesh, or when the bounding radius lies outside
/// [1e-15, 1e15]
void require_closed(const TriangleMesh& mesh, std::string_view system);

struct Box {
    Vec3f low, high;

    Vec3d size() const { return Vec3d(high) - Vec3d(low); }
    double longest_side() const;
};

/// Of the vertices that faces use. @pre there is a face, and indices are in range
Box box_of(const TriangleMesh& mesh);

/// The nodes of a grid from the box's lowest corner on that has a cell everywhere in the box: two at least
/// along each axis. In double, since the spacing is not yet bounded.
std::array<double, 3> nodes_over(const Box& box, double spacing);

/// The spacing that puts this many samples along the box's longest side, ends included.
/// @throws Error InvalidOptions unless sample_count lies in [2, most]
double spacing_of_samples(const Box& box, std::uint32_t sample_count, std::uint32_t most);

} // namespace echinus::rivals
