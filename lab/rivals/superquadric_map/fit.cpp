#include "rivals/superquadric_map/fit.hpp"

#include "rivals/superquadric_map/fit_residuals.hpp"

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
