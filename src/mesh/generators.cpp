#include "files/text.hpp"
#include "geometry/elementary.hpp"
#include "geometry/whole_numbers.hpp"

#include <echinus/error.hpp>
#include <echinus/mesh.hpp>

#include <array>
#include <limits>
#include <string>

namespace echinus {

namespace {

/// Is a length positive and finite, both as a double and as the float that vertices use?
bool is_usable_length(double length) {
    return length <= std::numeric_limits<float>::max() && static_cast<float>(length) > 0;
}

void require(bool condition, const char* sentence) {
    if (!condition) throw Error(ErrorCode::InvalidOptions, sentence);
}

void require_length(double length, const std::string& name) {
    if (!is_usable_length(length))
        throw Error(ErrorCode::InvalidOptions, name + " is " + number_text(length) +
                                                   "; it must be positive and finite as a 32-bit float");
}

void require_face_count(double face_count) {
    require(face_count <= kMaxGeneratedFaceCount,
            "these segments make more faces than a generated mesh may have (2^27)");
}

/// Adds the two faces of the quadrilateral a b c d, which is given counter-clockwise.
void add_quad(TriangleMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.faces.push_back({a, b, c});
    mesh.faces.push_back({a, c, d});
}

Vec3f torus_point(double major_radius, double minor_radius, const CirclePoint& around_axis,
                  const CirclePoint& around_tube) {
    const double axis_distance = major_radius + minor_radius * around_tube.cosine;
    return Vec3f(Vec3d{axis_distance * around_axis.cosine, axis_distance * around_axis.sine,
                       minor_radius * around_tube.sine});
}

Vec3f sphere_point(double radius, const CirclePoint& colatitude, const CirclePoint& longitude) {
    return Vec3f(Vec3d{radius * (colatitude.sine * longitude.cosine),
                       radius * (colatitude.sine * longitude.sine), radius * colatitude.cosine});
}

/// The first vertex is the north pole and the last the south pole; between them are the parallels in order.
void add_sphere_faces(TriangleMesh& mesh, std::uint32_t meridian_count, std::uint32_t parallel_count) {
    const std::uint32_t north_pole = 0;
    const std::uint32_t south_pole = 1 + meridian_count * (parallel_count - 1);
    const auto vertex = [&](std::uint32_t parallel, std::uint32_t meridian) {
        return 1 + (parallel - 1) * meridian_count + meridian % meridian_count;
    };
    for (std::uint32_t m = 0; m < meridian_count; ++m)
        mesh.faces.push_back({north_pole, vertex(1, m), vertex(1, m + 1)});
    for (std::uint32_t p = 1; p + 1 < parallel_count; ++p)
        for (std::uint32_t m = 0; m < meridian_count; ++m)
            add_quad(mesh, vertex(p, m), vertex(p + 1, m), vertex(p + 1, m + 1), vertex(p, m + 1));
    for (std::uint32_t m = 0; m < meridian_count; ++m)
        mesh.faces.push_back({south_pole, vertex(parallel_count - 1, m + 1), vertex(parallel_count - 1, m)});
}

/// Adds one side of a box: segments x segments squares with vertices of their own, on the side where the
/// coordinate along `normal_axis` is largest (or smallest). The axes follow each other cyclically, so u x v
/// points along the normal.
void add_box_side(TriangleMesh& mesh, const std::array<double, 3>& size, std::uint32_t segments,
                  std::size_t normal_axis, bool largest) {
    const std::size_t u_axis = (normal_axis + 1) % 3;
    const std::size_t v_axis = (normal_axis + 2) % 3;
    const auto first = kept_as<std::uint32_t>(mesh.vertices.size());
    // Ranges from -size / 2 to size / 2; equal coordinates of neighbouring sides have the same bits.
    const auto coordinate = [&](std::size_t axis, std::uint32_t i) {
        return static_cast<float>(size[axis] * (2.0 * i - segments) / (2.0 * segments));
    };
    for (std::uint32_t j = 0; j <= segments; ++j)
        for (std::uint32_t i = 0; i <= segments; ++i) {
            std::array<float, 3> p{};
            p[normal_axis] = coordinate(normal_axis, largest ? segments : 0);
            p[u_axis] = coordinate(u_axis, i);
            p[v_axis] = coordinate(v_axis, j);
            mesh.vertices.emplace_back(p[0], p[1], p[2]);
        }
    for (std::uint32_t j = 0; j < segments; ++j)
        for (std::uint32_t i = 0; i < segments; ++i) {
            const std::uint32_t a = first + j * (segments + 1) + i;
            const std::uint32_t d = a + segments + 1;
            if (largest)
                add_quad(mesh, a, a + 1, d + 1, d);
            else
                add_quad(mesh, a, d, d + 1, a + 1);
        }
}

} // namespace

TriangleMesh make_torus(double major_radius, double minor_radius, std::uint32_t major_segments,
                        std::uint32_t minor_segments) {
    require_length(minor_radius, "the minor radius of a torus");
    require_length(major_radius, "the major radius of a torus");
    require(minor_radius < major_radius, "a torus needs 0 < minor radius < major radius");
    require_length(major_radius + minor_radius, "the outer radius of a torus, major + minor,");
    require(major_segments >= 3 && minor_segments >= 3, "a torus needs at least 3 x 3 segments");
    require_face_count(2.0 * major_segments * minor_segments);

    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < major_segments; ++i)
        for (std::uint32_t j = 0; j < minor_segments; ++j)
            mesh.vertices.push_back(torus_point(major_radius, minor_radius, circle_point(i, major_segments),
                                                circle_point(j, minor_segments)));
    for (std::uint32_t i = 0; i < major_segments; ++i)
        for (std::uint32_t j = 0; j < minor_segments; ++j) {
            const std::uint32_t ring = i * minor_segments;
            const std::uint32_t next_ring = (i + 1) % major_segments * minor_segments;
            const std::uint32_t next_j = (j + 1) % minor_segments;
            add_quad(mesh, ring + j, next_ring + j, next_ring + next_j, ring + next_j);
        }
    return mesh;
}

TriangleMesh make_sphere(double radius, std::uint32_t meridian_count, std::uint32_t parallel_count) {
    require_length(radius, "the radius of a sphere");
    require(meridian_count >= 3 && parallel_count >= 2,
            "a sphere needs at least 3 meridians and 2 rows of faces");
    require_face_count(2.0 * meridian_count * parallel_count);

    TriangleMesh mesh;
    mesh.vertices.emplace_back(Vec3d{0, 0, radius});
    for (std::uint32_t parallel = 1; parallel < parallel_count; ++parallel)
        for (std::uint32_t meridian = 0; meridian < meridian_count; ++meridian)
            mesh.vertices.push_back(sphere_point(radius,
                                                 circle_point(parallel, 2 * std::uint64_t{parallel_count}),
                                                 circle_point(meridian, meridian_count)));
    mesh.vertices.emplace_back(Vec3d{0, 0, -radius});
    add_sphere_faces(mesh, meridian_count, parallel_count);
    return mesh;
}

TriangleMesh make_box(const Vec3d& size, std::uint32_t segments) {
    const std::array<double, 3> lengths{size.x, size.y, size.z};
    for (double length : lengths) {
        require_length(length, "the edge length of a box");
        require_length(length / 2, "half the edge length of a box");
    }
    require(segments >= 1, "a box needs at least 1 segment");
    require_face_count(12.0 * segments * segments);

    TriangleMesh sides;
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (bool largest : {false, true}) add_box_side(sides, lengths, segments, axis, largest);
    return weld(sides);
}

} // namespace echinus
