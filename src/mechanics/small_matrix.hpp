#pragma once

#include <echinus/geometry.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace echinus {

/// A 3 x 3 matrix as its three columns.
using Matrix3 = std::array<Vec3d, 3>;

inline Vec3d times(const Matrix3& m, const Vec3d& v) {
    return m[0] * v.x + m[1] * v.y + m[2] * v.z;
}

inline double determinant(const Matrix3& m) {
    return dot(cross(m[0], m[1]), m[2]);
}

/// The eigenvalues of a symmetric matrix and its unit eigenvectors, by Jacobi rotations.
struct Eigensystem {
    std::array<double, 3> values;
    Matrix3 vectors;
};

inline Eigensystem eigensystem(const std::array<std::array<double, 3>, 3>& symmetric) {
    constexpr int kSweeps = 12; // six suffice, since convergence is quadratic
    constexpr double kNegligible = 1e-30;
    auto a = symmetric;
    std::array<std::array<double, 3>, 3> v{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        const double off = a[0][1] * a[0][1] + a[0][2] * a[0][2] + a[1][2] * a[1][2];
        const double on = a[0][0] * a[0][0] + a[1][1] * a[1][1] + a[2][2] * a[2][2];
        if (!(off > kNegligible * on)) break;
        for (const auto& [p, q] : {std::pair{0U, 1U}, {0U, 2U}, {1U, 2U}}) {
            if (a[p][q] == 0) continue;
            const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
            const double t = (theta >= 0 ? 1 : -1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
            const double c = 1 / std::sqrt(t * t + 1), s = t * c;
            for (std::size_t k = 0; k < 3; ++k) {
                const double kp = a[k][p], kq = a[k][q];
                a[k][p] = c * kp - s * kq;
                a[k][q] = s * kp + c * kq;
            }
            for (std::size_t k = 0; k < 3; ++k) {
                const double pk = a[p][k], qk = a[q][k];
                a[p][k] = c * pk - s * qk;
                a[q][k] = s * pk + c * qk;
                const double vp = v[k][p], vq = v[k][q];
                v[k][p] = c * vp - s * vq;
                v[k][q] = s * vp + c * vq;
            }
        }
    }
    return {{a[0][0], a[1][1], a[2][2]},
            {Vec3d{v[0][0], v[1][0], v[2][0]}, Vec3d{v[0][1], v[1][1], v[2][1]},
             Vec3d{v[0][2], v[1][2], v[2][2]}}};
}

/// F = U diag(stretches) V^T with rotations U and V; if F inverts orientation, the least stretch is negative.
struct RotationVariantSvd {
    Matrix3 u, v;
    std::array<double, 3> stretches;
};

inline RotationVariantSvd decompose(const Matrix3& f) {
    std::array<std::array<double, 3>, 3> gram{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) gram[i][j] = dot(f[i], f[j]);
    Eigensystem system = eigensystem(gram);
    // Sort in descending order.
    for (const auto& [p, q] : {std::pair{0U, 1U}, {1U, 2U}, {0U, 1U}})
        if (system.values[p] < system.values[q]) {
            std::swap(system.values[p], system.values[q]);
            std::swap(system.vectors[p], system.vectors[q]);
        }
    RotationVariantSvd result;
    result.v = system.vectors;
    if (determinant(result.v) < 0) result.v[2] = -result.v[2];
    const auto any_across = [](const Vec3d& direction) {
        const Vec3d axis = std::abs(direction.x) < 0.5 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
        const Vec3d across = cross(direction, axis);
        return across * (1 / length(across));
    };
    constexpr double kNegligible = 1e-12; // a smaller relative stretch has no direction
    Vec3d first = times(f, result.v[0]);
    const double largest = length(first);
    first = largest > 0 ? first * (1 / largest) : Vec3d{1, 0, 0};
    Vec3d second = times(f, result.v[1]);
    second -= first * dot(first, second);
    const double middle = length(second);
    second = middle > kNegligible * largest ? second * (1 / middle) : any_across(first);
    result.u = {first, second, cross(first, second)};
    for (std::size_t k = 0; k < 3; ++k) result.stretches[k] = dot(result.u[k], times(f, result.v[k]));
    return result;
}

} // namespace echinus
