#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace echinus {

/// The factor of a small, dense, symmetric and positive definite matrix: A = L L^T. O(n^3).
template <typename T>
class Cholesky {
  public:
    /// @param matrix  [size * size] by rows; only the lower triangle is read. If rounding leaves a pivot that
    /// is not positive, its row is treated as decoupled from the others.
    void factorise(std::size_t size, std::span<const T> matrix) {
        size_ = size;
        factor_.assign(matrix.begin(), matrix.end());
        for (std::size_t i = 0; i < size_; ++i) {
            T* const row = factor_.data() + i * size_;
            const T original = row[i];
            for (std::size_t j = 0; j < i; ++j) {
                const T* const other = factor_.data() + j * size_;
                T sum = row[j];
                for (std::size_t k = 0; k < j; ++k) sum -= row[k] * other[k];
                row[j] = sum / other[j];
            }
            T pivot = original;
            for (std::size_t k = 0; k < i; ++k) pivot -= row[k] * row[k];
            if (!(pivot > kLeastPivot * original)) {
                for (std::size_t k = 0; k < i; ++k) row[k] = 0;
                pivot = original > 0 ? original : T{1};
            }
            row[i] = std::sqrt(pivot);
        }
    }

    /// @param x  [size] the right side, replaced by the solution
    void solve(std::span<T> x) const {
        for (std::size_t i = 0; i < size_; ++i) {
            const T* const row = factor_.data() + i * size_;
            T sum = x[i];
            for (std::size_t k = 0; k < i; ++k) sum -= row[k] * x[k];
            x[i] = sum / row[i];
        }
        for (std::size_t i = size_; i-- > 0;) {
            const T* const row = factor_.data() + i * size_;
            x[i] /= row[i];
            for (std::size_t k = 0; k < i; ++k) x[k] -= row[k] * x[i];
        }
    }

  private:
    /// Relative to the diagonal entry: a smaller pivot is only rounding.
    static constexpr T kLeastPivot = static_cast<T>(sizeof(T) == 4 ? 1e-6 : 1e-13);

    std::size_t size_ = 0;
    std::vector<T> factor_;
};

} // namespace echinus
