#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace echinus {

/// The sum of two doubles, exactly: value + error, where value is the rounded sum.
struct SumAndError {
    double value, error;
};

inline SumAndError exact_sum_of(double a, double b) {
    const double value = a + b;
    const double b_part = value - a;
    const double a_part = value - b_part;
    return {value, (a - a_part) + (b - b_part)};
}

/// The product of two doubles, exactly (Dekker 1971). @pre nothing overflows or underflows
inline SumAndError exact_product_of(double a, double b) {
    const auto upper_half = [](double x) {
        const double scaled = 134217729.0 * x; // 2^27 + 1
        return scaled - (scaled - x);
    };
    const double value = a * b;
    const double a_high = upper_half(a), a_low = a - a_high;
    const double b_high = upper_half(b), b_low = b - b_high;
    return {value, a_low * b_low - (((value - a_high * b_high) - a_low * b_high) - a_high * b_low)};
}

/// A sum of doubles without rounding: its value is that of its parts, which do not overlap and grow in
/// magnitude, so that the last one has the sign of all (Shewchuk 1997, "Adaptive Precision Floating-Point
/// Arithmetic", Grow-Expansion with zeros left out).
///
/// Needs IEEE arithmetic as written: no contraction into fused operations, no reordering.
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

    /// -1, 0 or 1.
    int sign() const {
        if (count_ == 0) return 0;
        return parts_[count_ - 1] > 0 ? 1 : -1;
    }

  private:
    std::array<double, capacity> parts_; // the first count_ are written
    std::size_t count_ = 0;
};

} // namespace echinus
