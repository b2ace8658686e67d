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

} // namespace echinus::rivals
