#pragma once

#include <echinus/intersections.hpp>
#include <echinus/mesh.hpp>

#include <array>
#include <memory>
#include <vector>

/// The truth about a mesh, by CGAL's exact predicates; shares no code with Echinus. For tests and benchmarks
/// only, as CGAL's parts used here are under the GPL. Its headers stay in exact_judge.cpp.
namespace echinus::test {

enum class ExactSide { Outside, OnSurface, Inside };

/// Inside or outside a closed mesh, and the nearest point. Thread-safe.
class ExactJudge {
  public:
    /// @pre the mesh is closed; faces without area are left out
    explicit ExactJudge(const TriangleMesh& mesh);
    ExactJudge(ExactJudge&& other) noexcept;
    ~ExactJudge();

    /// By the parity of a ray, decided exactly for the given coordinates.
    ExactSide side(const Vec3d& point) const;
    bool inside(const Vec3f& point) const { return side(Vec3d(point)) == ExactSide::Inside; }

    /// Distance to the nearest point of the surface; exact up to the rounding of double.
    double distance(const Vec3d& point) const;

  private:
    struct Structure;
    std::unique_ptr<const Structure> structure_;
};

/// How a ray from the origin meets faces.
struct ExactCrossings {
    std::vector<double> parameters; ///< of the crossings, in multiples of the direction, ascending
    bool generic = true;            ///< the ray meets no edge and no vertex and lies in no face's plane
};

/// Faces with corners of whole numbers up to 2^19, for rays from the origin.
class ExactRayCaster {
  public:
    explicit ExactRayCaster(const std::vector<std::array<Vec3d, 3>>& faces);
    ~ExactRayCaster();

    /// All crossings of the ray along a direction of whole numbers up to 2^19. Where the ray is not generic,
    /// those of the ray along d + (e, e^2, e^3), with e so small that a smaller one gives the same number.
    /// @pre the origin lies on no face and on no line of an edge
    ExactCrossings cast(const Vec3d& direction) const;

  private:
    struct Structure;
    std::unique_ptr<const Structure> structure_;
};

// Which faces intersect. The definitions are those of <echinus/intersections.hpp>.

bool triangles_intersect_by_cgal(const std::array<Vec3f, 3>& a, const std::array<Vec3f, 3>& b);

/// @pre indices are in range, vertices finite; as below
std::vector<FacePair> intersecting_pairs_by_cgal(const TriangleMesh& a, const TriangleMesh& b);

std::vector<FacePair> self_intersecting_pairs_by_cgal(const TriangleMesh& mesh);

} // namespace echinus::test
