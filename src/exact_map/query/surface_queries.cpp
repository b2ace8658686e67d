// Tests triangles against the surface: first the face tree's boxes against the triangle's box, then each
// face.

#include "exact_map/layout.hpp"
#include "exact_map/query/leaf_bounds.hpp"
#include "exact_map/query/nearest.hpp"
#include "exact_map/query/triangle_distance.hpp"
#include "geometry/parallel.hpp"
#include "geometry/precondition.hpp"
#include "mesh/simplices_meet.hpp"
#include "simd/dispatch.hpp"

#include <echinus/error.hpp>
#include <echinus/surface_queries.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace echinus {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

bool all_finite(const TrianglePoints& t) {
    return is_finite(t[0]) && is_finite(t[1]) && is_finite(t[2]);
}

/// The largest float not above the value; values beyond the range of float become the end of the range.
float rounded_down(double value) {
    constexpr double kMost = std::numeric_limits<float>::max();
    const auto nearest = static_cast<float>(std::clamp(value, -kMost, kMost));
    return nearest <= value ? nearest : std::nextafter(nearest, -kInfinity);
}

float rounded_up(double value) {
    return -rounded_down(-value);
}

Vec3f rounded_down(const Vec3d& v) {
    return {rounded_down(v.x), rounded_down(v.y), rounded_down(v.z)};
}

Vec3f rounded_up(const Vec3d& v) {
    return {rounded_up(v.x), rounded_up(v.y), rounded_up(v.z)};
}

/// A triangle in lattice steps, and the box around it.
struct PlacedTriangle {
    TriangleCorners corners;
    Vec3f low, high;                  ///< limits of the box, rounded outwards
    double rounding;                  ///< see rounding_of()
    std::optional<NearTriangle> near; ///< for kernels; none if these are off or it is far away or large

    PlacedTriangle(const LatticeFrame& frame, const TrianglePoints& points)
        : PlacedTriangle(TriangleCorners{frame.to_lattice(points[0]), frame.to_lattice(points[1]),
                                         frame.to_lattice(points[2])},
                         extent_of(frame.centre) * frame.inverse_step) {}

    PlacedTriangle(const TriangleCorners& places, double rounded_extent) : corners(places) {
        const auto& [a, b, c] = places;
        const Vec3d least{std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y}), std::min({a.z, b.z, c.z})};
        const Vec3d most{std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y}), std::max({a.z, b.z, c.z})};
        low = rounded_down(least);
        high = rounded_up(most);
        rounding = rounding_of(places, rounded_extent);
        const auto within_range = [](const Vec3d& v) {
            return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}) < NearTriangle::kRange;
        };
        if (!use_kernels() || !within_range(least) || !within_range(most)) return;
        const Vec3<std::int32_t> origin(rounded(a));
        const Vec3d from(origin);
        near = {.origin = origin,
                .corners = {Vec3f(a - from), Vec3f(b - from), Vec3f(c - from)},
                .low = rounded_down(least - from),
                .high = rounded_up(most - from)};
    }
};

/// Lower bounds of the squared distances between the box of a triangle and those of a node's children, in
/// single precision: boxes are enlarged by a step, and the sums are reduced by what rounding may add.
class BoxGaps {
  public:
    BoxGaps(const Vec3f& low, const Vec3f& high) : low_(low), high_(high) {}

    ChildDistances operator()(const TreeNode& node) const {
        ChildDistances result;
        for (std::size_t k = 0; k < TreeNode::kWidth; ++k) {
            const float x = gap(node.low[0][k], node.high[0][k], low_.x, high_.x);
            const float y = gap(node.low[1][k], node.high[1][k], low_.y, high_.y);
            const float z = gap(node.low[2][k], node.high[2][k], low_.z, high_.z);
            const float sum = (x * x + y * y + z * z) * (1 - 0x1p-20F);
            result[k] = node.low[0][k] > node.high[0][k] ? kInfinity : sum;
        }
        return result;
    }

  private:
    static constexpr float kUnit = ExactMapView::kBoxUnit;
    static constexpr float kSlack = 1;

    static float gap(std::int16_t box_low, std::int16_t box_high, float low, float high) {
        const float above = static_cast<float>(box_low) * kUnit - high;
        const float below = low - static_cast<float>(box_high) * kUnit;
        const float larger = (above > below ? above : below) - kSlack;
        return larger > 0 ? larger : 0;
    }

    Vec3f low_, high_;
};

/// The same between a box and the box of one face.
float box_gap_sq(const std::array<LatticePoint, 3>& face, const Vec3f& low, const Vec3f& high) {
    const auto& [a, b, c] = face;
    const auto gap = [](std::int64_t p, std::int64_t q, std::int64_t r, float box_low, float box_high) {
        const float above = static_cast<float>(std::min({p, q, r})) - box_high;
        const float below = box_low - static_cast<float>(std::max({p, q, r}));
        return std::max({above, below, 0.0F});
    };
    const float x = gap(a.x, b.x, c.x, low.x, high.x);
    const float y = gap(a.y, b.y, c.y, low.y, high.y);
    const float z = gap(a.z, b.z, c.z, low.z, high.z);
    return (x * x + y * y + z * z) * (1 - 0x1p-20F);
}

/// Lower bounds of the fractions of the motion at which the box around a moving triangle comes within `reach`
/// of the boxes of a node's children; more than 1 if it does not. Each side of the box moves like the corner
/// that moves fastest in its direction.
class BoxArrivals {
  public:
    BoxArrivals(const MovingTriangle& moving, double start, double reach) : start_(start), reach_(reach) {
        const TriangleCorners now = moving.at(start);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto [low, high] = range_of(now, kAxes[axis]);
            const auto [slowest, fastest] = range_of(moving.way, kAxes[axis]);
            sides_[axis] = {low, high, slowest, fastest};
        }
    }

    ChildDistances operator()(const TreeNode& node) const {
        ChildDistances result;
        for (std::size_t k = 0; k < TreeNode::kWidth; ++k) {
            double after = 0, until = 1 - start_;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const Sides& sides = sides_[axis];
                const double low = node.low[axis][k] * kUnit - reach_;
                const double high = node.high[axis][k] * kUnit + reach_;
                clip(low - sides.high, sides.high_way, after, until);
                clip(sides.low - high, -sides.low_way, after, until);
            }
            const bool comes = after <= until && node.low[0][k] <= node.high[0][k];
            result[k] = comes ? static_cast<float>(start_ + after) * (1 - 0x1p-20F) : kNever;
        }
        return result;
    }

  private:
    static constexpr float kNever = 2;
    static constexpr double kUnit = ExactMapView::kBoxUnit;
    static constexpr std::array kAxes{&Vec3d::x, &Vec3d::y, &Vec3d::z};

    struct Sides {
        double low, high, low_way, high_way;
    };

    static std::pair<double, double> range_of(const TriangleCorners& t, double Vec3d::*axis) {
        return std::minmax({t[0].*axis, t[1].*axis, t[2].*axis});
    }

    /// Restricts an interval of time to the part in which a gap that shrinks at the given speed is closed.
    static void clip(double gap, double speed, double& after, double& until) {
        if (speed > 0)
            after = std::max(after, gap / speed);
        else if (speed < 0)
            until = std::min(until, gap / speed);
        else if (gap > 0)
            until = -1;
    }

    double start_, reach_;
    std::array<Sides, 3> sides_;
};

/// Nothing farther than this many lattice steps is searched for. Its square fits into a float.
constexpr double kFarthest = 1e18;

/// A float above the square of a distance; finite, so that missing children lie beyond it. @pre distance <=
/// kFarthest
float bound_of(double distance) {
    return static_cast<float>(distance * distance) * (1 + 0x1p-20F);
}

/// Lower bounds from vector instructions are multiplied by this factor before they are compared with a limit,
/// because distance_from_below(), which decides in the end, may round its result down.
constexpr double kClear = 1 - 0x1p-12;

double distance_from_below(const ExactMapView& map, std::uint32_t face, const PlacedTriangle& triangle) {
    const auto [a, b, c] = face_corners(map, face);
    return distance_from_below(triangle.corners, {Vec3d(a), Vec3d(b), Vec3d(c)}, triangle.rounding);
}

/// Calls visit(LeafFaces, LeafBounds) for the leaves that have a face whose box is not beyond `bound`;
/// `visit` may lower the bound.
template <typename Visit>
void visit_near_leaves(const ExactMapView& map, const PlacedTriangle& triangle, const float& bound,
                       const Visit& visit) {
    LeafBounds bounds;
    bounds.lower.fill(0);
    bounds.upper.fill(kInfinity);
    walk_near_leaves(map, bound, BoxGaps(triangle.low, triangle.high), [&](const LeafFaces& faces) {
        if (!triangle.near || bound_leaf_distances(map, faces, *triangle.near, bound, bounds))
            visit(faces, bounds);
    });
}

/// The nearest face within `farthest`, and a lower bound of its distance in lattice steps.
struct NearestFace {
    std::uint32_t face;
    double distance;
};

std::optional<NearestFace> nearest_face(const ExactMapView& map, const PlacedTriangle& triangle,
                                        double farthest) {
    std::optional<NearestFace> nearest;
    double limit = farthest; // not below the distance of the nearest face, if there is one within `farthest`
    float bound = bound_of(limit);
    visit_near_leaves(map, triangle, bound, [&](const LeafFaces& faces, const LeafBounds& bounds) {
        for (std::uint32_t lane = 0; lane < faces.last - faces.first; ++lane)
            limit = std::min(limit, double{bounds.upper[lane]});
        for (std::uint32_t lane = 0; lane < faces.last - faces.first; ++lane) {
            if (bounds.lower[lane] * kClear > limit) continue;
            const std::uint32_t face = faces.first + lane;
            const double distance = distance_from_below(map, face, triangle);
            if (distance > limit || (nearest && (distance > nearest->distance ||
                                                 (distance == nearest->distance && face > nearest->face))))
                continue;
            nearest = NearestFace{face, distance};
            limit = distance;
        }
        bound = bound_of(limit);
    });
    return nearest;
}

/// The face that a moving triangle reaches first, and the fraction of the motion at which it does.
struct FirstFace {
    std::uint32_t face;
    double fraction;
};

/// Tests face by face. @param start  the fraction of the motion up to which no face is met
std::optional<FirstFace> first_face(const ExactMapView& map, const MovingTriangle& moving, double start,
                                    const ArrivalTolerance& tolerance) {
    std::optional<FirstFace> first;
    float bound = 1;
    // Boxes lie within a step of their faces; the rest exceeds the rounding errors.
    const BoxArrivals arrivals(moving, start, 1 + 8 * tolerance.reach);
    walk_near_leaves(map, bound, arrivals, [&](const LeafFaces& faces) {
        for (std::uint32_t face = faces.first; face < faces.last; ++face) {
            const auto [a, b, c] = face_corners(map, face);
            const auto fraction = arrival(moving, {Vec3d(a), Vec3d(b), Vec3d(c)}, start,
                                          first ? first->fraction : 1, tolerance);
            if (!fraction || (first && *fraction == first->fraction && face > first->face)) continue;
            first = FirstFace{face, *fraction};
            bound = static_cast<float>(*fraction) * (1 + 0x1p-20F);
        }
    });
    return first;
}

/// The lattice point nearest to a place, in floats.
Vec3f snapped(const Vec3d& place) {
    return Vec3f(Vec3d(std::nearbyint(place.x), std::nearbyint(place.y), std::nearbyint(place.z)));
}

void append_faces_within(const ExactMapView& map, const PlacedTriangle& triangle, double reach,
                         std::vector<std::uint32_t>& faces) {
    const std::size_t first = faces.size();
    const float bound = bound_of(reach);
    visit_near_leaves(map, triangle, bound, [&](const LeafFaces& leaf, const LeafBounds& bounds) {
        for (std::uint32_t lane = 0; lane < leaf.last - leaf.first; ++lane) {
            if (bounds.lower[lane] * kClear > reach) continue;
            const std::uint32_t face = leaf.first + lane;
            if (bounds.upper[lane] <= reach || distance_from_below(map, face, triangle) <= reach)
                faces.push_back(map.face_numbers[face]);
        }
    });
    std::sort(faces.begin() + static_cast<std::ptrdiff_t>(first), faces.end());
}

} // namespace

bool intersects(const ExactMapView& map, const TrianglePoints& triangle_local) noexcept {
    if (!all_finite(triangle_local)) return false;
    const LatticeFrame frame = frame_of(map);
    Simplex triangle;
    for (const Vec3f& corner : triangle_local) triangle.push_back(snapped(frame.to_lattice(corner)));
    const auto& [a, b, c] = triangle.corners;
    if (!all_finite(triangle.corners)) return false;
    const Vec3f low{std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y}), std::min({a.z, b.z, c.z})};
    const Vec3f high{std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y}), std::max({a.z, b.z, c.z})};
    float bound = 0; // below 0 once a face is found
    walk_near_leaves(map, bound, BoxGaps(low, high), [&](const LeafFaces& faces) {
        for (std::uint32_t face = faces.first; face < faces.last && bound == 0; ++face) {
            const auto corners = face_corners(map, face);
            if (box_gap_sq(corners, low, high) > 0) continue;
            if (simplices_meet(triangle, {{Vec3f(corners[0]), Vec3f(corners[1]), Vec3f(corners[2])}, 3}))
                bound = -1;
        }
    });
    return bound < 0;
}

Clearance clearance(const ExactMapView& map, const TrianglePoints& triangle_local, float farthest) noexcept {
    if (!all_finite(triangle_local)) return {.distance = farthest};
    const LatticeFrame frame = frame_of(map);
    const double limit = std::min(farthest * frame.inverse_step, kFarthest);
    const auto nearest = nearest_face(map, PlacedTriangle(frame, triangle_local), limit);
    if (!nearest) return {.distance = std::min(farthest, rounded_down(kFarthest * frame.step))};
    const double distance = nearest->distance * frame.step * (1 - 0x1p-50);
    return {.distance = rounded_down(distance), .face = map.face_numbers[nearest->face]};
}

TriangleSweepHit sweep(const ExactMapView& map, const TrianglePoints& from_local,
                       const TrianglePoints& to_local) noexcept {
    constexpr double kArrived = 4; // lattice steps: R / 2^17
    constexpr int kMovesOfAll = 16;
    if (!all_finite(from_local) || !all_finite(to_local)) return {};
    const LatticeFrame frame = frame_of(map);
    MovingTriangle moving;
    double longest = 0, extent = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        moving.from[k] = frame.to_lattice(from_local[k]);
        const Vec3d to = frame.to_lattice(to_local[k]);
        moving.way[k] = to - moving.from[k];
        longest = std::max(longest, length(moving.way[k]));
        extent = std::max(extent, extent_of(moving.from[k]) + extent_of(to));
    }
    if (extent > kFarthest / 2) return {};
    // A position along the path is off by less than 2^-47 of the extent, however close it is.
    const ArrivalTolerance tolerance{.reach = std::max(kArrived, extent * 0x1p-46),
                                     .rounded_extent =
                                         extent_of(frame.centre) * frame.inverse_step + extent * 0x1p-1};
    double fraction = 0;
    for (int move = 0; move < kMovesOfAll; ++move) {
        const double rest = longest * (1 - fraction);
        const PlacedTriangle now(moving.at(fraction), tolerance.rounded_extent);
        const auto nearest = nearest_face(map, now, std::max(rest, tolerance.reach));
        if (!nearest) return {};
        if (nearest->distance <= tolerance.reach)
            return {.fraction = rounded_down(fraction), .face = map.face_numbers[nearest->face]};
        if (nearest->distance >= rest) return {};
        fraction += nearest->distance / longest * (1 - 0x1p-40);
    }
    const auto first = first_face(map, moving, fraction, tolerance);
    if (!first) return {};
    return {.fraction = rounded_down(first->fraction), .face = map.face_numbers[first->face]};
}

void intersects_batch(const ExactMapView& map, StridedSpan<const TrianglePoints> triangles_local,
                      std::span<std::uint8_t> intersecting, unsigned thread_count) noexcept {
    if (!is_met(triangles_local.size() == intersecting.size(),
                "intersects_batch: the number of answers differs from the number of triangles"))
        return;
    answer_each(intersecting, thread_count, [&](std::size_t i) {
        return intersects(map, triangles_local[i]) ? std::uint8_t{1} : std::uint8_t{0};
    });
}

void clearance_batch(const ExactMapView& map, StridedSpan<const TrianglePoints> triangles_local,
                     float farthest, std::span<Clearance> clearances, unsigned thread_count) noexcept {
    if (!is_met(triangles_local.size() == clearances.size(),
                "clearance_batch: the number of clearances differs from the number of triangles"))
        return;
    answer_each(clearances, thread_count,
                [&](std::size_t i) { return clearance(map, triangles_local[i], farthest); });
}

void sweep_batch(const ExactMapView& map, StridedSpan<const TrianglePoints> from_local,
                 StridedSpan<const TrianglePoints> to_local, std::span<TriangleSweepHit> hits,
                 unsigned thread_count) noexcept {
    if (!is_met(from_local.size() == hits.size() && to_local.size() == hits.size(),
                "sweep_batch: starts, ends and hits differ in number"))
        return;
    answer_each(hits, thread_count, [&](std::size_t i) { return sweep(map, from_local[i], to_local[i]); });
}

void faces_within_batch(const ExactMapView& map, StridedSpan<const Vec3f> vertices_local,
                        std::span<const Triangle> triangles, float reach, FaceLists& lists,
                        unsigned thread_count) {
    // Blocks of a fixed size, each with its own list, so that the lists can be concatenated in order for any
    // number of threads.
    constexpr std::size_t kBlockSize = 256;
    struct Block {
        std::vector<std::uint32_t> faces;
    };
    const std::size_t block_count = (triangles.size() + kBlockSize - 1) / kBlockSize;
    const LatticeFrame frame = frame_of(map);
    const double reach_steps = std::min(reach * frame.inverse_step * (1 + 0x1p-50), kFarthest);
    lists.offsets.assign(triangles.size() + 1, 0);
    std::vector<Block> blocks(block_count);
    parallel_for(block_count, thread_count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t block = begin; block < end; ++block) {
            const std::size_t last = std::min(triangles.size(), (block + 1) * kBlockSize);
            for (std::size_t i = block * kBlockSize; i < last; ++i) {
                const auto [a, b, c] = triangles[i];
                const TrianglePoints points{vertices_local[a], vertices_local[b], vertices_local[c]};
                const std::size_t before = blocks[block].faces.size();
                if (all_finite(points))
                    append_faces_within(map, PlacedTriangle(frame, points), reach_steps, blocks[block].faces);
                lists.offsets[i + 1] = static_cast<std::uint32_t>(blocks[block].faces.size() - before);
            }
        }
    });
    std::uint64_t total = 0;
    for (std::size_t i = 1; i <= triangles.size(); ++i) {
        total += lists.offsets[i];
        if (total > UINT32_MAX)
            throw Error(
                ErrorCode::InvalidOptions,
                "2^32 faces or more are within reach of the triangles; query fewer triangles at a time");
        lists.offsets[i] = static_cast<std::uint32_t>(total);
    }
    lists.faces.clear();
    for (const Block& block : blocks)
        lists.faces.insert(lists.faces.end(), block.faces.begin(), block.faces.end());
}

} // namespace echinus
