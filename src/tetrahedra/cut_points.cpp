#include "tetrahedra/cut_points.hpp"

#include "geometry/parallel.hpp"

#include <algorithm>
#include <tuple>

namespace echinus {

namespace {

constexpr std::size_t kBatchSize = 65'536;

bool is_long(std::uint8_t edge) {
    return edge < kLongEdgeCount;
}

/// The cut edges that belong to the vertices of a slab; their fractions are not yet known.
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
    // The surface is open, and the winding number changes without a face: halve to below float's precision.
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

} // namespace echinus
