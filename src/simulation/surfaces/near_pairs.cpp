// Finds which vertices, edges and faces of two elements may come near each other: the plain function, which
// is the specification, and a kernel that processes as many pairs of elements at once as the instruction set
// has lanes.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simulation/surfaces/near_pairs.cpp"
#include <hwy/foreach_target.h>

// After foreach_target.h, which includes this file once for each instruction set.
#include "simd/dispatch.hpp"
#include "simd/lanes-inl.hpp"
#include "simulation/surfaces/near_pairs.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>

#ifndef ECHINUS_SIMULATION_NEAR_PAIRS_RULES
#define ECHINUS_SIMULATION_NEAR_PAIRS_RULES
namespace echinus {
namespace {

/// Two elements have 15 pairs, with one bit each: a vertex of the first with the second as a face, a vertex
/// of the second with the first, or an edge of each.
constexpr std::size_t kPairsOfElements = 15, kFirstFaceVertex = 3, kFirstEdgeEdge = 6;

/// Pairs of elements by their vertices: three of the first element, then three of the second.
struct ElementBatch {
    static constexpr std::size_t kMost = 64;
    std::array<std::array<std::uint32_t, kMost>, 6> vertices;
    std::array<std::uint32_t, kMost> bits; ///< out: one for each of the pairs that may come near
    std::size_t count = 0;
};

/// The interval of something along one axis, at the beginning and at the end of its displacement.
template <typename Number>
struct MovingInterval {
    Number low_from, high_from, low_to, high_to;
};

/// The intervals of an element's vertices, edges and face along one axis.
template <typename Number>
struct ElementIntervals {
    std::array<MovingInterval<Number>, 3> vertices, edges;
    MovingInterval<Number> face;
};

} // namespace
} // namespace echinus
#endif

HWY_BEFORE_NAMESPACE();
namespace echinus {
namespace HWY_NAMESPACE {

using IntervalLanes = MovingInterval<FloatLanes>;

HWY_INLINE IntervalLanes joined(const IntervalLanes& a, const IntervalLanes& b) {
    return {hn::Min(a.low_from, b.low_from), hn::Max(a.high_from, b.high_from), hn::Min(a.low_to, b.low_to),
            hn::Max(a.high_to, b.high_to)};
}

HWY_INLINE FloatMask are_far(const IntervalLanes& a, const IntervalLanes& b, FloatLanes reach) {
    const FloatMask above = hn::And(a.low_from - b.high_from > reach, a.low_to - b.high_to > reach);
    const FloatMask below = hn::And(b.low_from - a.high_from > reach, b.low_to - a.high_to > reach);
    return hn::Or(above, below);
}

HWY_INLINE ElementIntervals<FloatLanes> intervals_of(const std::array<IntLanes, 6>& vertices,
                                                     std::size_t first, const float* from, const float* to) {
    ElementIntervals<FloatLanes> result;
    for (std::size_t k = 0; k < 3; ++k) {
        const FloatLanes begin = hn::GatherIndex(kFloat, from, vertices[first + k]),
                         end = hn::GatherIndex(kFloat, to, vertices[first + k]);
        result.vertices[k] = {begin, begin, end, end};
    }
    for (std::size_t k = 0; k < 3; ++k)
        result.edges[k] = joined(result.vertices[k], result.vertices[(k + 1) % 3]);
    result.face = joined(result.edges[0], result.edges[1]);
    return result;
}

void find_near_bits(ElementBatch& batch, const MovingElements& own, const MovingElements& other,
                    float reach_in) {
    const std::array<const std::vector<float>*, 3> own_from{&own.from.x, &own.from.y, &own.from.z},
        own_to{&own.to.x, &own.to.y, &own.to.z}, other_from{&other.from.x, &other.from.y, &other.from.z},
        other_to{&other.to.x, &other.to.y, &other.to.z};
    const FloatLanes reach = splat(reach_in);
    for (std::size_t lane = 0; lane < batch.count; lane += kLanes) {
        std::array<IntLanes, 6> vertices;
        for (std::size_t k = 0; k < 6; ++k) vertices[k] = load_indices(&batch.vertices[k][lane]);
        std::array<FloatMask, kPairsOfElements> far;
        far.fill(splat_mask(false));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto a = intervals_of(vertices, 0, own_from[axis]->data(), own_to[axis]->data());
            const auto b = intervals_of(vertices, 3, other_from[axis]->data(), other_to[axis]->data());
            for (std::size_t k = 0; k < 3; ++k) {
                far[k] = hn::Or(far[k], are_far(a.vertices[k], b.face, reach));
                FloatMask& of_face = far[kFirstFaceVertex + k];
                of_face = hn::Or(of_face, are_far(a.face, b.vertices[k], reach));
                for (std::size_t j = 0; j < 3; ++j) {
                    FloatMask& of_edges = far[kFirstEdgeEdge + 3 * k + j];
                    of_edges = hn::Or(of_edges, are_far(a.edges[k], b.edges[j], reach));
                }
            }
        }
        IntLanes bits = hn::Zero(kInt);
        for (std::size_t p = 0; p < kPairsOfElements; ++p)
            bits = hn::Or(bits, hn::IfThenZeroElse(as_int_mask(far[p]), splat_int(1 << p)));
        hn::StoreU(hn::BitCast(hn::RebindToUnsigned<Ints>(), bits), hn::RebindToUnsigned<Ints>(),
                   &batch.bits[lane]);
    }
}

} // namespace HWY_NAMESPACE
} // namespace echinus
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace echinus {

namespace {

HWY_EXPORT(find_near_bits);

using Interval = MovingInterval<float>;

Interval joined(const Interval& a, const Interval& b) {
    return {std::min(a.low_from, b.low_from), std::max(a.high_from, b.high_from),
            std::min(a.low_to, b.low_to), std::max(a.high_to, b.high_to)};
}

bool are_far(const Interval& a, const Interval& b, float reach) {
    return (a.low_from - b.high_from > reach && a.low_to - b.high_to > reach) ||
           (b.low_from - a.high_from > reach && b.low_to - a.high_to > reach);
}

ElementIntervals<float> intervals_of(const Element& element, const std::vector<float>& from,
                                     const std::vector<float>& to) {
    ElementIntervals<float> result;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t v = element.vertices[k];
        result.vertices[k] = {from[v], from[v], to[v], to[v]};
    }
    for (std::size_t k = 0; k < 3; ++k)
        result.edges[k] = joined(result.vertices[k], result.vertices[(k + 1) % 3]);
    result.face = joined(result.edges[0], result.edges[1]);
    return result;
}

std::uint32_t near_bits(const Element& a, const Element& b, const MovingElements& own,
                        const MovingElements& other, float reach) {
    std::uint32_t far = 0;
    const auto compare = [&](std::vector<float> PointArrays::*axis) {
        const auto x = intervals_of(a, own.from.*axis, own.to.*axis);
        const auto y = intervals_of(b, other.from.*axis, other.to.*axis);
        const auto mark = [&](std::size_t pair, bool is_far) { far |= std::uint32_t{is_far} << pair; };
        for (std::size_t k = 0; k < 3; ++k) {
            mark(k, are_far(x.vertices[k], y.face, reach));
            mark(kFirstFaceVertex + k, are_far(x.face, y.vertices[k], reach));
            for (std::size_t j = 0; j < 3; ++j)
                mark(kFirstEdgeEdge + 3 * k + j, are_far(x.edges[k], y.edges[j], reach));
        }
    };
    for (const auto axis : {&PointArrays::x, &PointArrays::y, &PointArrays::z}) compare(axis);
    return ~far;
}

/// The pairs that are searched with these elements.
std::uint32_t owned_bits(const Element& own, const Element& other) {
    std::uint32_t bits = 0;
    if (other.is_face()) bits |= std::uint32_t{own.owned_vertices};
    if (own.is_face()) bits |= std::uint32_t{other.owned_vertices} << kFirstFaceVertex;
    for (std::size_t k = 0; k < 3; ++k)
        if (own.owns_edge(k)) bits |= std::uint32_t{other.owned_edges} << (kFirstEdgeEdge + 3 * k);
    return bits;
}

/// @param is_of_itself  whether both are elements of one surface
void add_pair(std::size_t bit, const Element& own, const Element& other, bool is_of_itself,
              std::vector<Pair>& pairs) {
    const auto& a = own.vertices;
    const auto& b = other.vertices;
    if (bit < kFirstFaceVertex) {
        const std::uint32_t v = a[bit];
        if (!is_of_itself || !other.has(v)) pairs.push_back({{v, b[0], b[1], b[2]}, PairKind::VertexFace});
    } else if (bit < kFirstEdgeEdge) {
        const std::uint32_t v = b[bit - kFirstFaceVertex];
        if (!is_of_itself)
            pairs.push_back({{a[0], a[1], a[2], v}, PairKind::FaceVertex});
        else if (!own.has(v))
            pairs.push_back({{v, a[0], a[1], a[2]}, PairKind::VertexFace});
    } else {
        const std::size_t i = (bit - kFirstEdgeEdge) / 3, j = (bit - kFirstEdgeEdge) % 3;
        const Edge edge{a[i], a[(i + 1) % 3]}, across{b[j], b[(j + 1) % 3]};
        const bool is_shared =
            edge[0] == across[0] || edge[0] == across[1] || edge[1] == across[0] || edge[1] == across[1];
        if (!is_of_itself || !is_shared)
            pairs.push_back({{edge[0], edge[1], across[0], across[1]}, PairKind::EdgeEdge});
    }
}

} // namespace

void find_near_pairs(std::span<const std::array<std::uint32_t, 2>> elements, const MovingElements& own,
                     const MovingElements& other, float reach, std::vector<Pair>& pairs) {
    const bool is_of_itself = &own.elements == &other.elements, is_fast = use_kernels();
    ElementBatch batch;
    for (std::size_t first = 0; first < elements.size(); first += ElementBatch::kMost) {
        batch.count = std::min(ElementBatch::kMost, elements.size() - first);
        // Whole vectors are read, so the first pair is repeated after the last one.
        for (std::size_t i = 0; i < ElementBatch::kMost; ++i) {
            const auto& [a, b] = elements[first + (i < batch.count ? i : 0)];
            const Element &of_own = own.elements.all[a], &of_other = other.elements.all[b];
            for (std::size_t k = 0; k < 3; ++k) {
                batch.vertices[k][i] = of_own.vertices[k];
                batch.vertices[3 + k][i] = of_other.vertices[k];
            }
            if (!is_fast) batch.bits[i] = near_bits(of_own, of_other, own, other, reach);
        }
        if (is_fast) ECHINUS_DISPATCH(find_near_bits)(batch, own, other, reach);
        for (std::size_t i = 0; i < batch.count; ++i) {
            const auto& [a, b] = elements[first + i];
            const Element &of_own = own.elements.all[a], &of_other = other.elements.all[b];
            for (std::uint32_t bits = batch.bits[i] & owned_bits(of_own, of_other); bits != 0;
                 bits &= bits - 1)
                add_pair(static_cast<std::size_t>(std::countr_zero(bits)), of_own, of_other, is_of_itself,
                         pairs);
        }
    }
}

} // namespace echinus
#endif // HWY_ONCE
