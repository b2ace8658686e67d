#include "rivals/superquadric_map/fit.hpp"

#include "rivals/superquadric_map/superquadric.hpp"

#include <echinus/error.hpp>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

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

namespace {

constexpr std::size_t kScoutPointCount = 200; // enough to tell good starts from bad ones
constexpr int kScoutEvaluations = 25;
constexpr int kEvaluations = 300;
constexpr std::size_t kFinalists = 3;

/// A change of unit and origin that brings the points to the origin with a spread of 1.
struct Normalisation {
    Vec3d centre;
    double scale = 0;

    explicit Normalisation(std::span<const Vec3d> points) {
        if (points.size() < kMinPointCount)
            throw Error(ErrorCode::InvalidMesh, "a superquadric takes " + std::to_string(kMinPointCount) +
                                                    " points or more to fit, not " +
                                                    std::to_string(points.size()));
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (!is_finite(points[i]))
                throw Error(ErrorCode::InvalidMesh, "point " + std::to_string(i) +
                                                        " of those to fit a superquadric to is not finite");
            centre += points[i] * (1.0 / static_cast<double>(points.size()));
        }
        for (const Vec3d& p : points) scale = std::max(scale, length(p - centre));
        constexpr double kRounding = 1e-14; // of the mean
        if (!(scale > kRounding * length(centre)))
            throw Error(ErrorCode::InvalidMesh, "all points to fit a superquadric to are one and the same");
    }
    std::vector<Vec3d> apply(std::span<const Vec3d> points) const {
        std::vector<Vec3d> result;
        result.reserve(points.size());
        for (const Vec3d& p : points) result.push_back((p - centre) * (1 / scale));
        return result;
    }
    Superquadric undo(Superquadric shape) const {
        shape.centre = shape.centre * scale + centre;
        shape.sizes *= scale;
        return shape;
    }
};

/// Right-handed axes, the one of least spread first.
Eigen::Matrix3d principal_axes(std::span<const Vec3d> points) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Vec3d& p : points) mean += Eigen::Vector3d(p.x, p.y, p.z);
    mean /= static_cast<double>(points.size());
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (const Vec3d& p : points) {
        const Eigen::Vector3d d = Eigen::Vector3d(p.x, p.y, p.z) - mean;
        covariance += d * d.transpose();
    }
    Eigen::Matrix3d axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvectors();
    if (axes.determinant() < 0) axes.col(2) *= -1;
    return axes;
}

/// A shape in the given frame that spans the points' box there.
Superquadric spanning(std::span<const Vec3d> points, const Eigen::Matrix3d& axes, double exponent) {
    Superquadric shape;
    const Eigen::Quaterniond q(axes);
    shape.rotation = Rotation{q.w(), q.x(), q.y(), q.z()}.normalised();
    Vec3d low = shape.to_frame(points[0]), high = low;
    for (const Vec3d& p : points) {
        const Vec3d place = shape.to_frame(p);
        low = {std::min(low.x, place.x), std::min(low.y, place.y), std::min(low.z, place.z)};
        high = {std::max(high.x, place.x), std::max(high.y, place.y), std::max(high.z, place.z)};
    }
    shape.centre = shape.rotation.apply((low + high) * 0.5);
    shape.sizes = (high - low) * 0.5;
    shape.eta_exponent = shape.omega_exponent = exponent;
    return shape;
}

std::vector<Superquadric> starts(std::span<const Vec3d> points) {
    const Eigen::Matrix3d axes = principal_axes(points);
    std::vector<Superquadric> result;
    for (const int z : {2, 0, 1})
        for (const double turn : {0.0, std::numbers::pi / 4}) {
            Eigen::Matrix3d frame;
            frame << axes.col((z + 1) % 3), axes.col((z + 2) % 3), axes.col(z);
            frame = frame * Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()).toRotationMatrix();
            for (const double exponent : {1.0, 0.4}) result.push_back(spanning(points, frame, exponent));
        }
    return result;
}

struct Candidate {
    Eigen::VectorXd parameters;
    double error; ///< sum of squares, divided by the number of points
};

Candidate refined(const Eigen::VectorXd& start, std::span<const Vec3d> points, int evaluations) {
    FitResiduals residuals(points);
    Eigen::LevenbergMarquardt<FitResiduals> search(residuals);
    search.setMaxfev(evaluations);
    search.setFtol(1e-10);
    search.setXtol(1e-10);
    Candidate result{start, 0};
    search.minimize(result.parameters);
    result.error = search.fnorm() * search.fnorm() / static_cast<double>(points.size());
    return result;
}

/// Every so many-th point.
std::vector<Vec3d> thinned(std::span<const Vec3d> points, std::size_t count) {
    std::vector<Vec3d> result;
    for (std::size_t i = 0; i < count; ++i) result.push_back(points[i * points.size() / count]);
    return result;
}

/// The best few of all starts after a few steps.
std::vector<Candidate> finalists(std::span<const Vec3d> points) {
    const std::vector<Vec3d> scouts = thinned(points, std::min(points.size(), kScoutPointCount));
    std::vector<Candidate> result;
    for (const Superquadric& start : starts(scouts))
        result.push_back(refined(FitParameters::of(start), scouts, kScoutEvaluations));
    std::ranges::stable_sort(result, {}, &Candidate::error);
    result.resize(std::min(result.size(), kFinalists));
    return result;
}

} // namespace

SuperquadricFit fit_superquadric(std::span<const Vec3d> points) {
    const Normalisation normalisation(points);
    const std::vector<Vec3d> normalised = normalisation.apply(points);
    std::vector<Candidate> results;
    for (const Candidate& finalist : finalists(normalised))
        results.push_back(refined(finalist.parameters, normalised, kEvaluations));
    const Candidate& best = *std::ranges::min_element(results, {}, &Candidate::error);

    SuperquadricFit fit;
    fit.shape = normalisation.undo(FitParameters::shape_of(best.parameters));
    fit.root_mean_square = std::sqrt(best.error) * normalisation.scale;
    for (const Vec3d& p : points) {
        const double distance = p == fit.shape.centre ? 0 : std::fabs(fit.shape.radial_distance(p));
        fit.mean += distance / static_cast<double>(points.size());
        fit.largest = std::max(fit.largest, distance);
    }
    return fit;
}

} // namespace echinus::rivals
