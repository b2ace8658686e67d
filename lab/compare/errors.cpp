#include "compare/errors.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace echinus::comparison {

namespace {

/// R. Floats have steps of 6e-8 R there: below half a degree of this.
constexpr double kFarEnoughForAWay = 1e-5;

Spread spread_of(std::vector<double> errors) {
    if (errors.empty()) return {};
    std::ranges::sort(errors);
    const auto count = static_cast<double>(errors.size());
    Spread spread{errors.size(), 0, errors[static_cast<std::size_t>(0.99 * (count - 1))], errors.back()};
    for (const double error : errors) spread.mean += error / count;
    return spread;
}

/// Between two directions of about unit length, in degrees. By both products, since the arc cosine alone does
/// not resolve angles below a thousandth of a degree.
double angle_between(const Vec3f& a, const Vec3f& b) {
    if (length(a) == 0) return 90;
    const double angle = std::atan2(length(cross(Vec3d(a), Vec3d(b))), dot(Vec3d(a), Vec3d(b)));
    return angle * 180 / std::numbers::pi;
}

} // namespace

ErrorSummary errors_of(const Truth& truth, double radius, const Answers& answers, double undecided) {
    ErrorSummary summary;
    summary.asked_count = answers.asked.size();
    std::size_t wrong_count = 0;
    std::vector<double> depth_errors, angles;
    for (std::size_t i = 0; i < answers.asked.size(); ++i) {
        const std::uint32_t particle = answers.asked[i];
        const bool is_inside = truth.inside[particle] != 0, said_inside = answers.inside[i] != 0;
        const double distance = double{truth.distance[particle]} / radius;
        if (said_inside != is_inside && distance >= undecided) {
            ++wrong_count;
            summary.farthest_wrong = std::max(summary.farthest_wrong, distance);
        }
        if (!is_inside || answers.depth.empty()) continue;
        const double depth = said_inside ? double{answers.depth[i]} / radius : 0;
        depth_errors.push_back(std::fabs(depth - distance));
        if (said_inside && !truth.way_out.empty() && distance >= kFarEnoughForAWay)
            angles.push_back(angle_between(answers.normal[i], truth.way_out[particle]));
    }
    if (summary.asked_count > 0)
        summary.wrong_share = static_cast<double>(wrong_count) / static_cast<double>(summary.asked_count);
    summary.depth = spread_of(std::move(depth_errors));
    summary.normal = spread_of(std::move(angles));
    return summary;
}

} // namespace echinus::comparison
