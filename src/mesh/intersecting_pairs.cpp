#include "mesh/intersecting_pairs.hpp"

#include "geometry/box_tree.hpp"
#include "mesh/simplices_meet.hpp"

#include <echinus/error.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

namespace echinus {

namespace {

BoxTree tree_of_faces(const TriangleMesh& mesh) {
    std::vector<BoxTree::Box> boxes(mesh.faces.size());
    for (std::size_t i = 0; i < boxes.size(); ++i)
        for (const std::uint32_t vertex : mesh.faces[i]) boxes[i].add(mesh.vertices[vertex]);
    return BoxTree(boxes);
}

bool has(const Triangle& face, std::uint32_t vertex) {
    return face[0] == vertex || face[1] == vertex || face[2] == vertex;
}

int longest_component(const Vec3d& v) {
    const double x = std::abs(v.x), y = std::abs(v.y), z = std::abs(v.z);
    if (x > y && x > z) return 0;
    return y > z ? 1 : 2;
}

/// Does the line through v and e, with `own` on one side, separate triangle v e own from triangle v p q
/// except at v?
bool edge_parts(const Point2& v, const Point2& e, const Point2& own, const Point2& p, const Point2& q) {
    const int side = orientation(v, e, own);
    const auto beyond = [&](const Point2& point) {
        const int point_side = orientation(v, e, point);
        if (point_side != 0) return point_side != side;
        // On the line: does the point lie beyond v, seen from e?
        return (e.x < v.x && v.x < point.x) || (e.x > v.x && v.x > point.x) || (e.y < v.y && v.y < point.y) ||
               (e.y > v.y && v.y > point.y);
    };
    return side != 0 && beyond(p) && beyond(q);
}

/// Two faces with common vertices, whose corners are sorted with the common ones first. Equal vertices of one
/// face are kept.
struct Neighbours {
    const TriangleMesh& mesh;
    Triangle a, b;
    int a_shared = 0, b_shared = 0; ///< how many corners of each are common

    Neighbours(const TriangleMesh& of, const Triangle& first, const Triangle& second)
        : mesh(of), a(first), b(second) {
        for (int i = 0; i < 3; ++i)
            if (has(second, a[i])) std::swap(a[i], a[a_shared++]);
        for (int i = 0; i < 3; ++i)
            if (has(first, b[i])) std::swap(b[i], b[b_shared++]);
    }

    const Vec3f& at_a(int corner) const { return mesh.vertices[a[corner]]; }
    const Vec3f& at_b(int corner) const { return mesh.vertices[b[corner]]; }

    /// The other two corners lie on different sides of the edge's line, or the faces are not coplanar.
    bool only_share_an_edge() const {
        const Vec3f &u = at_a(0), &v = at_a(1), &p = at_a(2), &q = at_b(2);
        if (orientation(u, v, p, q) != 0) return true;
        const auto axis = axis_that_shows(u, v, p);
        if (!axis) return false;
        const auto side = [&](const Vec3f& point) {
            return orientation(seen_along(*axis, u), seen_along(*axis, v), seen_along(*axis, point));
        };
        return side(p) * side(q) < 0;
    }

    /// Seen along an axis, a line through the common corner and along an edge separates the faces.
    bool only_share_a_corner() const {
        const Vec3d corner(at_a(0));
        const int axis = longest_component(cross(Vec3d(at_a(1)) - corner, Vec3d(at_a(2)) - corner));
        const auto seen = [axis](const Vec3f& p) { return seen_along(axis, p); };
        const Point2 v = seen(at_a(0)), a_1 = seen(at_a(1)), a_2 = seen(at_a(2)), b_1 = seen(at_b(1)),
                     b_2 = seen(at_b(2));
        return edge_parts(v, a_1, a_2, b_1, b_2) || edge_parts(v, a_2, a_1, b_1, b_2) ||
               edge_parts(v, b_1, b_2, a_1, a_2) || edge_parts(v, b_2, b_1, a_1, a_2);
    }

    /// Tests the largest parts of both faces that have no common vertex: each common vertex is assigned to
    /// one of the faces.
    bool parts_meet() const {
        for (unsigned choice = 0; choice < 1U << a_shared; ++choice) {
            Simplex a_part, b_part;
            for (int i = 0; i < 3; ++i)
                if (i >= a_shared || goes_to_a(i, choice)) a_part.push_back(at_a(i));
            for (int j = 0; j < 3; ++j)
                if (j >= b_shared || !goes_to_a(shared_index(b[j]), choice)) b_part.push_back(at_b(j));
            if (a_part.count != 0 && b_part.count != 0 && simplices_meet(a_part, b_part)) return true;
        }
        return false;
    }

  private:
    int shared_index(std::uint32_t vertex) const {
        return static_cast<int>(std::find(a.begin(), a.end(), vertex) - a.begin());
    }
    bool goes_to_a(int i, unsigned choice) const { return (choice >> shared_index(a[i]) & 1) != 0; }
};

bool intersect_beyond_shared(const TriangleMesh& mesh, const Triangle& a, const Triangle& b) {
    const Neighbours pair(mesh, a, b);
    if (pair.a_shared == 3 && pair.b_shared == 3) return true;
    if (pair.a_shared == 2 && pair.b_shared == 2 && pair.only_share_an_edge()) return false;
    if (pair.a_shared == 1 && pair.b_shared == 1 && pair.only_share_a_corner()) return false;
    return pair.parts_meet();
}

/// Pairs in the order in which a tree finds them, to be sorted afterwards.
class FoundPairs {
  public:
    explicit FoundPairs(std::size_t most) : most_(most) {}

    void add(std::uint32_t a, std::uint32_t b) {
        if (pairs_.size() == most_)
            throw Error(ErrorCode::InvalidMesh,
                        "more than " + std::to_string(most_) +
                            " pairs of faces intersect, as where surfaces lie on each other; check parts");
        pairs_.push_back({a, b});
    }

    std::vector<FacePair> sorted() && {
        // Compares single numbers: comparing one member after the other would branch.
        const auto number = [](const FacePair& pair) { return std::uint64_t{pair.a} << 32 | pair.b; };
        std::sort(pairs_.begin(), pairs_.end(),
                  [&](const FacePair& p, const FacePair& q) { return number(p) < number(q); });
        return std::move(pairs_);
    }

  private:
    std::size_t most_;
    std::vector<FacePair> pairs_;
};

Simplex simplex_of(const TriangleMesh& mesh, std::uint32_t face) {
    const auto [a, b, c] = mesh.faces[face];
    return {{mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]}, 3};
}

} // namespace

bool triangles_intersect(const std::array<Vec3f, 3>& a, const std::array<Vec3f, 3>& b) noexcept {
    return std::all_of(a.begin(), a.end(), is_finite<float>) &&
           std::all_of(b.begin(), b.end(), is_finite<float>) && simplices_meet({a, 3}, {b, 3});
}

std::vector<FacePair> intersecting_pairs(const TriangleMesh& a, const TriangleMesh& b, std::size_t most) {
    require_valid(a);
    require_valid(b);
    if (a.origin != b.origin)
        throw Error(ErrorCode::InvalidMesh, "the meshes have different origins; move the vertices of one to "
                                            "the other's frame first");
    BoxTree a_tree = tree_of_faces(a), b_tree = tree_of_faces(b);
    FoundPairs found(most);
    for_each_overlap(a_tree, 0, b_tree, 0, [&](std::uint32_t p, std::uint32_t q) {
        if (simplices_meet(simplex_of(a, p), simplex_of(b, q))) found.add(p, q);
    });
    return std::move(found).sorted();
}

std::vector<FacePair> self_intersecting_pairs(const TriangleMesh& mesh, std::size_t most) {
    require_valid(mesh);
    BoxTree tree = tree_of_faces(mesh);
    FoundPairs found(most);
    for_each_overlap(tree, 0, [&](std::uint32_t p, std::uint32_t q) {
        if (intersect_beyond_shared(mesh, mesh.faces[p], mesh.faces[q]))
            found.add(std::min(p, q), std::max(p, q));
    });
    return std::move(found).sorted();
}

std::vector<FacePair> intersecting_pairs(const TriangleMesh& a, const TriangleMesh& b) {
    return intersecting_pairs(a, b, std::numeric_limits<std::size_t>::max());
}

std::vector<FacePair> self_intersecting_pairs(const TriangleMesh& mesh) {
    return self_intersecting_pairs(mesh, std::numeric_limits<std::size_t>::max());
}

} // namespace echinus
