#include "rivals/superquadric_map/segments.hpp"

#include <LinearMath/btConvexHullComputer.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

namespace echinus::rivals {

namespace {

/// Relative to their mean and size, since Bullet computes with floats.
std::vector<double> normalised(std::span<const Vec3f> points) {
    Vec3d mean;
    for (const Vec3f& p : points) mean += Vec3d(p) * (1.0 / static_cast<double>(points.size()));
    double size = 0;
    for (const Vec3f& p : points) size = std::max(size, length(Vec3d(p) - mean));
    std::vector<double> coordinates;
    for (const Vec3f& p : points) {
        const Vec3d q = (Vec3d(p) - mean) * (size > 0 ? 1 / size : 0);
        coordinates.insert(coordinates.end(), {q.x, q.y, q.z});
    }
    return coordinates;
}

} // namespace

std::vector<Triangle> convex_hull(std::span<const Vec3f> points) {
    const std::vector<double> coordinates = normalised(points);
    btConvexHullComputer hull;
    hull.compute(coordinates.data(), 3 * sizeof(double), static_cast<int>(points.size()), 0, 0);
    std::vector<Triangle> faces;
    for (int face = 0; face < hull.faces.size(); ++face) {
        std::vector<std::uint32_t> corners;
        const auto* const first = &hull.edges[hull.faces[face]];
        const auto* edge = first;
        do {
            corners.push_back(
                static_cast<std::uint32_t>(hull.original_vertex_index[edge->getSourceVertex()]));
            edge = edge->getNextEdgeOfFace();
        } while (edge != first);
        for (std::size_t k = 2; k < corners.size(); ++k)
            faces.push_back({corners[0], corners[k - 1], corners[k]});
    }
    return faces;
}

namespace {

/// Copies faces, with those vertices that they use.
class FaceCopier {
  public:
    explicit FaceCopier(const TriangleMesh& mesh)
        : mesh_(mesh), numbers_(mesh.vertices.size()), owners_(numbers_.size(), kNobody) {}

    /// @param owner  another number for each target
    void copy(std::uint32_t face, std::uint32_t owner, TriangleMesh& target) {
        Triangle copied;
        for (std::size_t k = 0; k < 3; ++k) copied[k] = number_of(mesh_.faces[face][k], owner, target);
        target.faces.push_back(copied);
    }

  private:
    static constexpr std::uint32_t kNobody = std::numeric_limits<std::uint32_t>::max();

    std::uint32_t number_of(std::uint32_t vertex, std::uint32_t owner, TriangleMesh& target) {
        if (owners_[vertex] != owner) {
            owners_[vertex] = owner;
            numbers_[vertex] = static_cast<std::uint32_t>(target.vertices.size());
            target.vertices.push_back(mesh_.vertices[vertex]);
        }
        return numbers_[vertex];
    }

    const TriangleMesh& mesh_;
    std::vector<std::uint32_t> numbers_; ///< [vertex_count] in the target that used the vertex last
    std::vector<std::uint32_t> owners_;  ///< [vertex_count] which target that is
};

double area_of(std::span<const Vec3f> vertices, const Triangle& face) {
    const Vec3d a(vertices[face[0]]), b(vertices[face[1]]), c(vertices[face[2]]);
    return length(cross(b - a, c - a)) / 2;
}

/// How far a ray goes before it meets a face from behind; infinity when it does not (Moeller and Trumbore
/// 1997).
double distance_to_exit(const TriangleMesh& mesh, const Triangle& face, const Vec3d& from,
                        const Vec3d& direction) {
    constexpr double kMiss = std::numeric_limits<double>::infinity();
    const Vec3d a(mesh.vertices[face[0]]);
    const Vec3d ab = Vec3d(mesh.vertices[face[1]]) - a, ac = Vec3d(mesh.vertices[face[2]]) - a;
    const Vec3d p = cross(direction, ac);
    const double determinant = dot(ab, p);
    if (!(determinant < 0)) return kMiss;
    const Vec3d to_start = from - a, q = cross(to_start, ab);
    const double u = dot(to_start, p) / determinant, v = dot(direction, q) / determinant;
    const double distance = dot(ac, q) / determinant;
    return u >= 0 && v >= 0 && u + v <= 1 && distance > 0 ? distance : kMiss;
}

/// The planes of a convex solid's faces.
class HalfSpaces {
  public:
    HalfSpaces(std::span<const Vec3f> vertices, std::span<const Triangle> faces) {
        Vec3d middle;
        for (const Vec3f& p : vertices) middle += Vec3d(p) * (1.0 / static_cast<double>(vertices.size()));
        for (const auto& [i, j, k] : faces) {
            const Vec3d a(vertices[i]), b(vertices[j]), c(vertices[k]);
            const Vec3d normal = cross(b - a, c - a);
            const bool is_outward = dot(normal, middle - a) <= 0;
            planes_.push_back({is_outward ? normal : -normal, a});
        }
    }
    bool hold(const Vec3d& p) const {
        return !planes_.empty() && std::ranges::all_of(planes_, [&](const Plane& plane) {
            return dot(plane.normal, p - plane.on_it) <= 0;
        });
    }

  private:
    struct Plane {
        Vec3d normal, on_it;
    };
    std::vector<Plane> planes_;
};

/// The outer half of a chord of the solid.
struct HalfChord {
    Vec3d start, middle;
};

/// Chords that run inwards from some faces of a mesh.
std::vector<HalfChord> half_chords(const TriangleMesh& mesh, std::span<const Triangle> faces) {
    constexpr std::size_t kChordCount = 100;
    std::vector<HalfChord> result;
    const SurfaceSamples starts = sample_surface(mesh.vertices, faces, kChordCount);
    for (std::size_t i = 0; i < starts.points.size(); ++i) {
        const Triangle& face = faces[starts.faces[i]];
        const Vec3d a(mesh.vertices[face[0]]), b(mesh.vertices[face[1]]), c(mesh.vertices[face[2]]);
        const Vec3d inwards = cross(c - a, b - a) * (1 / length(cross(c - a, b - a)));
        double chord = std::numeric_limits<double>::infinity();
        for (const Triangle& other : mesh.faces)
            chord = std::min(chord, distance_to_exit(mesh, other, starts.points[i], inwards));
        if (std::isfinite(chord))
            result.push_back({starts.points[i], starts.points[i] + inwards * (chord / 2)});
    }
    return result;
}

/// Is every place of a half chord, as far as a few tell, in some solid?
bool is_held(const HalfChord& chord, const std::vector<HalfSpaces>& solids) {
    for (const double share : {0.1, 0.25, 0.5, 0.75, 1.0}) {
        const Vec3d place = chord.start + (chord.middle - chord.start) * share;
        if (std::ranges::none_of(solids, [&](const HalfSpaces& solid) { return solid.hold(place); }))
            return false;
    }
    return true;
}

/// Fractions of i times the golden ratio's kin in the plane: evenly spread for every count (Roberts 2018, the
/// R2 sequence).
Vec3d barycentric(std::size_t i) {
    const double n = static_cast<double>(i) + 0.5;
    double u = std::fmod(n * 0.7548776662466927, 1.0), v = std::fmod(n * 0.5698402909980532, 1.0);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    return {1 - u - v, u, v};
}

} // namespace

bool Segment::holds(const Vec3d& place) const {
    return HalfSpaces(mesh.vertices, hull_faces()).hold(place);
}

std::vector<Segment> make_segments(const TriangleMesh& mesh, const Decomposition& decomposition) {
    std::vector<Segment> segments(decomposition.segment_count);
    if (segments.empty()) return segments;
    std::vector<std::vector<Triangle>> faces(segments.size());
    for (std::uint32_t face = 0; face < mesh.faces.size(); ++face) {
        const std::uint32_t segment = decomposition.segment_of_face[face];
        segments[segment].face_numbers.push_back(face);
        faces[segment].push_back(mesh.faces[face]);
    }
    FaceCopier copier(mesh);
    std::vector<HalfSpaces> crusts;
    for (std::uint32_t i = 0; i < segments.size(); ++i) {
        for (const std::uint32_t face : segments[i].face_numbers) copier.copy(face, i, segments[i].mesh);
        crusts.emplace_back(segments[i].mesh.vertices, convex_hull(segments[i].mesh.vertices));
    }
    for (std::size_t i = 0; i < segments.size(); ++i) {
        TriangleMesh& own = segments[i].mesh;
        for (const HalfChord& chord : half_chords(mesh, faces[i]))
            if (!is_held(chord, crusts)) own.vertices.emplace_back(chord.middle);
        std::ranges::copy(convex_hull(own.vertices), std::back_inserter(own.faces));
    }
    return segments;
}

SurfaceSamples sample_surface(std::span<const Vec3f> vertices, std::span<const Triangle> faces,
                              std::size_t count) {
    SurfaceSamples samples;
    for (const Triangle& face : faces) samples.area += area_of(vertices, face);
    if (!(samples.area > 0)) return samples;
    const double area_each = samples.area / static_cast<double>(count);
    double area = 0; // of the faces so far
    for (std::uint32_t number = 0; number < faces.size(); ++number) {
        const auto& [a, b, c] = faces[number];
        area += area_of(vertices, faces[number]);
        while (samples.points.size() < count &&
               (static_cast<double>(samples.points.size()) + 0.5) * area_each < area) {
            const Vec3d weights = barycentric(samples.points.size());
            samples.points.push_back(Vec3d(vertices[a]) * weights.x + Vec3d(vertices[b]) * weights.y +
                                     Vec3d(vertices[c]) * weights.z);
            samples.faces.push_back(number);
        }
    }
    return samples;
}

} // namespace echinus::rivals
