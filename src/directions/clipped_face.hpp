#pragma once

#include <echinus/geometry.hpp>

#include <algorithm>
#include <array>
#include <cstddef>

namespace echinus {

/// A convex polygon with few corners, to be cut by planes through the origin.
class ClippedFace {
  public:
    explicit ClippedFace(const std::array<Vec3d, 3>& corners) : size_(3) {
        std::copy(corners.begin(), corners.end(), corners_.begin());
    }

    /// Keeps the part with n.p >= 0.
    void cut(const Vec3d& n) {
        std::array<Vec3d, kMost> kept;
        std::size_t kept_size = 0;
        for (std::size_t i = 0; i < size_; ++i) {
            const Vec3d& a = corners_[i];
            const Vec3d& b = corners_[i + 1 == size_ ? 0 : i + 1];
            const double height_a = dot(n, a), height_b = dot(n, b);
            if (height_a >= 0) kept[kept_size++] = a;
            if ((height_a >= 0) != (height_b >= 0))
                kept[kept_size++] = a + (b - a) * (height_a / (height_a - height_b));
        }
        corners_ = kept;
        size_ = kept_size;
    }

    bool empty() const { return size_ == 0; }
    const Vec3d* begin() const { return corners_.data(); }
    const Vec3d* end() const { return corners_.data() + size_; }

  private:
    static constexpr std::size_t kMost = 3 + 4 + 1; // each of up to four planes adds at most one corner
    std::array<Vec3d, kMost> corners_;
    std::size_t size_;
};

} // namespace echinus
