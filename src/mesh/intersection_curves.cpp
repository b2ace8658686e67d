#include "geometry/whole_numbers.hpp"
#include "mesh/intersecting_pairs.hpp"
#include "mesh/simplices_meet.hpp"

#include <algorithm>
#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

// The common segment of two faces has its endpoints where an edge or a corner of one meets the other. An
// endpoint is identified by the parts of the two meshes that meet there, which exact signs determine: all
// faces around it compute the same identity, and segments are joined at identical endpoints.

namespace echinus {

namespace {

/// A vertex, an edge or a face of a mesh.
struct Part {
    std::uint8_t dimension;
    std::uint32_t first, second; ///< of a vertex or an edge, its vertices, ascending; of a face, its number

    friend auto operator<=>(const Part&, const Part&) = default;
};

Part edge_part(std::uint32_t u, std::uint32_t v) {
    if (u == v) return {0, u, u};
    return {1, std::min(u, v), std::max(u, v)};
}

/// The parts that meet at an endpoint of a segment: one of each mesh, or two of the same mesh, ascending.
using Meeting = std::array<Part, 2>;

struct End {
    Meeting parts;
    Vec3f position;
};

/// A face and its corners.
struct Face {
    std::uint32_t number;
    Triangle vertices;
    std::array<Vec3f, 3> corners;

    Face(const TriangleMesh& mesh, std::uint32_t face)
        : number(face),
          vertices(mesh.faces[face]), corners{mesh.vertices[vertices[0]], mesh.vertices[vertices[1]],
                                              mesh.vertices[vertices[2]]} {}

    /// @param signs  the side of each edge on which a point lies, at most two of them 0; all agree in the
    ///               interior
    std::optional<Part> part_at(const std::array<int, 3>& signs) const {
        const auto [least, most] = std::minmax({signs[0], signs[1], signs[2]});
        if (least < 0 && most > 0) return std::nullopt;
        const auto zeros = std::count(signs.begin(), signs.end(), 0);
        if (zeros == 0) return Part{2, number, number};
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t next = (k + 1) % 3;
            if (zeros == 1 && signs[k] == 0) return edge_part(vertices[k], vertices[next]);
            if (zeros == 2 && signs[k] == 0 && signs[next] == 0)
                return edge_part(vertices[next], vertices[next]);
        }
        return std::nullopt;
    }

    /// The part on which a point of the face's plane lies; nothing if it is outside the face. @param axis  an
    /// axis along which the face is not seen edge-on
    std::optional<Part> part_below(const Vec3f& point, int axis) const {
        std::array<int, 3> signs{};
        for (std::size_t k = 0; k < 3; ++k)
            signs[k] = orientation(seen_along(axis, corners[k]), seen_along(axis, corners[(k + 1) % 3]),
                                   seen_along(axis, point));
        return part_at(signs);
    }

    /// The part through which a line passes; the line is not in the face's plane.
    std::optional<Part> part_through(const Vec3f& p, const Vec3f& q) const {
        std::array<int, 3> signs{};
        for (std::size_t k = 0; k < 3; ++k) signs[k] = orientation(p, q, corners[k], corners[(k + 1) % 3]);
        return part_at(signs);
    }

    /// Where the line from p to q, which are on different sides, crosses the plane.
    Vec3f crossing(const Vec3f& p, const Vec3f& q) const {
        const Vec3d origin(corners[0]), from(p), to(q);
        const Vec3d normal = cross(Vec3d(corners[1]) - origin, Vec3d(corners[2]) - origin);
        const double start = dot(normal, from - origin), end = dot(normal, to - origin);
        const double share = start / (start - end);
        // Rounding may move the quotient out of the segment.
        return Vec3f(from + (to - from) * (share >= 0 && share <= 1 ? share : 0.5));
    }
};

/// At most two different endpoints of a segment.
class Ends {
  public:
    void add(const Meeting& parts, const Vec3f& position) {
        for (std::size_t i = 0; i < count_; ++i)
            if (ends_[i].parts == parts) return;
        if (count_ < 2) ends_[count_++] = {parts, position};
    }
    bool are_two() const { return count_ == 2; }
    const End& operator[](std::size_t i) const { return ends_[i]; }

  private:
    std::array<End, 2> ends_;
    std::size_t count_ = 0;
};

/// Adds the endpoints at which corners and edges of `a` meet `b`. @param name  makes a Meeting of a part of a
/// and one of b
template <typename Name>
void add_ends(const Face& a, const Face& b, int axis_of_b, const Name& name, Ends& ends) {
    std::array<int, 3> sides{};
    for (std::size_t i = 0; i < 3; ++i)
        sides[i] = orientation(b.corners[0], b.corners[1], b.corners[2], a.corners[i]);
    if (sides == std::array<int, 3>{}) return; // coplanar
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        if (sides[i] == 0) {
            if (const auto part = b.part_below(a.corners[i], axis_of_b))
                ends.add(name(edge_part(a.vertices[i], a.vertices[i]), *part), a.corners[i]);
        } else if (sides[i] * sides[j] < 0) {
            const auto part = b.part_through(a.corners[i], a.corners[j]);
            if (part)
                ends.add(name(edge_part(a.vertices[i], a.vertices[j]), *part),
                         b.crossing(a.corners[i], a.corners[j]));
        }
    }
}

Ends common_segment(const Face& a, const Face& b, bool of_one_mesh) {
    Ends ends;
    const auto axis_of_a = axis_that_shows(a.corners[0], a.corners[1], a.corners[2]);
    const auto axis_of_b = axis_that_shows(b.corners[0], b.corners[1], b.corners[2]);
    if (!axis_of_a || !axis_of_b) return ends;
    const auto name = [of_one_mesh](const Part& p, const Part& q) {
        return of_one_mesh && q < p ? Meeting{q, p} : Meeting{p, q};
    };
    add_ends(a, b, *axis_of_b, name, ends);
    add_ends(
        b, a, *axis_of_a, [&](const Part& p, const Part& q) { return name(q, p); }, ends);
    return ends;
}

/// A graph of segments, and the curves that consist of them.
class Segments {
  public:
    void add(const Ends& ends) {
        ends_.push_back(ends[0]);
        ends_.push_back(ends[1]);
    }

    std::vector<IntersectionCurve> curves() {
        number_nodes();
        list_segments();
        std::vector<IntersectionCurve> curves;
        for (const bool only_loops : {false, true})
            for (std::uint32_t node = 0; node < positions_.size(); ++node)
                if (only_loops || degree(node) != 2)
                    for (std::uint32_t i = first_[node]; i < first_[node + 1]; ++i)
                        if (!is_used_[at_node_[i]]) curves.push_back(curve_from(node, at_node_[i]));
        return curves;
    }

  private:
    using Segment = std::array<std::uint32_t, 2>; ///< nodes, ascending

    /// Gives endpoints with the same parts the same number.
    void number_nodes() {
        std::vector<std::uint32_t> order(ends_.size());
        for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
        std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
            const Meeting &p = ends_[i].parts, &q = ends_[j].parts; // libc++ 14 has no <=> of arrays
            return p != q ? p < q : i < j;
        });
        segments_.resize(ends_.size() / 2);
        const Meeting* last = nullptr;
        for (const std::uint32_t i : order) {
            if (last == nullptr || ends_[i].parts != *last) positions_.push_back(ends_[i].position);
            last = &ends_[i].parts;
            segments_[i / 2][i % 2] = kept_as<std::uint32_t>(positions_.size() - 1);
        }
        ends_ = {};
    }

    /// Two faces at an edge that lies in a third one's plane both find that edge; it counts as one segment.
    void list_segments() {
        for (Segment& segment : segments_) std::sort(segment.begin(), segment.end());
        std::sort(segments_.begin(), segments_.end());
        segments_.erase(std::unique(segments_.begin(), segments_.end()), segments_.end());
        is_used_.assign(segments_.size(), false);
        first_.assign(positions_.size() + 1, 0);
        for (const Segment& segment : segments_)
            for (const std::uint32_t node : segment) ++first_[node + 1];
        for (std::size_t node = 0; node < positions_.size(); ++node) first_[node + 1] += first_[node];
        at_node_.resize(2 * segments_.size());
        std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
        for (std::uint32_t segment = 0; segment < segments_.size(); ++segment)
            for (const std::uint32_t node : segments_[segment]) at_node_[next[node]++] = segment;
    }

    std::uint32_t degree(std::uint32_t node) const { return first_[node + 1] - first_[node]; }

    IntersectionCurve curve_from(std::uint32_t start, std::uint32_t segment) {
        IntersectionCurve curve;
        std::uint32_t node = start;
        for (;;) {
            curve.points.push_back(positions_[node]);
            is_used_[segment] = true;
            node = segments_[segment][0] + segments_[segment][1] - node;
            curve.closed = node == start;
            if (curve.closed || degree(node) != 2) break;
            const std::uint32_t first = at_node_[first_[node]], second = at_node_[first_[node] + 1];
            segment = is_used_[first] ? second : first;
        }
        if (!curve.closed) curve.points.push_back(positions_[node]);
        return curve;
    }

    std::vector<End> ends_;        ///< two endpoints for each segment
    std::vector<Vec3f> positions_; ///< positions of the nodes
    std::vector<Segment> segments_;
    std::vector<bool> is_used_;        ///< whether a curve contains the segment
    std::vector<std::uint32_t> first_; ///< index of each node's first segment in at_node_
    std::vector<std::uint32_t> at_node_;
};

double length_of(const IntersectionCurve& curve) {
    double sum = 0;
    for (std::size_t i = 0; i < curve.points.size(); ++i) {
        const bool is_last = i + 1 == curve.points.size();
        if (is_last && !curve.closed) break;
        sum += length(Vec3d(curve.points[is_last ? 0 : i + 1]) - Vec3d(curve.points[i]));
    }
    return sum;
}

Intersections with_curves(std::vector<FacePair> pairs, const TriangleMesh& a, const TriangleMesh& b,
                          bool of_one_mesh) {
    Segments segments;
    for (const FacePair& pair : pairs) {
        const Ends ends = common_segment(Face(a, pair.a), Face(b, pair.b), of_one_mesh);
        if (ends.are_two()) segments.add(ends);
    }
    Intersections found{.pairs = std::move(pairs), .curves = segments.curves()};
    for (const IntersectionCurve& curve : found.curves) found.length += length_of(curve);
    return found;
}

} // namespace

Intersections intersections(const TriangleMesh& a, const TriangleMesh& b) {
    return with_curves(intersecting_pairs(a, b, Intersections::kMostPairs), a, b, false);
}

Intersections self_intersections(const TriangleMesh& mesh) {
    return with_curves(self_intersecting_pairs(mesh, Intersections::kMostPairs), mesh, mesh, true);
}

} // namespace echinus
