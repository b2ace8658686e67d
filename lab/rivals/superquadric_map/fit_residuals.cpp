#include "rivals/superquadric_map/fit_residuals.hpp"

#include "rivals/superquadric_map/log_powers.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace echinus::rivals {

namespace {

/// A number between two bounds as a logit, which has none.
struct Bounded {
    double least, largest;

    double from(double logit) const { return least + (largest - least) / (1 + std::exp(-logit)); }
    /// @param value  pulled inwards where it is at a bound or beyond, whose logit is infinite
    double logit(double value) const {
        const double margin = 1e-3 * (largest - least);
        const double inner = std::clamp(value, least + margin, largest - margin);
        return std::log((inner - least) / (largest - inner));
    }
    /// d value / d logit
    double slope(double value) const { return (value - least) * (largest - value) / (largest - least); }
};
constexpr Bounded kExponent{Superquadric::kMinExponent, Superquadric::kMaxExponent};
const Bounded kLogSize{std::log(FitParameters::kMinSize), std::log(FitParameters::kMaxSize)};

double size_from(double logit) {
    return std::exp(kLogSize.from(logit));
}
/// d ln size / d logit
double log_size_slope(double size) {
    return kLogSize.slope(std::log(size));
}

/// ln F's derivatives. x d/dx is -a d/da, since coordinates only occur divided by their size.
struct LogSlopes {
    Vec3d scaled; ///< (x d/dx, y d/dy, z d/dz) ln F
    double eta_exponent, omega_exponent;

    LogSlopes(const LogPowers& p, double e1, double e2) {
        // Shares of a sum lie in [0, 1] however large its terms; a term that is 0 has no share of anything.
        const double disc = std::exp(p.disc - p.whole), z = std::exp(p.z - p.whole);
        const double x = share(p.x, p.section), y = share(p.y, p.section);
        scaled = Vec3d{disc * x, disc * y, z} * (2 / e1);
        eta_exponent = -(e2 / (e1 * e1) * times(disc, p.section) + times(z, p.z) / e1);
        omega_exponent = (times(disc, p.section) - disc * (times(x, p.x) + times(y, p.y))) / e1;
    }

  private:
    static double share(double log_term, double log_sum) {
        return std::isinf(log_sum) ? 0 : std::exp(log_term - log_sum);
    }
    /// t ln t tends to 0 with t.
    static double times(double share_of_sum, double log_term) {
        return share_of_sum > 0 ? share_of_sum * log_term : 0;
    }
};

/// Derivatives of R(q)^T v by the quaternion's components, where q need not be of unit length.
std::array<Vec3d, 4> slopes_by_quaternion(const Eigen::VectorXd& parameters, const Vec3d& v,
                                          const Vec3d& turned) {
    const Eigen::Index r = FitParameters::kRotation;
    const double w = parameters[r];
    const Vec3d u{parameters[r + 1], parameters[r + 2], parameters[r + 3]};
    const double scale = 2 / (w * w + dot(u, u));
    const double along = dot(u, v);
    const auto by_axis = [&](const Vec3d& axis, double u_k, double v_k) {
        return (axis * along + u * v_k - v * u_k - cross(axis, v) * w - turned * u_k) * scale;
    };
    return {(v * w - cross(u, v) - turned * w) * scale, by_axis({1, 0, 0}, u.x, v.x),
            by_axis({0, 1, 0}, u.y, v.y), by_axis({0, 0, 1}, u.z, v.z)};
}

double ratio_or_zero(double numerator, double denominator) {
    return denominator == 0
               ? 0
               : numerator / denominator; // on a coordinate plane, where by symmetry F has no slope
}

} // namespace

Eigen::VectorXd FitParameters::of(const Superquadric& shape) {
    const auto size = [](double value) { return kLogSize.logit(std::log(std::max(value, kMinSize))); };
    Eigen::VectorXd p(kCount);
    p << size(shape.sizes.x), size(shape.sizes.y), size(shape.sizes.z), kExponent.logit(shape.eta_exponent),
        kExponent.logit(shape.omega_exponent), shape.centre.x, shape.centre.y, shape.centre.z,
        shape.rotation.w, shape.rotation.x, shape.rotation.y, shape.rotation.z;
    return p;
}

Superquadric FitParameters::shape_of(const Eigen::VectorXd& p) {
    Superquadric shape;
    shape.sizes = {size_from(p[0]), size_from(p[1]), size_from(p[2])};
    shape.eta_exponent = kExponent.from(p[kEtaExponent]);
    shape.omega_exponent = kExponent.from(p[kOmegaExponent]);
    shape.centre = {p[kCentre], p[kCentre + 1], p[kCentre + 2]};
    shape.rotation =
        Rotation{p[kRotation], p[kRotation + 1], p[kRotation + 2], p[kRotation + 3]}.normalised();
    return shape;
}

int FitResiduals::operator()(const InputType& parameters, ValueType& residuals) const {
    const Superquadric shape = FitParameters::shape_of(parameters);
    for (std::size_t i = 0; i < points_.size(); ++i) {
        const Vec3d place = shape.to_frame(points_[i]);
        const double r = length(place);
        residuals[static_cast<Eigen::Index>(i)] = r > 0 ? r - r * shape.factor_to_surface(place) : 0;
    }
    return 0;
}

int FitResiduals::df(const InputType& parameters, JacobianType& jacobian) const {
    const Superquadric shape = FitParameters::shape_of(parameters);
    const double e1 = shape.eta_exponent, e2 = shape.omega_exponent;
    const Vec3d& a = shape.sizes;
    for (std::size_t i = 0; i < points_.size(); ++i) {
        auto row = jacobian.row(static_cast<Eigen::Index>(i));
        const Vec3d from_centre = points_[i] - shape.centre;
        const Vec3d place = shape.to_frame(points_[i]);
        const double r = length(place);
        if (r == 0) {
            row.setZero();
            continue;
        }
        const LogPowers powers(place, a, e1, e2);
        const LogSlopes log_f(powers, e1, e2);
        const double factor = std::exp(-e1 / 2 * powers.whole);
        const double per_log_f = r * factor * e1 / 2; // d residual / d ln F

        row[0] = -per_log_f * log_f.scaled.x * log_size_slope(a.x);
        row[1] = -per_log_f * log_f.scaled.y * log_size_slope(a.y);
        row[2] = -per_log_f * log_f.scaled.z * log_size_slope(a.z);
        row[FitParameters::kEtaExponent] =
            (per_log_f * log_f.eta_exponent + r * factor * powers.whole / 2) * kExponent.slope(e1);
        row[FitParameters::kOmegaExponent] = per_log_f * log_f.omega_exponent * kExponent.slope(e2);

        const Vec3d by_place = place * ((1 - factor) / r) + Vec3d{ratio_or_zero(log_f.scaled.x, place.x),
                                                                  ratio_or_zero(log_f.scaled.y, place.y),
                                                                  ratio_or_zero(log_f.scaled.z, place.z)} *
                                                                per_log_f;
        const Vec3d by_centre = -shape.rotation.apply(by_place);
        row[FitParameters::kCentre] = by_centre.x;
        row[FitParameters::kCentre + 1] = by_centre.y;
        row[FitParameters::kCentre + 2] = by_centre.z;
        const auto by_quaternion = slopes_by_quaternion(parameters, from_centre, place);
        for (std::size_t k = 0; k < 4; ++k)
            row[FitParameters::kRotation + static_cast<Eigen::Index>(k)] = dot(by_place, by_quaternion[k]);
    }
    return 0;
}

} // namespace echinus::rivals
