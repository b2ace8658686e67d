#include "mesh/local_frame.hpp"
#include "mesh_io/readers.hpp"

#include <algorithm>
#include <span>
#include <utility>

namespace echinus {

namespace {

struct Point {
    double x, y;

    friend bool operator==(const Point&, const Point&) = default;
};

/// Positive if a, b, c turn to the left.
double turn(const Point& a, const Point& b, const Point& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// A polygon seen against its normal, so that it runs counter-clockwise. The remaining corners form a ring.
class Outline {
  public:
    Outline(std::span<const std::uint32_t> corners, const std::vector<Vec3f>& vertices);

    std::uint32_t next(std::uint32_t i) const { return next_[i]; }
    std::uint32_t previous(std::uint32_t i) const { return previous_[i]; }
    void remove(std::uint32_t i) {
        next_[previous_[i]] = next_[i];
        previous_[next_[i]] = previous_[i];
    }

    double turn_at(std::uint32_t i) const {
        return turn(points_[previous_[i]], points_[i], points_[next_[i]]);
    }
    bool is_strictly_convex() const;
    bool is_ear(std::uint32_t i) const;

  private:
    std::vector<Point> points_;
    std::vector<std::uint32_t> next_;
    std::vector<std::uint32_t> previous_;
};

/// The normal of a polygon, which need not be flat, by Newell's method: twice its projected areas.
Vec3d newell_normal(std::span<const std::uint32_t> corners, const std::vector<Vec3f>& vertices) {
    const Vec3d origin(vertices[corners[0]]);
    Vec3d normal;
    for (std::size_t i = 2; i < corners.size(); ++i)
        normal += cross(Vec3d(vertices[corners[i - 1]]) - origin, Vec3d(vertices[corners[i]]) - origin);
    return normal;
}

/// Drops the coordinate along which the normal is longest, which keeps most of the area.
Point project(const Vec3f& p, const Vec3d& normal) {
    const Vec3d size{std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)};
    if (size.x >= size.y && size.x >= size.z) return normal.x > 0 ? Point{p.y, p.z} : Point{p.z, p.y};
    if (size.y >= size.z) return normal.y > 0 ? Point{p.z, p.x} : Point{p.x, p.z};
    return normal.z > 0 ? Point{p.x, p.y} : Point{p.y, p.x};
}

Outline::Outline(std::span<const std::uint32_t> corners, const std::vector<Vec3f>& vertices) {
    const Vec3d normal = newell_normal(corners, vertices);
    const auto count = static_cast<std::uint32_t>(corners.size());
    for (std::uint32_t i = 0; i < count; ++i) {
        points_.push_back(project(vertices[corners[i]], normal));
        next_.push_back((i + 1) % count);
        previous_.push_back((i + count - 1) % count);
    }
}

bool Outline::is_strictly_convex() const {
    for (std::uint32_t i = 0; i < points_.size(); ++i)
        if (!(turn_at(i) > 0)) return false;
    return true;
}

/// The corner is convex and no other corner is in the triangle that its removal would cut off. Corners that
/// coincide with one of the triangle's corners do not matter: a slit that leads to a hole passes each point
/// twice.
bool Outline::is_ear(std::uint32_t i) const {
    if (!(turn_at(i) > 0)) return false;
    const Point& a = points_[previous_[i]];
    const Point& b = points_[i];
    const Point& c = points_[next_[i]];
    for (std::uint32_t other = next_[next_[i]]; other != previous_[i]; other = next_[other]) {
        const Point& p = points_[other];
        const bool obstructs = turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
        if (obstructs && p != a && p != b && p != c) return false;
    }
    return true;
}

void add_fan(std::span<const std::uint32_t> corners, std::vector<Triangle>& faces) {
    for (std::size_t i = 2; i < corners.size(); ++i)
        faces.push_back({corners[0], corners[i - 1], corners[i]});
}

void clip_ears(Outline& outline, std::span<const std::uint32_t> corners, std::vector<Triangle>& faces) {
    std::uint32_t corner = 1; // the first ear tried is the fan's first triangle
    std::size_t left = corners.size();
    for (std::size_t misses = 0; left > 3 && misses < left; corner = outline.next(corner)) {
        if (!outline.is_ear(corner)) {
            ++misses;
            continue;
        }
        faces.push_back({corners[outline.previous(corner)], corners[corner], corners[outline.next(corner)]});
        outline.remove(corner);
        --left;
        misses = 0;
    }
    std::vector<std::uint32_t> rest;
    corner = outline.previous(corner);
    for (std::size_t i = 0; i < left; ++i, corner = outline.next(corner)) rest.push_back(corners[corner]);
    add_fan(rest, faces);
}

void cut_polygon(std::span<const std::uint32_t> corners, std::size_t polygon, const MeshSource& source,
                 TriangleMesh& mesh) {
    if (corners.size() <= 3) return add_fan(corners, mesh.faces);
    Outline outline(corners, mesh.vertices);
    if (outline.is_strictly_convex()) return add_fan(corners, mesh.faces);
    if (corners.size() > kMaxConcaveCorners)
        source.fail(ErrorCode::InvalidMesh, "polygon " + std::to_string(polygon) + " is concave and has " +
                                                std::to_string(corners.size()) + " corners; at most " +
                                                std::to_string(kMaxConcaveCorners) +
                                                " are cut into triangles");
    clip_ears(outline, corners, mesh.faces);
}

} // namespace

TriangleMesh triangulate(const PolygonMesh& polygons, const MeshSource& source) {
    LocalPositions local = to_local_frame(polygons.vertices, polygons.corners);
    TriangleMesh mesh{std::move(local.positions), {}, local.origin};
    std::size_t begin = 0;
    for (std::size_t polygon = 0; polygon < polygons.corner_counts.size(); ++polygon) {
        const std::size_t count = polygons.corner_counts[polygon];
        cut_polygon(std::span(polygons.corners).subspan(begin, count), polygon, source, mesh);
        begin += count;
    }
    return mesh;
}

} // namespace echinus
