#include "tetrahedra/body_lattice.hpp"

#include "geometry/parallel.hpp"
#include "geometry/whole_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <tuple>
#include <utility>

namespace echinus {

namespace {

/// The number of cube corners along an axis: enough for a layer of cubes below the box and one above it.
double cube_count(double low, double high, double size) {
    return std::ceil((high - low) / size) + 3;
}

} // namespace

BodyLattice::BodyLattice(const Vec3d& low, const Vec3d& high, double size)
    : size_(size), counts_{truncated_to<std::uint64_t>(cube_count(low.x, high.x, size)),
                           truncated_to<std::uint64_t>(cube_count(low.y, high.y, size)),
                           truncated_to<std::uint64_t>(cube_count(low.z, high.z, size))} {
    // Centres the box among the cube corners; counts_ is their number along each axis.
    const auto half_extent = [&](std::uint64_t count) { return static_cast<double>(count - 1) * size / 2; };
    origin_ =
        (low + high) * 0.5 - Vec3d{half_extent(counts_[0]), half_extent(counts_[1]), half_extent(counts_[2])};
}

double BodyLattice::vertex_count_around(const Vec3d& low, const Vec3d& high, double size) {
    return 2 * cube_count(low.x, high.x, size) * cube_count(low.y, high.y, size) *
           cube_count(low.z, high.z, size);
}

namespace {

constexpr std::size_t kBatchSize = 65'536;

bool is_long(std::uint8_t edge) {
    return edge < kLongEdgeCount;
}

/// The cut edges that belong to the vertices of a slab; their fractions are not yet determined.
std::vector<CutPoint> cut_edges(const BodyLattice& lattice, const LatticeSides& sides, std::size_t slab) {
    std::vector<CutPoint> cuts;
    const BodyLattice::Vertex begin = slab * lattice.slab_size(), end = begin + lattice.slab_size();
    for (BodyLattice::Vertex vertex = begin; vertex < end; ++vertex) {
        const BodyLattice::Place place = lattice.place_of(vertex);
        const int edge_count = vertex % 2 == 0 ? kEdgeCount : kLongEdgeCount;
        for (int edge = 0; edge < edge_count; ++edge) {
            const BodyLattice::Place far = place + kEdges[static_cast<std::size_t>(edge)];
            if (lattice.contains(far) && sides[lattice.vertex_at(far)] != sides[vertex])
                cuts.push_back({vertex, static_cast<std::uint8_t>(edge), 0});
        }
    }
    return cuts;
}

} // namespace

LatticeSides find_sides(const ExactMapView& map, const BodyLattice& lattice, unsigned thread_count,
                        const std::function<void(double)>& progress) {
    LatticeSides sides(lattice.vertex_count());
    std::vector<Vec3f> points(kBatchSize);
    std::vector<std::uint8_t> inside(kBatchSize);
    for (std::size_t begin = 0; begin < sides.size(); begin += kBatchSize) {
        const std::size_t count = std::min(kBatchSize, sides.size() - begin);
        for (std::size_t i = 0; i < count; ++i) points[i] = Vec3f(lattice.position(begin + i));
        contains_batch(map, StridedSpan<const Vec3f>(points.data(), count), {inside.data(), count},
                       thread_count);
        for (std::size_t i = 0; i < count; ++i)
            sides[begin + i] = inside[i] != 0 ? LatticeSide::Inside : LatticeSide::Outside;
        if (progress) progress(static_cast<double>(begin + count) / static_cast<double>(sides.size()));
    }
    return sides;
}

double find_entry(const ExactMapView& map, const Vec3d& outside, const Vec3d& inside) {
    const SweepHit hit = sweep(map, Vec3f(outside), Vec3f(inside));
    if (hit.found() && hit.entering) return std::clamp(double{hit.fraction}, 0.0, 1.0);
    // The surface is open, and the winding number changes at a place without a face: bisect to below float's
    // precision.
    double low = 0, high = 1;
    for (int i = 0; i < 24; ++i) {
        const double middle = (low + high) / 2;
        (contains(map, Vec3f(outside + (inside - outside) * middle)) ? high : low) = middle;
    }
    return (low + high) / 2;
}

CutPoints::CutPoints(const BodyLattice& lattice, const LatticeSides& sides, const FindEntry& find,
                     unsigned thread_count)
    : lattice_(lattice) {
    std::vector<std::vector<CutPoint>> of_slab(lattice.slab_count());
    parallel_for(of_slab.size(), thread_count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t slab = begin; slab < end; ++slab) of_slab[slab] = cut_edges(lattice, sides, slab);
    });
    for (std::vector<CutPoint>& cuts : of_slab) {
        points_.insert(points_.end(), cuts.begin(), cuts.end());
        cuts = {};
    }
    parallel_for(points_.size(), thread_count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Vec3d near = lattice.position(points_[i].vertex), far = lattice.position(far_end(i));
            const bool from_outside = sides[points_[i].vertex] == LatticeSide::Outside;
            const double entry = from_outside ? find(near, far) : find(far, near);
            points_[i].fraction = static_cast<float>(from_outside ? entry : 1 - entry);
        }
    });
}

BodyLattice::Vertex CutPoints::far_end(std::size_t index) const {
    return lattice_.vertex_at(lattice_.place_of(points_[index].vertex) + kEdges[points_[index].edge]);
}

Vec3d CutPoints::position(std::size_t index) const {
    const Vec3d near = lattice_.position(points_[index].vertex);
    return near + (lattice_.position(far_end(index)) - near) * double{points_[index].fraction};
}

std::size_t CutPoints::between(const BodyLattice::Place& a, const BodyLattice::Place& b) const {
    const BodyLattice::Place way = b - a;
    const bool is_turned = a.x % 2 != b.x % 2 ? a.x % 2 != 0 : way.x + way.y + way.z < 0;
    if (is_turned) return between(b, a);
    const auto edge =
        static_cast<std::uint64_t>(std::find(kEdges.begin(), kEdges.end(), way) - kEdges.begin());
    const std::uint64_t key = lattice_.vertex_at(a) * kEdgeCount + edge;
    const auto found = std::lower_bound(points_.begin(), points_.end(), key,
                                        [](const CutPoint& cut, std::uint64_t k) { return cut.key() < k; });
    return static_cast<std::size_t>(found - points_.begin());
}

void CutPoints::warp(LatticeSides& sides) {
    struct Violation {
        BodyLattice::Vertex vertex;
        double distance;
        std::size_t cut;
    };
    std::vector<Violation> violations;
    for (std::size_t i = 0; i < points_.size(); ++i) {
        const double share = is_long(points_[i].edge) ? kLongShare : kShortShare;
        const double edge_length = length(Vec3d(kEdges[points_[i].edge]));
        const double fraction = double{points_[i].fraction};
        if (fraction < share)
            violations.push_back({points_[i].vertex, fraction * edge_length, i});
        else if (1 - fraction < share)
            violations.push_back({far_end(i), (1 - fraction) * edge_length, i});
    }
    std::sort(violations.begin(), violations.end(), [](const Violation& a, const Violation& b) {
        return std::tie(a.vertex, a.distance, a.cut) < std::tie(b.vertex, b.distance, b.cut);
    });

    const auto is_on_surface = [&](BodyLattice::Vertex v) { return sides[v] == LatticeSide::OnSurface; };
    const auto is_left = [&](std::size_t cut) {
        return !is_on_surface(points_[cut].vertex) && !is_on_surface(far_end(cut));
    };
    for (const Violation& violation : violations) {
        if (!is_left(violation.cut)) continue;
        warps_.push_back({violation.vertex, position(violation.cut)});
        sides[violation.vertex] = LatticeSide::OnSurface;
    }
    std::size_t count = 0;
    for (std::size_t i = 0; i < points_.size(); ++i)
        if (is_left(i)) points_[count++] = points_[i];
    points_.resize(count);
}

Vec3d CutPoints::position_of(const BodyLattice::Place& place) const {
    const BodyLattice::Vertex vertex = lattice_.vertex_at(place);
    const auto found =
        std::lower_bound(warps_.begin(), warps_.end(), vertex,
                         [](const Warp& warp, BodyLattice::Vertex v) { return warp.vertex < v; });
    return found != warps_.end() && found->vertex == vertex ? found->position : lattice_.position(place);
}

namespace {

using Place = BodyLattice::Place;

/// A lattice tetrahedron whose corners are sorted by their side: inside, on the surface, outside.
class SortedTetrahedron {
  public:
    SortedTetrahedron(const BodyLattice& lattice, const LatticeSides& sides, const CutPoints& cuts,
                      const std::array<Place, 4>& corners)
        : lattice_(lattice), cuts_(cuts), places_(corners) {
        for (std::size_t i = 0; i < 4; ++i) ranks_[i] = rank(sides[lattice.vertex_at(corners[i])]);
        sort();
        for (const int r : ranks_) ++counts_[static_cast<std::size_t>(r)];
    }

    int inside_count() const { return counts_[0]; }
    int outside_count() const { return counts_[2]; }

    StencilCorner corner(std::size_t i) const { return {lattice_.vertex_at(places_[i])}; }
    StencilCorner cut(std::size_t inside, std::size_t outside) const {
        return {cuts_.between(places_[inside], places_[outside]) | StencilCorner::kCutPoint};
    }

    /// Two inside corners and one outside corner of a triangle leave a quadrilateral of it. Does its diagonal
    /// start at the first inside corner rather than the second?
    bool diagonal_starts_at_first(std::size_t first, std::size_t second, std::size_t outside) const {
        const Place &a = places_[first], &b = places_[second], &out = places_[outside];
        // If one of the cut edges is long, the diagonal ends at its cut point.
        if (is_short(a, b)) return !is_short(b, out);
        // Otherwise parity decides: the start of the diagonal must exceed its end, a cut point, in an even
        // number of coordinates. So the diagonals of two neighbouring triangles at a long edge start at
        // different ends of it.
        const Place middle = b + out; // doubled
        const int greater_count = static_cast<int>(2 * a.x > middle.x) +
                                  static_cast<int>(2 * a.y > middle.y) + static_cast<int>(2 * a.z > middle.z);
        return greater_count % 2 == 0;
    }

  private:
    static int rank(LatticeSide side) {
        return side == LatticeSide::Inside ? 0 : side == LatticeSide::OnSurface ? 1 : 2;
    }
    static bool is_short(const Place& a, const Place& b) { return a.x % 2 != b.x % 2; }

    /// Sorts by exchanges of two corners. If their number is odd, two corners of the same side are exchanged,
    /// too, so that the orientation stays positive.
    void sort() {
        bool is_odd = false;
        const auto exchange = [&](std::size_t i, std::size_t j) {
            std::swap(places_[i], places_[j]);
            std::swap(ranks_[i], ranks_[j]);
            is_odd = !is_odd;
        };
        for (std::size_t end = 4; end > 1; --end)
            for (std::size_t i = 0; i + 1 < end; ++i)
                if (ranks_[i] > ranks_[i + 1]) exchange(i, i + 1);
        if (!is_odd) return;
        for (std::size_t i = 0; i < 3; ++i) // four corners have three different sides
            if (ranks_[i] == ranks_[i + 1]) return exchange(i, i + 1);
    }

    const BodyLattice& lattice_;
    const CutPoints& cuts_;
    std::array<Place, 4> places_;
    std::array<int, 4> ranks_{};
    std::array<int, 3> counts_{};
};

/// Adds three tetrahedra that fill a prism with the triangles `top` and `bottom`, both counter-clockwise seen
/// from the bottom.
/// @param from_top  [i] whether the diagonal of the side between corners i and i + 1 starts at top[i] rather
///                  than top[i + 1]; not all equal
void add_prism(const std::array<StencilCorner, 3>& top, const std::array<StencilCorner, 3>& bottom,
               const std::array<bool, 3>& from_top, std::vector<StencilTetrahedron>& result) {
    // Find the corner of the top at which two diagonals start.
    std::size_t a = 0;
    while (!from_top[a] || from_top[(a + 2) % 3]) ++a;
    const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
    result.push_back({top[a], bottom[a], bottom[b], bottom[c]});
    if (from_top[b]) {
        result.push_back({top[a], top[b], top[c], bottom[c]});
        result.push_back({top[a], top[b], bottom[c], bottom[b]});
    } else {
        result.push_back({top[a], top[b], top[c], bottom[b]});
        result.push_back({top[a], top[c], bottom[c], bottom[b]});
    }
}

/// One corner inside: the cut points replace the outside corners.
void add_tip(const SortedTetrahedron& t, std::vector<StencilTetrahedron>& result) {
    StencilTetrahedron tip{t.corner(0), t.corner(1), t.corner(2), t.corner(3)};
    for (std::size_t i = 4 - static_cast<std::size_t>(t.outside_count()); i < 4; ++i) tip[i] = t.cut(0, i);
    result.push_back(tip);
}

/// Two corners inside, one on the surface, one outside: a pyramid over a quadrilateral.
void add_pyramid(const SortedTetrahedron& t, std::vector<StencilTetrahedron>& result) {
    // Positive with the apex as third corner: exchanging the last two of the sorted corners twice preserves
    // the orientation.
    const StencilCorner a = t.corner(0), b = t.corner(1), apex = t.corner(2);
    const StencilCorner cut_a = t.cut(0, 3), cut_b = t.cut(1, 3);
    if (t.diagonal_starts_at_first(0, 1, 3)) {
        result.push_back({a, b, apex, cut_b});
        result.push_back({a, cut_b, apex, cut_a});
    } else {
        result.push_back({a, b, apex, cut_a});
        result.push_back({b, cut_b, apex, cut_a});
    }
}

/// Three corners inside, one outside.
void add_truncated(const SortedTetrahedron& t, std::vector<StencilTetrahedron>& result) {
    add_prism({t.corner(0), t.corner(1), t.corner(2)}, {t.cut(0, 3), t.cut(1, 3), t.cut(2, 3)},
              {t.diagonal_starts_at_first(0, 1, 3), t.diagonal_starts_at_first(1, 2, 3),
               t.diagonal_starts_at_first(2, 0, 3)},
              result);
}

/// Two corners inside, two outside: a prism lying on the edge between the inside corners.
void add_wedge(const SortedTetrahedron& t, std::vector<StencilTetrahedron>& result) {
    const bool first = t.diagonal_starts_at_first(0, 1, 2), last = !t.diagonal_starts_at_first(0, 1, 3);
    // The quadrilateral in the middle is not shared with a neighbour.
    add_prism({t.corner(0), t.cut(0, 2), t.cut(0, 3)}, {t.corner(1), t.cut(1, 2), t.cut(1, 3)},
              {first, !first, last}, result);
}

} // namespace

void add_stencil(const BodyLattice& lattice, const LatticeSides& sides, const CutPoints& cuts,
                 const std::array<Place, 4>& corners, std::vector<StencilTetrahedron>& result) {
    const SortedTetrahedron t(lattice, sides, cuts, corners);
    if (t.inside_count() == 0) return;
    if (t.outside_count() == 0)
        result.push_back({t.corner(0), t.corner(1), t.corner(2), t.corner(3)});
    else if (t.inside_count() == 1)
        add_tip(t, result);
    else if (t.inside_count() == 3)
        add_truncated(t, result);
    else if (t.outside_count() == 2)
        add_wedge(t, result);
    else
        add_pyramid(t, result);
}

} // namespace echinus
