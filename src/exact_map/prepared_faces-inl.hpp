// Included once for each instruction set, as Highway wants it: no guard against a second time.
#if defined(ECHINUS_PREPARED_FACES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ECHINUS_PREPARED_FACES_INL
#undef ECHINUS_PREPARED_FACES_INL
#else
#define ECHINUS_PREPARED_FACES_INL
#endif

#include "exact_map/cell_lanes-inl.hpp"
#include "exact_map/ray_crossing.hpp"

#include <hwy/highway.h>

#include <array>
#include <cstddef>
#include <cstdint>

#if HWY_TARGET != HWY_SCALAR // where the reference is used instead
HWY_BEFORE_NAMESPACE();
namespace echinus::HWY_NAMESPACE {

/// Faces made ready for a filter in single precision that tells how rays cross them; what it is not sure of
/// is for crossing_on() to decide. Faces are prepared as lanes, and then tested with particles as lanes.
///
/// Each face has three planes through the origin and an edge; a ray meets the face where it is on the inner
/// side of all three. Normals are divided by the products of the lengths that they were made from, so
/// that one bound on rounding serves all of them.
class PreparedFaces {
  public:
    static constexpr std::size_t kCapacity = 128;

    void clear() { count_ = 0; }
    bool full() const { return count_ == kCapacity; }
    bool empty() const { return count_ == 0; }

    template <typename Corner>
    void add(const Corner& a, const Corner& b, const Corner& c) {
        std::size_t row = 0;
        for (const Corner* corner : {&a, &b, &c})
            for (const std::int32_t number : {corner->x, corner->y, corner->z})
                corners_[row++][count_] = static_cast<float>(number);
        ++count_;
    }

    /// To be called after the last add().
    void prepare() {
        constexpr Floats d;
        const std::size_t lanes = hn::Lanes(d);
        for (std::size_t row = 0; row < kRowCount; ++row) // no lane may be left without numbers
            hn::StoreU(hn::Zero(d), d, &corners_[row][count_]);
        for (std::size_t first = 0; first < count_; first += lanes) prepare_lanes(first);
    }

    /// What the rays through as many particles as there are lanes cross.
    struct Crossings {
        FloatLanes sum; ///< +1 for each face on the wanted side by which a ray leaves, -1 where it enters
        FloatMask sure;
    };

    template <RaySide kSide>
    Crossings crossings(const LatticeLanes& p) const {
        constexpr Floats f;
        const FloatLanes zero = hn::Zero(f), far = hn::Set(f, 0x1p100F);
        FloatLanes sum = zero, clear_of_edges = far, clear_of_planes = far;
        for (std::size_t face = 0; face < count_; ++face) {
            const auto along = [&](const Normals& n) {
                return hn::MulAdd(
                    hn::Set(f, n[2][face]), p.z,
                    hn::MulAdd(hn::Set(f, n[1][face]), p.y, hn::Mul(hn::Set(f, n[0][face]), p.x)));
            };
            const FloatLanes least = hn::Min(hn::Min(along(edges_[0]), along(edges_[1])), along(edges_[2]));
            const FloatLanes ahead = hn::Sub(hn::Set(f, heights_[face]), along(planes_));
            const FloatMask hit = hn::Gt(least, zero), beyond = hn::Gt(ahead, zero);
            const FloatMask counts =
                kSide == RaySide::Beyond ? hn::And(hit, beyond) : hn::AndNot(beyond, hit);
            sum = hn::Add(sum, hn::IfThenElseZero(counts, hn::Set(f, signs_[face])));
            clear_of_edges = hn::Min(clear_of_edges, hn::Abs(least));
            clear_of_planes = hn::Min(clear_of_planes, hn::IfThenElse(hit, hn::Abs(ahead), far));
        }
        const FloatMask sure = hn::And(hn::Gt(clear_of_edges, hn::Mul(p.l1_norm(), hn::Set(f, kEdgeError))),
                                       hn::Gt(clear_of_planes, hn::Set(f, kSideError)));
        return {sum, sure};
    }

  private:
    // A normal's component is a difference of two products of whole numbers below 2^21: each of its terms is
    // rounded by 2^-24 of the product at most, and so are its sum, its scaling and the three terms of the
    // product with p: 7 roundings. With lengths taken as sums of components, what they add up to is less
    // than 7 * 2^-24 of |p|. Twice as much is allowed for.
    static constexpr float kEdgeError = 0x1p-20F;
    // The same of a face's plane, for p and for the corner that its height is taken from: 2^-4 of 7, twice.
    static constexpr float kSideError = 1;

    static constexpr std::size_t kRowCount = 9;
    static constexpr std::size_t kPadding = 16; // floats of the widest vector

    using Row = std::array<float, kCapacity + kPadding>;
    using Normals = std::array<Row, 3>;

    void prepare_lanes(std::size_t first) {
        constexpr Floats d;
        using V = hn::Vec<decltype(d)>;
        struct V3 {
            V x, y, z;
        };
        const auto corner = [&](std::size_t k) {
            return V3{hn::Load(d, &corners_[3 * k][first]), hn::Load(d, &corners_[3 * k + 1][first]),
                      hn::Load(d, &corners_[3 * k + 2][first])};
        };
        const auto minus = [](const V3& u, const V3& v) {
            return V3{hn::Sub(u.x, v.x), hn::Sub(u.y, v.y), hn::Sub(u.z, v.z)};
        };
        const auto product = [](const V3& u, const V3& v) {
            return V3{hn::Sub(hn::Mul(u.y, v.z), hn::Mul(u.z, v.y)),
                      hn::Sub(hn::Mul(u.z, v.x), hn::Mul(u.x, v.z)),
                      hn::Sub(hn::Mul(u.x, v.y), hn::Mul(u.y, v.x))};
        };
        const auto sum = [](const V3& v) {
            return hn::Add(hn::Add(hn::Abs(v.x), hn::Abs(v.y)), hn::Abs(v.z));
        };
        const auto one = hn::Set(d, 1);
        const V3 a = corner(0), b = corner(1), c = corner(2);
        const V3 ab = minus(b, a), bc = minus(c, b), ca = minus(a, c);

        const auto scaled = [&](const V3& v, V scale) {
            return V3{hn::Mul(v.x, scale), hn::Mul(v.y, scale), hn::Mul(v.z, scale)};
        };
        // At least 1, so that lanes without a face give no infinity.
        const auto inverse = [&](V u, V v) { return hn::Div(one, hn::Max(hn::Mul(u, v), one)); };
        const V sum_ab = sum(ab), sum_bc = sum(bc), sum_ca = sum(ca);
        const V3 plane = scaled(product(ab, bc), inverse(sum_ab, sum_bc));
        const V height = hn::MulAdd(plane.z, b.z, hn::MulAdd(plane.y, b.y, hn::Mul(plane.x, b.x)));
        const auto outward = hn::Gt(height, hn::Zero(d));
        // Seen edge-on, front and back cannot be told apart: with edges of no length no ray is sure of it.
        const auto sign = hn::IfThenZeroElse(hn::Le(hn::Abs(height), hn::Set(d, kSideError)),
                                             hn::IfThenElse(outward, one, hn::Set(d, -1)));
        const auto store = [&](const V3& v, Normals& to) {
            hn::Store(v.x, d, &to[0][first]);
            hn::Store(v.y, d, &to[1][first]);
            hn::Store(v.z, d, &to[2][first]);
        };
        store(scaled(plane, sign), planes_);
        hn::Store(hn::Mul(height, sign), d, &heights_[first]);
        hn::Store(sign, d, &signs_[first]);
        store(scaled(product(a, ab), hn::Mul(sign, inverse(sum(a), sum_ab))), edges_[0]);
        store(scaled(product(b, bc), hn::Mul(sign, inverse(sum(b), sum_bc))), edges_[1]);
        store(scaled(product(c, ca), hn::Mul(sign, inverse(sum(c), sum_ca))), edges_[2]);
    }

    std::size_t count_ = 0;
    alignas(64) std::array<Row, kRowCount> corners_;
    alignas(64) std::array<Normals, 3> edges_;
    alignas(64) Normals planes_;
    alignas(64) Row heights_, signs_;
};

} // namespace echinus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

#endif
