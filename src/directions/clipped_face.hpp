#pragma once

#include <echinus/geometry.hpp>

#include <algorithm>
#include <array>
#include <cstddef>

namespace echinus {

/// A convex polygon with few corners, in lattice steps, to be cut by planes through the origin. Near the
/// origin its directions are lost in rounding: that a face keeps off the origin does not mean that it keeps
/// off by more than the rounding of a corner.
class ClippedFace {
  public:
    explicit ClippedFace(const std::array<Vec3d, 3>& corners) : size_(3) {
        std::copy(corners.begin(), corners.end(), corners_.begin());
    }

    /// Keeps the part with n.p >= 0, and what rounding may have put beyond that.
    /// @param n  of a length of about 1
    void cut(const Vec3d& n) {
        std::array<Vec3d, kMost> kept;
        std::size_t kept_size = 0;
        for (std::size_t i = 0; i < size_; ++i) {
            const Vec3d& a = corners_[i];
            const Vec3d& b = corners_[i + 1 == size_ ? 0 : i + 1];
            const double height_a = dot(n, a) + kRounding, height_b = dot(n, b) + kRounding;
            if (height_a >= 0) kept[kept_size++] = a;
            if ((height_a >= 0) != (height_b >= 0))
                kept[kept_size++] = a + (b - a) * (height_a / (height_a - height_b));
        }
        corners_ = kept;
        size_ = kept_size;
    }

    bool empty() const { return size_ == 0; }
    /// Does it come so near to the origin that its corners do not tell in which directions it lies?
    bool is_all_around() const {
        return std::any_of(begin(), end(), [](const Vec3d& p) { return dot(p, p) < kNear * kNear; });
    }
    const Vec3d* begin() const { return corners_.data(); }
    const Vec3d* end() const { return corners_.data() + size_; }

  private:
    /// In lattice steps, of which a lattice has 2^20 on each axis: doubles of them are rounded by 2^-34, and
    /// each cut adds a few times that.
    static constexpr double kRounding = 0x1p-28;
    /// In lattice steps. At this distance kRounding is 2^-28 radians, far below all margins of samples.
    static constexpr double kNear = 1;

    static constexpr std::size_t kMost = 3 + 4 + 1; // each of up to four planes adds at most one corner
    std::array<Vec3d, kMost> corners_;
    std::size_t size_;
};

} // namespace echinus
