#pragma once

#include <echinus/geometry.hpp>
#include <echinus/mesh.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace echinus::test {

/// The right answers about a closed mesh: by brute force over all its faces, in double, without any map.
class ShapeJudge {
  public:
    using Corners = std::array<Vec3d, 3>;

    /// @param tolerance  how near to the surface, or to an edge of a face, a map may be of another opinion
    ShapeJudge(const TriangleMesh& mesh, double tolerance);

    /// How often the surface goes around a point; nothing within the tolerance of the surface, or where
    /// rounding might decide.
    std::optional<int> winding(const Vec3d& point) const;
    /// winding() of a point whose distance from the surface is known to be beyond the tolerance.
    std::optional<int> winding_away_from_surface(const Vec3d& point) const;

    double distance(const Vec3d& point) const;

    /// Where a segment passes through a face.
    struct Crossing {
        std::size_t face = 0;
        double fraction = 0; ///< of the segment
        bool clear = false;  ///< a segment one tolerance beside this one passes through the face, too
    };
    /// All crossings, and also segments that come within the tolerance of a face (as not clear).
    std::vector<Crossing> crossings(const Vec3d& from, const Vec3d& to) const;

    const Corners& corners(std::size_t face) const { return faces_[face].corners; }
    /// Distance between a triangle and a face. 0 where they meet.
    double distance(const Corners& triangle, std::size_t face) const;
    double distance(const Corners& triangle) const;

    /// The volume of all places where the winding number is not 0. It is exact up to rounding where no faces
    /// pass through each other: between its corners a section is as wide as a linear function says, and
    /// between vertices its area is quadratic. Elsewhere it is off by less than a thousandth.
    double enclosed_volume() const;

    std::size_t face_count() const { return mesh_.faces.size(); }

  private:
    /// A ball around a face, to pass over those that are farther than one found before.
    struct FaceBall {
        Corners corners;
        Vec3d centre;
        double radius;
    };

    const TriangleMesh& mesh_;
    double tolerance_;
    std::vector<FaceBall> faces_;
};

} // namespace echinus::test
