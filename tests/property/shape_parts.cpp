#include "property/shape_parts.hpp"

#include "geometry/elementary.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

namespace echinus::test {

namespace {

/// Twice the area of a triangle, positive when counter-clockwise.
int area(const GridPoint& a, const GridPoint& b, const GridPoint& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

bool same(const GridPoint& a, const GridPoint& b) {
    return a.x == b.x && a.y == b.y;
}

Vec3f at_height(const GridPoint& p, int z) {
    return Vec3f(Vec3d{double(p.x), double(p.y), double(z)});
}

/// May the corner in the middle be cut off?
bool is_ear(const Polygon& polygon, const std::vector<std::uint32_t>& ring, std::size_t middle) {
    const std::size_t count = ring.size();
    const GridPoint &a = polygon[ring[(middle + count - 1) % count]], &b = polygon[ring[middle]],
                    &c = polygon[ring[(middle + 1) % count]];
    if (area(a, b, c) <= 0) return false;
    return std::ranges::none_of(ring, [&](std::uint32_t other) {
        const GridPoint& p = polygon[other];
        return !same(p, a) && !same(p, b) && !same(p, c) && area(a, b, p) >= 0 && area(b, c, p) >= 0 &&
               area(c, a, p) >= 0;
    });
}

/// Two faces of a quadrilateral, by either diagonal.
void add_quad(TriangleMesh& mesh, const std::array<std::uint32_t, 4>& corners, Choices& choices) {
    const std::size_t first = choices.below(2);
    const auto corner = [&](std::size_t k) { return corners[(first + k) % 4]; };
    mesh.faces.push_back({corner(0), corner(1), corner(2)});
    mesh.faces.push_back({corner(0), corner(2), corner(3)});
}

std::uint32_t index_of(std::size_t i) {
    return static_cast<std::uint32_t>(i);
}

// ---- Profiles

Polygon rectangle(int x, int y) {
    return {{0, 0}, {x, 0}, {x, y}, {0, y}};
}

Polygon centred_square(int half) {
    return {{-half, -half}, {half, -half}, {half, half}, {-half, half}};
}

Polygon octagon(int half, int corner) {
    return {{-half, -corner}, {-corner, -half}, {corner, -half}, {half, -corner},
            {half, corner},   {corner, half},   {-corner, half}, {-half, corner}};
}

/// Corners on some of the eight rays by 45 degrees from the origin, at random distances: few of them are
/// convex, and their planes pass through the origin or beside it.
Polygon star(Choices& choices) {
    static constexpr GridPoint kRays[] = {{1, 0},  {1, 1},   {0, 1},  {-1, 1},
                                          {-1, 0}, {-1, -1}, {0, -1}, {1, -1}};
    const int step = choices.chance(0.3) ? 2 : 1;
    Polygon polygon;
    for (std::size_t i = 0; i < std::size(kRays); i += static_cast<std::size_t>(step)) {
        const int reach = choices.between(1, 4);
        polygon.push_back({kRays[i].x * reach, kRays[i].y * reach});
    }
    return polygon;
}

/// A disc of eight sides without a wedge of 45, 90 or 135 degrees, whose sides meet in the middle.
Polygon open_mouth(Choices& choices) {
    const int size = choices.between(1, 4);
    const Polygon rim{{size, 0},  {size, size},   {0, size},  {-size, size},
                      {-size, 0}, {-size, -size}, {0, -size}, {size, -size}};
    Polygon polygon{{0, 0}};
    polygon.insert(polygon.end(), rim.begin() + choices.between(0, 2), rim.end());
    return polygon;
}

/// Drops corners on the line between their neighbours, and doubled ones.
Polygon without_straight_corners(Polygon polygon) {
    for (std::size_t i = 0; i < polygon.size() && polygon.size() > 3;) {
        const std::size_t count = polygon.size();
        if (area(polygon[(i + count - 1) % count], polygon[i], polygon[(i + 1) % count]) == 0) {
            polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(i));
            i = 0;
        } else
            ++i;
    }
    return polygon;
}

/// A square or octagon with a smaller one cut out, as one polygon with a cut from hole to rim.
Polygon with_hole(Choices& choices) {
    const int half = choices.between(2, 5);
    const int inner = choices.between(1, half - 1);
    Polygon rim = choices.chance(0.5) ? centred_square(half) : octagon(half, choices.between(1, half));
    Polygon hole = choices.chance(0.5) ? centred_square(inner) : octagon(inner, choices.between(0, inner));
    if (choices.chance(0.3)) hole = Polygon{{0, -inner}, {inner, 0}, {0, inner}, {-inner, 0}};
    hole = without_straight_corners(hole);
    rim = without_straight_corners(rim);
    std::ranges::reverse(hole);
    // Both are convex: the hole's rightmost corner sees every corner of the rim that is farther right.
    const auto by_x = [](const GridPoint& a, const GridPoint& b) { return a.x < b.x; };
    std::ranges::rotate(hole, std::ranges::max_element(hole, by_x));
    std::ranges::rotate(rim, std::ranges::max_element(rim, by_x));
    Polygon polygon = rim;
    polygon.push_back(rim.front());
    polygon.insert(polygon.end(), hole.begin(), hole.end());
    polygon.push_back(hole.front());
    return polygon;
}

// ---- Solids

TriangleMesh box(int x, int y, int z, Choices& choices) {
    return extruded(rectangle(x, y), z, choices);
}

TriangleMesh octahedron(int x, int y, int z) {
    TriangleMesh mesh;
    const auto a = static_cast<float>(x), b = static_cast<float>(y), c = static_cast<float>(z);
    mesh.vertices = {{a, 0, 0}, {0, b, 0}, {-a, 0, 0}, {0, -b, 0}, {0, 0, c}, {0, 0, -c}};
    for (std::uint32_t i = 0; i < 4; ++i) {
        mesh.faces.push_back({i, (i + 1) % 4, 4});
        mesh.faces.push_back({(i + 1) % 4, i, 5});
    }
    return mesh;
}

/// Any four points of the grid that do not lie in a plane.
TriangleMesh tetrahedron(Choices& choices) {
    while (true) {
        TriangleMesh mesh;
        for (int i = 0; i < 4; ++i) {
            const GridPoint place{choices.between(0, 4), choices.between(0, 4)};
            mesh.vertices.push_back(at_height(place, choices.between(0, 4)));
        }
        const auto& v = mesh.vertices;
        const float volume = dot(cross(v[1] - v[0], v[2] - v[0]), v[3] - v[0]);
        if (volume == 0) continue;
        mesh.faces = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
        return volume > 0 ? mesh : inside_out(mesh);
    }
}

/// Cubes of a grid of 3 x 3 x 3, filled by chance: they touch in faces, edges and corners and may enclose
/// cavities. Faces between two of them vanish; all corners are shared.
TriangleMesh polycube(Choices& choices) {
    std::set<std::array<int, 3>> filled;
    const int extent = choices.between(2, 3);
    const double density = choices.within(0.15, 0.9);
    for (int x = 0; x < extent; ++x)
        for (int y = 0; y < extent; ++y)
            for (int z = 0; z < extent; ++z)
                if (choices.chance(density)) filled.insert({x, y, z});
    filled.insert({0, 0, 0});
    TriangleMesh mesh;
    std::map<std::array<int, 3>, std::uint32_t> numbers;
    const auto vertex = [&](const std::array<int, 3>& p) {
        const auto [place, is_new] = numbers.try_emplace(p, index_of(mesh.vertices.size()));
        if (is_new) mesh.vertices.push_back(at_height({p[0], p[1]}, p[2]));
        return place->second;
    };
    for (const std::array<int, 3>& cube : filled)
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (const int side : {0, 1}) {
                std::array<int, 3> neighbour = cube;
                neighbour[axis] += 2 * side - 1;
                if (filled.contains(neighbour)) continue;
                const auto corner = [&](int u, int v) {
                    std::array<int, 3> p = cube;
                    p[axis] += side;
                    p[(axis + 1) % 3] += u;
                    p[(axis + 2) % 3] += v;
                    return vertex(p);
                };
                std::array<std::uint32_t, 4> square{corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
                if (side == 0) std::swap(square[1], square[3]);
                add_quad(mesh, square, choices);
            }
    return mesh;
}

Part revolved_part(Choices& choices) {
    static constexpr std::uint32_t kSides[] = {3, 4, 4, 5, 6, 8, 8, 12};
    const std::uint32_t sides = choices.one_of(kSides);
    const int radius = choices.between(1, 4), height = choices.between(1, 5);
    const std::string around = " of " + std::to_string(sides) + " sides";
    const auto made = [&](const char* name, const Polygon& profile) {
        return Part{revolved(profile, sides, choices), name + around};
    };
    switch (choices.between(0, 5)) {
    case 0:
        return made("cylinder", {{0, 0}, {radius, 0}, {radius, height}, {0, height}});
    case 1:
        return made("cone", {{0, 0}, {radius, 0}, {0, height}});
    case 2:
        return made("sphere",
                    {{0, -2 * radius}, {2 * radius, -radius}, {2 * radius, radius}, {0, 2 * radius}});
    case 3:
        return made("ring", {{radius, 0}, {radius + height, 0}, {radius + height, 1}, {radius, 1}});
    case 4:
        return made("torus", {{radius, 0}, {radius + 1, -1}, {radius + 2, 0}, {radius + 1, 1}});
    default:
        return made("spindle", {{0, 0}, {radius, height}, {1, height}, {0, 2 * height}});
    }
}

} // namespace

Profile random_profile(Choices& choices) {
    const int a = choices.between(1, 4), b = choices.between(1, 4), t = choices.between(1, 2);
    switch (choices.between(0, 11)) {
    case 0:
        return {rectangle(a, b), "rectangle"};
    case 1:
        return {centred_square(a), "square"};
    case 2:
        return {{{0, 0}, {a, 0}, {0, b}}, "right triangle"};
    case 3:
        return {{{-a, 0}, {a, 0}, {0, b}}, "isosceles triangle"};
    case 4:
        return {{{0, -a}, {b, 0}, {0, a}, {-b, 0}}, "diamond"};
    case 5:
        return {without_straight_corners(octagon(a + 1, choices.between(1, a + 1))), "octagon"};
    case 6:
        return {{{0, 0}, {a + t, 0}, {a + t, t}, {t, t}, {t, b + t}, {0, b + t}}, "L"};
    case 7:
        return {{{-t, 0}, {t, 0}, {t, b}, {a + t, b}, {a + t, b + t}, {-a - t, b + t}, {-a - t, b}, {-t, b}},
                "T"};
    case 8:
        return {{{-a - t, 0},
                 {a + t, 0},
                 {a + t, b + t},
                 {a, b + t},
                 {a, t},
                 {-a, t},
                 {-a, b + t},
                 {-a - t, b + t}},
                "U"};
    case 9:
        return {open_mouth(choices), "open mouth"};
    case 10:
        return {with_hole(choices), "plate with a hole"};
    default:
        return {star(choices), "star"};
    }
}

std::vector<Triangle> triangulate(const Polygon& polygon, Choices& choices) {
    std::vector<std::uint32_t> ring(polygon.size());
    std::iota(ring.begin(), ring.end(), 0U);
    std::ranges::rotate(ring, ring.begin() + static_cast<std::ptrdiff_t>(choices.below(ring.size())));
    std::vector<Triangle> triangles;
    while (ring.size() >= 3) {
        std::size_t ear = 0;
        while (ear < ring.size() && !is_ear(polygon, ring, ear)) ++ear;
        ear %= ring.size(); // what is left has no area: any corner will do, for the outline stays the same
        const std::size_t count = ring.size();
        triangles.push_back({ring[(ear + count - 1) % count], ring[ear], ring[(ear + 1) % count]});
        ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    return triangles;
}

TriangleMesh extruded(const Polygon& polygon, int height, Choices& choices) {
    TriangleMesh mesh;
    const std::uint32_t count = index_of(polygon.size());
    for (const int z : {0, height})
        for (const GridPoint& p : polygon) mesh.vertices.push_back(at_height(p, z));
    for (const auto& [a, b, c] : triangulate(polygon, choices)) mesh.faces.push_back({a, c, b});
    for (const auto& [a, b, c] : triangulate(polygon, choices))
        mesh.faces.push_back({a + count, b + count, c + count});
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t next = (i + 1) % count;
        add_quad(mesh, {i, next, next + count, i + count}, choices);
    }
    return mesh;
}

TriangleMesh tapered_to(const Polygon& polygon, const Vec3f& apex, Choices& choices) {
    TriangleMesh mesh;
    for (const GridPoint& p : polygon) mesh.vertices.push_back(at_height(p, 0));
    const std::uint32_t count = index_of(polygon.size());
    mesh.vertices.push_back(apex);
    for (const auto& [a, b, c] : triangulate(polygon, choices)) mesh.faces.push_back({a, c, b});
    for (std::uint32_t i = 0; i < count; ++i) mesh.faces.push_back({i, (i + 1) % count, count});
    return apex.z > 0 ? mesh : inside_out(mesh);
}

TriangleMesh revolved(const Polygon& profile, std::uint32_t sides, Choices& choices) {
    TriangleMesh mesh;
    std::vector<std::uint32_t> first(profile.size()); // vertex of a point at the first side
    for (std::size_t i = 0; i < profile.size(); ++i) {
        const auto& [radius, z] = profile[i];
        first[i] = index_of(mesh.vertices.size());
        for (std::uint32_t side = 0; side < (radius == 0 ? 1 : sides); ++side) {
            const CirclePoint p = circle_point(side, sides);
            mesh.vertices.push_back(Vec3f(Vec3d{radius * p.cosine, radius * p.sine, double(z)}));
        }
    }
    const auto vertex = [&](std::size_t point, std::uint32_t side) {
        return first[point] + (profile[point].x == 0 ? 0 : side % sides);
    };
    for (std::size_t i = 0; i < profile.size(); ++i) {
        const std::size_t next = (i + 1) % profile.size();
        if (profile[i].x == 0 && profile[next].x == 0) continue;
        for (std::uint32_t side = 0; side < sides; ++side) {
            const std::array<std::uint32_t, 4> quad{vertex(i, side), vertex(i, side + 1),
                                                    vertex(next, side + 1), vertex(next, side)};
            if (profile[i].x == 0)
                mesh.faces.push_back({quad[0], quad[2], quad[3]});
            else if (profile[next].x == 0)
                mesh.faces.push_back({quad[0], quad[1], quad[2]});
            else
                add_quad(mesh, quad, choices);
        }
    }
    return mesh;
}

Part random_part(Choices& choices) {
    const int a = choices.between(1, 4), b = choices.between(1, 4), c = choices.between(1, 4);
    switch (choices.between(0, 9)) {
    case 0:
    case 1:
        return {box(a, b, c, choices), "box"};
    case 2:
        return {box(2 * a + 2, 2 * b + 2, 1, choices), "plate"};
    case 3:
    case 4: {
        const Profile profile = random_profile(choices);
        return {extruded(profile.polygon, c, choices), "extruded " + profile.name};
    }
    case 5: {
        const Profile profile = random_profile(choices);
        const GridPoint place{choices.between(-2, 2), choices.between(-2, 2)};
        const Vec3f apex = at_height(place, choices.chance(0.2) ? -c : c);
        return {tapered_to(profile.polygon, apex, choices), "pyramid over " + profile.name};
    }
    case 6:
        return {tetrahedron(choices), "tetrahedron"};
    case 7:
        return {choices.chance(0.5) ? octahedron(a, a, a) : octahedron(a, b, c), "octahedron"};
    case 8:
        return {polycube(choices), "polycube"};
    default:
        return revolved_part(choices);
    }
}

void append(TriangleMesh& whole, const TriangleMesh& part) {
    const std::uint32_t offset = index_of(whole.vertices.size());
    whole.vertices.insert(whole.vertices.end(), part.vertices.begin(), part.vertices.end());
    for (const auto& [a, b, c] : part.faces) whole.faces.push_back({a + offset, b + offset, c + offset});
}

TriangleMesh inside_out(TriangleMesh mesh) {
    for (Triangle& face : mesh.faces) std::swap(face[1], face[2]);
    return mesh;
}

TriangleMesh with_axes(TriangleMesh mesh, const std::array<std::size_t, 3>& axes) {
    for (Vec3f& v : mesh.vertices) {
        const std::array<float, 3> old{v.x, v.y, v.z};
        v = {old[axes[0]], old[axes[1]], old[axes[2]]};
    }
    const bool is_even = (axes[1] + 3 - axes[0]) % 3 == 1;
    return is_even ? mesh : inside_out(mesh);
}

TriangleMesh mirrored(TriangleMesh mesh, std::size_t axis) {
    Vec3f factors{1, 1, 1};
    (axis == 0 ? factors.x : axis == 1 ? factors.y : factors.z) = -1;
    return inside_out(stretched(std::move(mesh), factors));
}

TriangleMesh moved(TriangleMesh mesh, const Vec3f& offset) {
    for (Vec3f& v : mesh.vertices) v += offset;
    return mesh;
}

TriangleMesh stretched(TriangleMesh mesh, const Vec3f& factors) {
    for (Vec3f& v : mesh.vertices) v = {v.x * factors.x, v.y * factors.y, v.z * factors.z};
    return mesh;
}

TriangleMesh turned_by_eighth(TriangleMesh mesh, std::size_t axis) {
    for (Vec3f& v : mesh.vertices) {
        std::array<float, 3> p{v.x, v.y, v.z};
        float &x = p[(axis + 1) % 3], &y = p[(axis + 2) % 3];
        std::tie(x, y) = std::pair(x - y, x + y);
        v = {p[0], p[1], p[2]};
    }
    return mesh;
}

TriangleMesh cut_into_tetrahedra(const TriangleMesh& mesh, const Vec3f& apex) {
    TriangleMesh whole;
    for (const auto& [a, b, c] : mesh.faces) {
        const TriangleMesh part{{mesh.vertices[a], mesh.vertices[b], mesh.vertices[c], apex},
                                {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}};
        append(whole, part);
    }
    return whole;
}

TriangleMesh subdivided(TriangleMesh mesh, Choices& choices) {
    // Even coordinates, so that middles are whole.
    mesh = stretched(std::move(mesh), {4, 4, 4});
    using Edge = std::pair<std::uint32_t, std::uint32_t>;
    std::map<Edge, std::uint32_t> middles;
    const double share = choices.within(0.05, 1);
    for (const Triangle& face : mesh.faces)
        for (std::size_t k = 0; k < 3; ++k) {
            const Edge edge = std::minmax(face[k], face[(k + 1) % 3]);
            if (middles.contains(edge) || !choices.chance(share)) continue;
            middles[edge] = index_of(mesh.vertices.size());
            mesh.vertices.push_back((mesh.vertices[edge.first] + mesh.vertices[edge.second]) * 0.5F);
        }
    TriangleMesh result{mesh.vertices, {}};
    for (const Triangle& face : mesh.faces) {
        std::vector<std::uint32_t> outline;
        for (std::size_t k = 0; k < 3; ++k) {
            outline.push_back(face[k]);
            const auto middle = middles.find(std::minmax(face[k], face[(k + 1) % 3]));
            if (middle != middles.end()) outline.push_back(middle->second);
        }
        const Vec3f &a = mesh.vertices[face[0]], &b = mesh.vertices[face[1]], &c = mesh.vertices[face[2]];
        const std::uint32_t hub = index_of(result.vertices.size());
        result.vertices.push_back((a * 2 + b + c) * 0.25F);
        for (std::size_t i = 0; i < outline.size(); ++i)
            result.faces.push_back({outline[i], outline[(i + 1) % outline.size()], hub});
    }
    return result;
}

TriangleMesh shuffled(TriangleMesh mesh, Choices& choices) {
    for (std::size_t i = mesh.faces.size(); i > 1; --i)
        std::swap(mesh.faces[i - 1], mesh.faces[choices.below(i)]);
    for (Triangle& face : mesh.faces) std::ranges::rotate(face, face.begin() + choices.between(0, 2));
    return mesh;
}

Box box_of(const TriangleMesh& mesh) {
    Box box{mesh.vertices.front(), mesh.vertices.front()};
    for (const Vec3f& v : mesh.vertices) {
        box.low = {std::min(box.low.x, v.x), std::min(box.low.y, v.y), std::min(box.low.z, v.z)};
        box.high = {std::max(box.high.x, v.x), std::max(box.high.y, v.y), std::max(box.high.z, v.z)};
    }
    return box;
}

} // namespace echinus::test
