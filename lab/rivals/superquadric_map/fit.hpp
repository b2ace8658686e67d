#pragma once

#include "rivals/superquadric_map/superquadric.hpp"

#include <echinus/geometry.hpp>

#include <Eigen/Core>
#include <Eigen/QR>
#include <unsupported/Eigen/LevenbergMarquardt>

#include <cstddef>
#include <span>

namespace echinus::rivals {

/// A superquadric as twelve numbers without bounds: logits of the sizes' logarithms and of the
/// exponents between their bounds, centre, quaternion (w, x, y, z) of any length but zero.
struct FitParameters {
    enum Index : Eigen::Index { kSize = 0, kEtaExponent = 3, kOmegaExponent = 4, kCentre = 5, kRotation = 8 };
    static constexpr Eigen::Index kCount = 12;
    /// In units of the points' largest distance from their mean.
    static constexpr double kMinSize = 1e-3, kMaxSize = 2;

    static Eigen::VectorXd of(const Superquadric& shape);
    static Superquadric shape_of(const Eigen::VectorXd& parameters);
};

/// The radial distances of points as functions of the parameters, and their derivatives: what Eigen's
/// Levenberg-Marquardt calls a functor.
class FitResiduals : public Eigen::DenseFunctor<double> {
  public:
    explicit FitResiduals(std::span<const Vec3d> points)
        : DenseFunctor(FitParameters::kCount, static_cast<int>(points.size())), points_(points) {}

    int operator()(const InputType& parameters, ValueType& residuals) const;
    int df(const InputType& parameters, JacobianType& jacobian) const;

  private:
    std::span<const Vec3d> points_;
};

struct SuperquadricFit {
    Superquadric shape;
    /// Distances between points and surface along rays from the centre, in the unit of the points.
    double root_mean_square = 0, mean = 0, largest = 0;
};

/// The superquadric nearest to points of a surface, in the sense of least squares.
///
/// The fit minimises the sum of squares of the radial distances |p| (1 - F^(-e1/2)) of Gross and Boult (ICCV
/// 1988), because such a distance is a length and the quantity that a superquadric map stores. The error
/// sqrt(a1 a2 a3) (F^e1 - 1) of Solina and Bajcsy ("Recovery of parametric models from range images", IEEE
/// PAMI 12(2), 1990) is not: its factor is there to keep fits to one side of a solid small, while here all
/// sides are seen. (Radial distances times that factor were tried: where nothing fits well, the least is a
/// superquadric without volume.)
///
/// By Levenberg-Marquardt (Eigen's port of MINPACK) with derivatives by formula. Exponents are a logistic
/// function between their bounds and so are the logarithms of the sizes, between a thousandth and twice the
/// largest distance of a point from the mean, so that every step stays within them; the pose is a centre and
/// a quaternion, whose length is free and without effect. Starts from the principal axes, each of the three
/// as z axis, turned by 0 and 45 degrees about it (a square section is a diamond turned by 45), with round
/// and with boxy exponents; all go a few steps on some of the points, the best three on to the end on all.
/// The same points in the same order give the same fit; other compilers and processors another last digit.
///
/// Several descriptions may belong to one surface: axes may be exchanged where exponents allow, signs always.
///
/// @param points  [n] on the surface, from all sides, each of the same weight
/// @throws Error InvalidMesh when there are fewer than kMinPointCount, or one is not finite, or all are one
/// point
SuperquadricFit fit_superquadric(std::span<const Vec3d> points);

inline constexpr std::size_t kMinPointCount = 12; ///< as many as there are parameters

} // namespace echinus::rivals
