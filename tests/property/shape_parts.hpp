#pragma once

#include "support/random_points.hpp"

#include <echinus/mesh.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace echinus::test {

/// Decisions of a seed: the same on every machine.
class Choices {
  public:
    explicit Choices(std::uint64_t seed) : random_(seed) {}

    /// A whole number from `low` to `high`, both included.
    int between(int low, int high) { return low + static_cast<int>(random_.uniform() * (high - low + 1)); }
    std::size_t below(std::size_t count) {
        return static_cast<std::size_t>(random_.uniform() * static_cast<double>(count));
    }
    bool chance(double probability) { return random_.uniform() < probability; }
    double within(double low, double high) { return random_.uniform(low, high); }
    template <typename List>
    const auto& one_of(const List& list) {
        return list[below(std::size(list))];
    }

  private:
    test::PortableRandom random_;
};

// Closed, oriented parts as designers draw them, on a grid of small whole numbers, and what designers do
// with them.

/// A mesh and the words for how it was made.
struct Part {
    TriangleMesh mesh;
    std::string recipe;
};

/// A point of the plane, with whole coordinates.
struct GridPoint {
    int x = 0, y = 0;
};
/// A simple polygon, counter-clockwise.
using Polygon = std::vector<GridPoint>;

// ---- Planar figures

struct Profile {
    Polygon polygon;
    std::string name;
};

/// A rectangle, triangle, octagon, L, T, U, cross, star, or a disc with a mouth. All but some stars contain
/// or touch the origin.
Profile random_profile(Choices& choices);

/// Triangles that fill a polygon, by cutting ears from a random corner on; two polygons with the same corners
/// may get different diagonals. A polygon that touches itself, as one with a cut to its hole does, will do.
std::vector<Triangle> triangulate(const Polygon& polygon, Choices& choices);

// ---- Solids

/// From z = 0 to `height`.
TriangleMesh extruded(const Polygon& polygon, int height, Choices& choices);
/// From the polygon in z = 0 to a point.
TriangleMesh tapered_to(const Polygon& polygon, const Vec3f& apex, Choices& choices);
/// A profile of (distance from the axis, z) around the z axis. Points on the axis become one vertex.
TriangleMesh revolved(const Polygon& profile, std::uint32_t sides, Choices& choices);

/// One part of a random kind and size, at most some 12 units wide.
Part random_part(Choices& choices);

// ---- Changes that keep a mesh closed

void append(TriangleMesh& whole, const TriangleMesh& part);
TriangleMesh inside_out(TriangleMesh mesh);
/// @param axes  which old axis becomes x, y and z. An odd permutation mirrors, and the faces are turned
TriangleMesh with_axes(TriangleMesh mesh, const std::array<std::size_t, 3>& axes);
TriangleMesh mirrored(TriangleMesh mesh, std::size_t axis);
TriangleMesh moved(TriangleMesh mesh, const Vec3f& offset);
TriangleMesh stretched(TriangleMesh mesh, const Vec3f& factors);
/// By 45 degrees about an axis, and larger by the root of two: whole numbers stay whole.
TriangleMesh turned_by_eighth(TriangleMesh mesh, std::size_t axis);
/// A tetrahedron over each face with its tip in `apex`, all counted with sign. Together they wind around
/// every place as the mesh does.
TriangleMesh cut_into_tetrahedra(const TriangleMesh& mesh, const Vec3f& apex);
/// Cuts some faces in three at a point inside, and some pairs of faces in two at the middle of their edge.
TriangleMesh subdivided(TriangleMesh mesh, Choices& choices);
/// Faces in another order, beginning with another corner.
TriangleMesh shuffled(TriangleMesh mesh, Choices& choices);

struct Box {
    Vec3f low, high;
    Vec3f size() const { return high - low; }
};
/// @pre the mesh has vertices
Box box_of(const TriangleMesh& mesh);

/// A closed, oriented mesh as designers make them.
struct Shape {
    std::uint64_t seed = 0;
    std::string recipe; ///< how it was made, in words
    TriangleMesh mesh;
};

/// The shape of a seed: boxes, prisms, profiles, pyramids, bodies of revolution and the like on a grid of
/// small whole numbers; alone, cut into wedges or tetrahedra, side by side, overlapping, nested, hollow,
/// doubled, arrayed or mirrored; then turned, welded, subdivided, flattened, scaled and moved. Winding
/// numbers may be any whole numbers. It has at most some 2000 faces, and mostly 10 to 100. The same seed
/// gives the same bits on every machine.
Shape make_shape(std::uint64_t seed);

} // namespace echinus::test
