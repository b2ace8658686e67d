#include "judges/nasty_meshes.hpp"

#include "support/random_points.hpp"

#include <echinus/error.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <utility>

namespace echinus::test {

namespace {

void append(TriangleMesh& whole, const TriangleMesh& part) {
    const auto offset = static_cast<std::uint32_t>(whole.vertices.size());
    whole.vertices.insert(whole.vertices.end(), part.vertices.begin(), part.vertices.end());
    for (const auto& [a, b, c] : part.faces) whole.faces.push_back({a + offset, b + offset, c + offset});
}

TriangleMesh rotated(TriangleMesh mesh, const Rotation& rotation) {
    for (Vec3f& vertex : mesh.vertices) vertex = Vec3f(rotation.apply(Vec3d(vertex)));
    return mesh;
}

/// Boxes along the axes whose faces lie in common planes, touch each other and pass through the origin's
/// coordinate planes; many coordinates are whole lattice steps.
TriangleMesh make_aligned_boxes() {
    TriangleMesh whole;
    for (const Vec3f offset : {Vec3f{0, 0, 0}, Vec3f{2, 0, 0}, Vec3f{0, 2, 0}, Vec3f{-2, -2, 0},
                               Vec3f{2, 2, 2}, Vec3f{-2, 0, -2}, Vec3f{1, 1, 1}})
        append(whole, translated(make_box({2, 2, 2}, 4), offset));
    return whole;
}

/// Thin rods in all directions, most of them pointing at the centre: long lists of faces seen edge-on.
TriangleMesh make_needles() {
    test::PortableRandom random(5);
    TriangleMesh whole;
    for (int i = 0; i < 60; ++i) {
        const Vec3d axis{random.normal(), random.normal(), random.normal()};
        const Rotation rotation = Rotation::about(axis, random.uniform(0, 6));
        const float distance = i % 3 == 0 ? 0.0F : 0.55F;
        append(whole, rotated(translated(make_box({0.9, 1e-3, 2e-3}, 4), {distance, 0, 0}), rotation));
    }
    return whole;
}

/// Splits faces at the midpoints of their edges, which neighbours share.
class Subdivision {
  public:
    explicit Subdivision(TriangleMesh& mesh) : mesh_(mesh) {}

    std::uint32_t middle(std::uint32_t a, std::uint32_t b) {
        const auto [place, is_new] =
            middles_.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh_.vertices.size()));
        if (is_new) mesh_.vertices.push_back((mesh_.vertices[a] + mesh_.vertices[b]) * 0.5F);
        return place->second;
    }

  private:
    TriangleMesh& mesh_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles_;
};

/// Each face gets a spike on its middle quarter: Koch's snowflake, one dimension up.
TriangleMesh with_spikes(const TriangleMesh& mesh, float height) {
    TriangleMesh result;
    result.vertices = mesh.vertices;
    Subdivision subdivision(result);
    for (const auto& [a, b, c] : mesh.faces) {
        const std::uint32_t ab = subdivision.middle(a, b), bc = subdivision.middle(b, c),
                            ca = subdivision.middle(c, a);
        const auto tip = static_cast<std::uint32_t>(result.vertices.size());
        const Vec3f &p = mesh.vertices[a], &q = mesh.vertices[b], &r = mesh.vertices[c];
        const Vec3f normal = cross(q - p, r - p);
        // The face's width times `height`.
        result.vertices.push_back((p + q + r) * (1.0F / 3) + normal * (height / std::sqrt(length(normal))));
        for (const Triangle& face : {Triangle{a, ab, ca}, Triangle{ab, b, bc}, Triangle{ca, bc, c},
                                     Triangle{ab, bc, tip}, Triangle{bc, ca, tip}, Triangle{ca, ab, tip}})
            result.faces.push_back(face);
    }
    return result;
}

TriangleMesh make_star() {
    TriangleMesh star = make_sphere(1, 4, 2); // an octahedron
    for (int level = 0; level < 4; ++level) star = with_spikes(star, level == 0 ? 1.4F : 0.6F);
    return star;
}

/// Nested shells, oriented alternately outwards and inwards, except for two in a row.
TriangleMesh make_nested_spheres() {
    TriangleMesh whole;
    for (int i = 0; i < 9; ++i) {
        const TriangleMesh shell = make_sphere(1 - 0.1 * i, 48, 24);
        append(whole, i % 2 == 0 || i == 5 ? shell : turned_inside_out(shell));
    }
    return whole;
}

/// A closed chain of links, each at right angles to the next.
TriangleMesh make_rings() {
    constexpr int kCount = 100;
    constexpr double kSpacing = 1.4; // links of radius 1 and tube 0.15 interlock and do not touch
    constexpr double kTurn = 2 * std::numbers::pi / kCount;
    const TriangleMesh lying = make_torus(1, 0.15, 24, 12);
    const TriangleMesh standing = rotated(lying, Rotation::about({0, 1, 0}, std::numbers::pi / 2));
    TriangleMesh whole;
    for (int i = 0; i < kCount; ++i) {
        const TriangleMesh link =
            translated(i % 2 == 0 ? lying : standing,
                       {static_cast<float>(kCount * kSpacing / (2 * std::numbers::pi)), 0, 0});
        append(whole, rotated(link, Rotation::about({0, 0, 1}, kTurn * i)));
    }
    return whole;
}

/// A wavy torus of a million faces.
TriangleMesh make_million() {
    TriangleMesh mesh = make_torus(1, 0.4, 1000, 500);
    for (Vec3f& v : mesh.vertices)
        v *= 1 + 0.02F * std::sin(40 * v.x) * std::sin(40 * v.y) * std::sin(40 * v.z);
    return mesh;
}

TriangleMesh make_duplicated() {
    TriangleMesh mesh = turned(make_torus(1, 0.4, 40, 16));
    const std::size_t count = mesh.faces.size();
    for (std::size_t i = 0; i < count; ++i) mesh.faces.push_back(mesh.faces[i]);
    return mesh;
}

TriangleMesh make_overlapping() {
    return joined({make_sphere(1, 40, 20), translated(make_sphere(1, 40, 20), {0.7F, 0.1F, 0}),
                   translated(make_sphere(0.8, 40, 20), {0.3F, -0.6F, 0.2F}), make_box({2.4, 0.5, 0.5}, 4)});
}

TriangleMesh make_inverted() {
    return joined({make_sphere(1, 40, 20),
                   translated(turned_inside_out(make_sphere(1, 40, 20)), {2.5F, 0, 0}),
                   translated(turned_inside_out(make_sphere(0.9, 40, 20)), {0.8F, 0.4F, 0})});
}

/// Two tetrahedra that meet where the centre of the smallest sphere around all is: at a vertex.
TriangleMesh make_centre_on_vertex() {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0},
                     {1, 0, 0},
                     {0.9F, 0.4F, 0.1F},
                     {0.9F, 0.1F, 0.4F},
                     {-1, 0, 0},
                     {-0.9F, -0.4F, -0.1F},
                     {-0.9F, -0.1F, -0.4F}};
    mesh.faces = {{0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3}, {0, 4, 5}, {0, 5, 6}, {0, 6, 4}, {4, 6, 5}};
    return inspect(mesh).signed_volume > 0 ? mesh : turned_inside_out(mesh);
}

/// Two boxes that share an edge, the z axis, on which the centre lies.
TriangleMesh make_centre_on_edge() {
    return joined({translated(make_box({1, 1, 1}), {0.5F, 0.5F, 0}),
                   translated(make_box({1, 1, 1}), {-0.5F, -0.5F, 0})});
}

/// Two boxes that share a side, on which the centre lies: on its diagonal, hence also on an edge of both.
TriangleMesh make_centre_on_face() {
    return joined({translated(make_box({1, 1, 1}, 3), {0.5F, 0, 0}),
                   translated(make_box({1, 1, 1}, 3), {-0.5F, 0, 0})});
}

/// Faces about seventy times as long as wide, aligned with no grid.
TriangleMesh make_slivers() {
    TriangleMesh mesh = make_sphere(1, 600, 4);
    for (Vec3f& vertex : mesh.vertices) vertex.y *= 0.3F;
    return turned(mesh);
}

/// Randomly intersecting tetrahedra, randomly oriented outwards or inwards; every third has a corner within
/// about forty lattice steps of the centre. The octahedron around all keeps the centre there.
TriangleMesh make_tetrahedra() {
    test::PortableRandom random(6);
    const auto within = [&](double half_width) {
        const double x = random.uniform(-half_width, half_width), y = random.uniform(-half_width, half_width);
        return Vec3f(Vec3d{x, y, random.uniform(-half_width, half_width)});
    };
    TriangleMesh whole = make_sphere(1, 4, 2);
    for (int i = 0; i < 45; ++i) {
        TriangleMesh part;
        part.vertices = {within(i % 3 == 0 ? 4e-5 : 0.5), within(0.5), within(0.5), within(0.5)};
        part.faces = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
        append(whole, part);
    }
    return whole;
}

using Maker = TriangleMesh (*)();

const std::vector<std::pair<std::string, Maker>>& makers() {
    static const std::vector<std::pair<std::string, Maker>> kMakers{
        {"torus", [] { return make_torus(1, 0.4, 60, 24); }},
        {"boxes", make_aligned_boxes},
        {"needles", make_needles},
        {"octahedron", [] { return make_sphere(1, 4, 2); }}, // its corners lie at R and on the axes, exactly
        {"star", make_star},
        {"slivers", make_slivers},
        {"tetrahedra", make_tetrahedra},
        {"plate",
         [] {
             return make_box({2, 2, 1e-5}, 8);
         }}, // a few lattice steps thick
        {"thin-plate",
         [] {
             return turned(make_box({2, 2, 1e-6}, 8));
         }}, // less than one
        {"nested", make_nested_spheres},
        {"rings", make_rings},
        {"million", make_million},
        {"duplicated", make_duplicated},
        {"inverted", make_inverted},
        {"overlapping", make_overlapping},
        {"centre-on-vertex", make_centre_on_vertex},
        {"centre-on-edge", make_centre_on_edge},
        {"centre-on-face", make_centre_on_face},
    };
    return kMakers;
}

} // namespace

std::vector<std::string> nasty_mesh_names() {
    std::vector<std::string> names;
    std::ranges::transform(makers(), std::back_inserter(names),
                           [](const auto& maker) { return maker.first; });
    return names;
}

TriangleMesh make_nasty_mesh(const std::string& name) {
    std::string known;
    for (const auto& [maker_name, make] : makers()) {
        if (maker_name == name) return make();
        known += (known.empty() ? "" : ", ") + maker_name;
    }
    throw Error(ErrorCode::InvalidOptions, "no generated mesh is called '" + name + "'; there are " + known);
}

} // namespace echinus::test
