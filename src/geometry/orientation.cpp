#include "geometry/orientation.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

namespace echinus {

namespace {

/// The sum of two doubles, exactly: value + error, where value is the rounded sum.
struct SumAndError {
    double value, error;
};

SumAndError exact_sum_of(double a, double b) {
    const double value = a + b;
    const double b_part = value - a;
    const double a_part = value - b_part;
    return {value, (a - a_part) + (b - b_part)};
}

/// The product of two doubles, exactly (Dekker 1971). @pre nothing overflows or underflows
SumAndError exact_product_of(double a, double b) {
    const auto upper_half = [](double x) {
        const double scaled = 134217729.0 * x; // 2^27 + 1
        return scaled - (scaled - x);
    };
    const double value = a * b;
    const double a_high = upper_half(a), a_low = a - a_high;
    const double b_high = upper_half(b), b_low = b - b_high;
    return {value, a_low * b_low - (((value - a_high * b_high) - a_low * b_high) - a_high * b_low)};
}

/// A sum of doubles without rounding. Its value is the sum of its parts, which do not overlap and grow in
/// magnitude, so that the last one has the sign of the sum (Shewchuk 1997, "Adaptive Precision Floating-Point
/// Arithmetic", Grow-Expansion without zeros).
///
/// Requires IEEE arithmetic exactly as written, without contraction into fused operations or reordering.
/// @tparam capacity  the largest number of calls of add()
template <std::size_t capacity>
class ExactSum {
  public:
    void add(double term) {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < count_; ++i) {
            const auto [value, error] = exact_sum_of(term, parts_[i]);
            if (error != 0) parts_[kept++] = error;
            term = value;
        }
        if (term != 0) parts_[kept++] = term;
        count_ = kept;
    }

    /// Returns -1, 0 or 1.
    int sign() const {
        if (count_ == 0) return 0;
        return parts_[count_ - 1] > 0 ? 1 : -1;
    }

  private:
    std::array<double, capacity> parts_; // only the first count_ are initialised
    std::size_t count_ = 0;
};

/// p - q, if it is representable as a float.
std::optional<double> difference_in_float(float p, float q) {
    const auto [value, error] = exact_sum_of(p, -double{q});
    if (error != 0 || std::abs(value) > double{std::numeric_limits<float>::max()} ||
        static_cast<double>(static_cast<float>(value)) != value)
        return std::nullopt;
    return value;
}

std::optional<Vec3d> difference_in_floats(const Vec3f& p, const Vec3f& q) {
    const auto x = difference_in_float(p.x, q.x);
    const auto y = difference_in_float(p.y, q.y);
    const auto z = difference_in_float(p.z, q.z);
    if (!x || !y || !z) return std::nullopt;
    return Vec3d(*x, *y, *z);
}

/// Adds x y z with a sign. The product of the first two floats is exact.
template <std::size_t capacity>
void add_product(ExactSum<capacity>& sum, double x, double y, double z) {
    const double xy = x * y;
    if (xy == 0 || z == 0) return;
    const auto [value, error] = exact_product_of(xy, z);
    sum.add(error);
    sum.add(value);
}

/// Adds p . (q x r).
template <std::size_t capacity>
void add_triple_product(ExactSum<capacity>& sum, const Vec3d& p, const Vec3d& q, const Vec3d& r) {
    add_product(sum, q.y, r.z, p.x);
    add_product(sum, -q.z, r.y, p.x);
    add_product(sum, q.z, r.x, p.y);
    add_product(sum, -q.x, r.z, p.y);
    add_product(sum, q.x, r.y, p.z);
    add_product(sum, -q.y, r.x, p.z);
}

} // namespace

int exact_orientation(const Vec3f& a, const Vec3f& b, const Vec3f& c, const Vec3f& d) noexcept {
    // Surfaces that touch have vertices in common. A point equal to d is excluded before.
    if (a == b || b == c || a == c) return 0;
    const auto u = difference_in_floats(a, d);
    const auto v = difference_in_floats(b, d);
    const auto w = difference_in_floats(c, d);
    if (u && v && w) { // the usual case if points are coplanar on purpose
        ExactSum<12> sum;
        add_triple_product(sum, *u, *v, *w);
        return sum.sign();
    }
    const Vec3d p(a), q(b), r(c), origin(d);
    ExactSum<48> sum; // the determinant of four points with a column of ones
    add_triple_product(sum, p, q, r);
    add_triple_product(sum, -q, r, origin);
    add_triple_product(sum, p, r, origin);
    add_triple_product(sum, -p, q, origin);
    return sum.sign();
}

int exact_orientation(const Point2& a, const Point2& b, const Point2& c) noexcept {
    ExactSum<6> sum;
    for (const double product : {a.x * b.y, -a.y * b.x, b.x * c.y, -b.y * c.x, c.x * a.y, -c.y * a.x})
        sum.add(product);
    return sum.sign();
}

} // namespace echinus
