#include "mesh/faces.hpp"
#include "property/shape_checks.hpp"
#include "property/shape_parts.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace echinus::test {

namespace {

constexpr std::size_t kManyFaces = 200; ///< are not multiplied further

Vec3f whole_offset(Choices& choices, int most) {
    const auto coordinate = [&] { return static_cast<float>(choices.between(-most, most)); };
    const float x = coordinate(), y = coordinate();
    return {x, y, coordinate()};
}

std::size_t any_axis(Choices& choices) {
    return choices.below(3);
}

Part with_any_axes(Part part, Choices& choices) {
    std::array<std::size_t, 3> axes{0, 1, 2};
    std::ranges::rotate(axes, axes.begin() + choices.between(0, 2));
    if (choices.chance(0.5)) std::swap(axes[0], axes[1]);
    part.mesh = with_axes(std::move(part.mesh), axes);
    return part;
}

Part oriented_part(Choices& choices) {
    return with_any_axes(random_part(choices), choices);
}

Vec3f middle_of(const TriangleMesh& mesh) {
    const Box box = box_of(mesh);
    return (box.low + box.high) * 0.5F;
}

float coordinate_of(const Vec3f& v, std::size_t axis) {
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

void set_coordinate(Vec3f& v, std::size_t axis, float value) {
    (axis == 0 ? v.x : axis == 1 ? v.y : v.z) = value;
}

// ---- Compositions of parts

/// A polygon's edges, each with one point a prism: the wedges of a cake, or beyond its rim.
Part wedges(Choices& choices) {
    Profile profile = random_profile(choices);
    const GridPoint hub = choices.chance(0.5) ? profile.polygon[choices.below(profile.polygon.size())]
                                              : GridPoint{choices.between(-1, 1), choices.between(-1, 1)};
    const int height = choices.between(1, 4);
    Part whole{{}, profile.name + " cut into wedges"};
    const std::size_t count = profile.polygon.size();
    for (std::size_t i = 0; i < count; ++i) {
        const GridPoint &a = profile.polygon[i], &b = profile.polygon[(i + 1) % count];
        const int area = (a.x - hub.x) * (b.y - hub.y) - (a.y - hub.y) * (b.x - hub.x);
        if (area > 0) append(whole.mesh, extruded({hub, a, b}, height, choices));
        if (area < 0) append(whole.mesh, inside_out(extruded({hub, b, a}, height, choices)));
    }
    return with_any_axes(std::move(whole), choices);
}

Part tetrahedra(Choices& choices) {
    Part part = oriented_part(choices);
    if (part.mesh.faces.size() > kManyFaces) return part;
    const Vec3f apex = choices.chance(0.5) ? middle_of(part.mesh) : choices.one_of(part.mesh.vertices);
    return {cut_into_tetrahedra(part.mesh, apex), part.recipe + " cut into tetrahedra"};
}

/// Where a part has to go so that its box touches another one: in a side, an edge or a corner.
Vec3f beside(const Box& box, const Box& other, Choices& choices) {
    Vec3f offset;
    const std::size_t first = any_axis(choices);
    const std::size_t touching = choices.one_of(std::array<std::size_t, 5>{1, 1, 1, 2, 3});
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t axis = (first + k) % 3;
        const auto low = [&](const Box& b) { return coordinate_of(b.low, axis); };
        const auto high = [&](const Box& b) { return coordinate_of(b.high, axis); };
        const auto middle = [&](const Box& b) { return (low(b) + high(b)) * 0.5F; };
        float shift = low(box) - low(other);
        if (k < touching)
            shift = choices.chance(0.5) ? high(box) - low(other) : low(box) - high(other);
        else if (choices.chance(0.3))
            shift = middle(box) - middle(other);
        else if (choices.chance(0.3))
            shift += static_cast<float>(choices.between(-1, 1));
        set_coordinate(offset, axis, shift);
    }
    return offset;
}

Part side_by_side(Choices& choices) {
    Part whole = oriented_part(choices);
    const int more = choices.between(1, 3);
    for (int i = 0; i < more && whole.mesh.faces.size() < kManyFaces; ++i) {
        const bool same = choices.chance(0.3);
        const Part other = same ? whole : oriented_part(choices);
        const Vec3f offset = beside(box_of(whole.mesh), box_of(other.mesh), choices);
        append(whole.mesh, moved(other.mesh, offset));
        whole.recipe += " beside " + (same ? "its like" : other.recipe);
    }
    return whole;
}

Part scattered(Choices& choices) {
    Part whole = oriented_part(choices);
    const int more = choices.between(1, 3);
    for (int i = 0; i < more && whole.mesh.faces.size() < kManyFaces; ++i) {
        const Part other = oriented_part(choices);
        append(whole.mesh, moved(other.mesh, whole_offset(choices, 3)));
        whole.recipe += " with " + other.recipe;
    }
    return whole;
}

Part nested(Choices& choices) {
    const Part outer = oriented_part(choices);
    const Part inner = choices.chance(0.4) ? outer : oriented_part(choices);
    const bool hollow = choices.chance(0.6);
    const auto factor = static_cast<float>(choices.between(2, 5));
    Part whole{stretched(outer.mesh, {factor, factor, factor}),
               outer.recipe + (hollow ? " with the cavity " : " around ") + inner.recipe};
    Vec3f offset = middle_of(whole.mesh) - middle_of(inner.mesh);
    if (choices.chance(0.4))
        offset = Vec3f(Vec3d{std::floor(offset.x), std::floor(offset.y), std::floor(offset.z)});
    append(whole.mesh, moved(hollow ? inside_out(inner.mesh) : inner.mesh, offset));
    return whole;
}

Part doubled(Choices& choices) {
    Part whole = oriented_part(choices);
    const Part copy = whole;
    append(whole.mesh, copy.mesh);
    whole.recipe += ", doubled";
    if (choices.chance(0.5)) {
        const Part other = oriented_part(choices);
        append(whole.mesh, moved(other.mesh, whole_offset(choices, 3)));
        whole.recipe += ", with " + other.recipe;
    }
    return whole;
}

/// Copies in a row whose boxes overlap, touch or stay apart.
Part in_a_row(Part part, Choices& choices) {
    const std::size_t axis = any_axis(choices);
    const float pitch = coordinate_of(box_of(part.mesh).size(), axis) *
                        choices.one_of(std::array<float, 5>{0.5F, 1, 1, 1, 1.5F});
    const int count = choices.between(2, 4);
    const TriangleMesh one = part.mesh;
    for (int i = 1; i < count; ++i) {
        Vec3f offset;
        set_coordinate(offset, axis, pitch * static_cast<float>(i));
        append(part.mesh, moved(one, offset));
    }
    part.recipe += ", " + std::to_string(count) + " in a row";
    return part;
}

/// Together with its image in a coordinate plane, the plane of its own side, or a diagonal plane.
Part with_image(Part part, Choices& choices) {
    const std::size_t axis = any_axis(choices);
    if (choices.chance(0.5)) {
        Vec3f offset;
        set_coordinate(offset, axis, -coordinate_of(box_of(part.mesh).low, axis));
        part.mesh = moved(std::move(part.mesh), offset);
    }
    std::array<std::size_t, 3> axes{0, 1, 2};
    std::swap(axes[axis], axes[(axis + 1) % 3]);
    append(part.mesh, choices.chance(0.7) ? mirrored(part.mesh, axis) : with_axes(part.mesh, axes));
    part.recipe += ", with its image";
    return part;
}

Part assembly(Choices& choices) {
    using Maker = Part (*)(Choices&);
    static constexpr Maker kMakers[] = {oriented_part, oriented_part, oriented_part, wedges,
                                        wedges,        tetrahedra,    side_by_side,  side_by_side,
                                        scattered,     scattered,     nested,        doubled};
    Part part = choices.one_of(kMakers)(choices);
    if (choices.chance(0.15) && part.mesh.faces.size() < kManyFaces)
        part = in_a_row(std::move(part), choices);
    if (choices.chance(0.2) && part.mesh.faces.size() < kManyFaces)
        part = with_image(std::move(part), choices);
    return part;
}

// ---- Changes of the whole

void turn(Part& part, Choices& choices) {
    const double kind = choices.within(0, 1);
    if (kind < 0.6) return;
    if (kind < 0.8) {
        part.mesh = turned_by_eighth(std::move(part.mesh), any_axis(choices));
        part.recipe += ", turned by 45 degrees";
        if (choices.chance(0.5)) part.mesh = turned_by_eighth(std::move(part.mesh), any_axis(choices));
        return;
    }
    const Vec3d axis{choices.within(-1, 1), choices.within(-1, 1), 1.5};
    const Rotation rotation = Rotation::about(kind < 0.9 ? Vec3d{0, 0, 1} : axis, choices.within(-3, 3));
    for (Vec3f& v : part.mesh.vertices) v = Vec3f(rotation.apply(Vec3d(v)));
    part.recipe += kind < 0.9 ? ", turned about an axis" : ", turned at random";
}

void change_faces(Part& part, Choices& choices) {
    if (choices.chance(0.15) && part.mesh.faces.size() < kManyFaces) {
        part.mesh = subdivided(std::move(part.mesh), choices);
        part.recipe += ", subdivided";
    }
    if (choices.chance(0.5)) {
        part.mesh = weld(part.mesh);
        part.recipe += ", welded";
    }
    if (choices.chance(0.3)) part.mesh = shuffled(std::move(part.mesh), choices);
    if (choices.chance(0.05)) {
        part.mesh = inside_out(std::move(part.mesh));
        part.recipe += ", inside out";
    }
}

void flatten(Part& part, Choices& choices) {
    if (!choices.chance(0.1)) return;
    const int power = choices.between(1, 20);
    Vec3f factors{1, 1, 1};
    set_coordinate(factors, any_axis(choices), std::ldexp(1.0F, -power));
    part.mesh = stretched(std::move(part.mesh), factors);
    part.recipe += ", flattened by 2^" + std::to_string(power);
}

double power_of_ten(int exponent) {
    double power = 1;
    for (int i = 0; i < std::abs(exponent); ++i) power *= 10;
    return exponent < 0 ? 1 / power : power;
}

/// Scales and moves in double, and rounds once.
void place(Part& part, Choices& choices) {
    double scale = 1;
    if (choices.chance(0.3)) {
        const int exponent = choices.between(-12, 12);
        scale = power_of_ten(exponent);
        part.recipe += ", scaled by 1e" + std::to_string(exponent);
    }
    Vec3d offset;
    if (choices.chance(0.4)) {
        const int exponent = choices.chance(0.5) ? 0 : choices.between(1, 5);
        offset = Vec3d(whole_offset(choices, 20)) * power_of_ten(exponent);
        part.recipe += ", moved by up to 20e" + std::to_string(exponent);
    }
    for (Vec3f& v : part.mesh.vertices) v = Vec3f((Vec3d(v) + offset) * scale);
}

} // namespace

Shape make_shape(std::uint64_t seed) {
    Choices choices(seed);
    Part part = assembly(choices);
    change_faces(part, choices);
    turn(part, choices);
    flatten(part, choices);
    place(part, choices);
    return {seed, part.recipe, part.mesh};
}

namespace {

class Shrinker {
  public:
    Shrinker(ShapeFindings::Failure failure, ShapeCheck check)
        : failure_(std::move(failure)), check_(check) {}

    TriangleMesh run(TriangleMesh mesh) {
        bool has_shrunk = true;
        while (has_shrunk) {
            has_shrunk = drop_parts(mesh);
            has_shrunk = join_vertices(mesh) || has_shrunk;
        }
        round_coordinates(mesh);
        replace_if_fails(mesh, weld(mesh));
        return mesh;
    }

  private:
    bool fails(const TriangleMesh& mesh) {
        if (mesh.faces.empty() || tries_ == 0) return false;
        --tries_;
        ShapeFindings findings;
        check_(mesh, failure_.seed, findings);
        return !findings.failures.empty() && findings.failures.front().kind == failure_.kind;
    }
    bool replace_if_fails(TriangleMesh& mesh, TriangleMesh candidate) {
        if (!fails(candidate)) return false;
        mesh = std::move(candidate);
        return true;
    }

    bool drop_parts(TriangleMesh& mesh) {
        bool has_shrunk = false;
        for (std::size_t part = 0;; ++part) {
            const Components components = find_components(mesh);
            if (components.count < 2 || part >= components.count) return has_shrunk;
            TriangleMesh rest{mesh.vertices, {}};
            for (std::size_t face = 0; face < mesh.faces.size(); ++face)
                if (components.of_face[face] != part) rest.faces.push_back(mesh.faces[face]);
            if (!replace_if_fails(mesh, std::move(rest))) continue;
            has_shrunk = true;
            --part;
        }
    }

    /// A closed mesh stays closed when two of its vertices become one.
    static TriangleMesh joined(const TriangleMesh& mesh, std::uint32_t from, std::uint32_t to) {
        TriangleMesh result{mesh.vertices, {}};
        for (Triangle face : mesh.faces) {
            std::ranges::replace(face, from, to);
            if (face[0] != face[1] && face[1] != face[2] && face[2] != face[0]) result.faces.push_back(face);
        }
        return result;
    }

    bool join_vertices(TriangleMesh& mesh) {
        for (std::size_t face = 0; face < mesh.faces.size(); ++face)
            for (std::size_t k = 0; k < 3; ++k)
                if (replace_if_fails(mesh, joined(mesh, mesh.faces[face][k], mesh.faces[face][(k + 1) % 3])))
                    return true;
        return false;
    }

    /// To the fewest binary places that still fail, in units of a power of two about as large as the mesh.
    void round_coordinates(TriangleMesh& mesh) {
        float largest = 0;
        for (const Vec3f& v : mesh.vertices)
            largest = std::max({largest, std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
        const int exponent = std::ilogb(largest);
        for (int places = 2; places < 20; ++places) {
            const auto rounded = [&](float x) { return std::round(std::ldexp(x, places - exponent)); };
            TriangleMesh candidate = mesh;
            for (Vec3f& v : candidate.vertices) v = {rounded(v.x), rounded(v.y), rounded(v.z)};
            if (replace_if_fails(mesh, std::move(candidate))) return;
        }
    }

    ShapeFindings::Failure failure_;
    ShapeCheck check_;
    int tries_ = 3000;
};

} // namespace

TriangleMesh shrunk(TriangleMesh mesh, const ShapeFindings::Failure& failure, ShapeCheck check) {
    return Shrinker(failure, check).run(std::move(mesh));
}

std::string obj_text(const TriangleMesh& mesh) {
    std::vector<std::size_t> number(mesh.vertices.size()); // from 1; 0: not used so far
    std::size_t count = 0;
    std::string vertices, faces;
    for (const Triangle& face : mesh.faces) {
        faces += "f";
        for (const std::uint32_t corner : face) {
            const Vec3f& v = mesh.vertices[corner];
            if (number[corner] == 0) {
                number[corner] = ++count;
                vertices +=
                    "v " + shortest_text(v.x) + " " + shortest_text(v.y) + " " + shortest_text(v.z) + "\n";
            }
            faces += " " + std::to_string(number[corner]);
        }
        faces += "\n";
    }
    return vertices + faces;
}

} // namespace echinus::test
