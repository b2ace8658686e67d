#pragma once

#include "directions/crossing.hpp"

#include <algorithm>
#include <array>
#include <cmath>

/// How a face counts for a particle p of the lattice: +1 or -1 if the ray from the origin through p leaves or
/// enters the solid there *beyond* p, else 0. Particle and ray are perturbed together: p stands for
/// p + (e, e^2, e^3), as in directions/crossing.hpp.
namespace echinus {

/// In integers: the specification.
///
/// With n the sum of the three edge normals, which is the face's own, the ray meets the plane at
/// p * determinant / (n.p), so beyond p where |n.p| < |determinant|.
inline int crossing_beyond(const std::array<LatticePoint, 3>& face, const LatticePoint& p) {
    const auto& [a, b, c] = face;
    const FaceCone cone(a, b, c);
    if (cone.edge_on() || !cone.meets(p)) return 0;
    const LatticePoint normal = cross(b - a, c - a);
    const std::int64_t before_plane = dot(normal, a - p);
    const int sign = cone.outward() ? 1 : -1;
    const bool beyond =
        before_plane != 0 ? (before_plane > 0) == cone.outward() : sign_of_perturbation(normal) * sign < 0;
    return beyond ? sign : 0;
}

/// The same by a filter in double, which decides all but one face in a million, without a branch that a
/// processor could mispredict.
///
/// Corners are projected along p onto the plane across the longest component of p: a point v goes to
/// v * p_k - p * v_k. These are integers below 2^39.1, exact in double; from there on rounding is bounded.
class CrossingFilter {
  public:
    explicit CrossingFilter(const LatticePoint& p) {
        const auto x = static_cast<double>(p.x), y = static_cast<double>(p.y), z = static_cast<double>(p.z);
        const double ax = std::fabs(x), ay = std::fabs(y), az = std::fabs(z);
        if (ax >= ay && ax >= az)
            set_axes(1, 2, 0, y, z, x);
        else if (ay >= az)
            set_axes(2, 0, 1, z, x, y);
        else
            set_axes(0, 1, 2, x, y, z);
    }

    struct Verdict {
        int crossing; ///< as crossing_beyond(), if it is sure
        bool sure;
    };

    /// @param a, b, c  corners of the face: x, y, z each
    Verdict operator()(const std::int32_t* a, const std::int32_t* b, const std::int32_t* c) const {
        const Projected pa = project(a), pb = project(b), pc = project(c);
        // Twice the areas that the ray cuts off at each edge, times p_k^2: below 2^79.3.
        const double bc = pb.u * pc.v - pb.v * pc.u;
        const double ca = pc.u * pa.v - pc.v * pa.u;
        const double ab = pa.u * pb.v - pa.v * pb.u;
        const double least = std::min(std::min(bc, ca), ab);
        const double most = std::max(std::max(bc, ca), ab);
        const double before_plane = bc * pa.ahead + ca * pb.ahead + ab * pc.ahead;
        const bool front = least > kAreaError;
        const bool back = most < -kAreaError;
        const bool missed = most > kAreaError && least < -kAreaError;
        const bool hit = front || back;
        const bool sure_of_side = std::fabs(before_plane) > kVolumeError;
        // The cone is met; beyond p if the plane is: (T - p_k S) S p_k > 0, in which S has the sign of
        // `front`.
        const double sign = front ? sign_ : -sign_;
        const bool beyond = (before_plane > 0) == front;
        return {hit && beyond ? (sign > 0 ? 1 : -1) : 0, missed || (hit && sure_of_side)};
    }

  private:
    struct Projected {
        double u, v, ahead; ///< ahead: how much farther along p than p itself, by component k
    };

    void set_axes(int u, int v, int k, double pu, double pv, double pk) {
        u_axis_ = u;
        v_axis_ = v;
        k_axis_ = k;
        pu_ = pu;
        pv_ = pv;
        pk_ = pk;
        sign_ = pk > 0 ? 1 : -1;
    }

    Projected project(const std::int32_t* corner) const {
        const double u = corner[u_axis_], v = corner[v_axis_], k = corner[k_axis_];
        return {u * pk_ - pu_ * k, v * pk_ - pv_ * k, (k - pk_) * sign_};
    }

    // Products of two numbers below 2^39.1 are off by 2^25.2 at most, and so is their difference: together
    // less than 2^28. Times a coordinate below 2^20.1, rounded, and three of them added: less than 2^51.
    static constexpr double kAreaError = 0x1p28;
    static constexpr double kVolumeError = 0x1p51;

    int u_axis_, v_axis_, k_axis_;
    double pu_, pv_, pk_, sign_;
};

} // namespace echinus
