#include "render/painted_surface.hpp"

#include <echinus/error.hpp>
#include <echinus_render/render.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>

namespace echinus::render {

namespace {

void require_range(double value, double low, double high, const char* name) {
    if (value >= low && value <= high) return; // false for NaN, too
    std::ostringstream sentence;
    sentence << "View: " << name << " is " << value << ", but must lie in [" << low << ", " << high << "]";
    throw Error(ErrorCode::InvalidOptions, sentence.str());
}

void require_valid_view(const View& view, double aspect) {
    if (!is_finite(view.up) || length(view.up) == 0) {
        throw Error(ErrorCode::InvalidOptions, "View: the direction up must be finite and not zero");
    }
    require_range(view.azimuth_deg, -3600, 3600, "the azimuth");
    require_range(view.elevation_deg, -89, 89, "the elevation");
    require_range(view.vertical_field_deg, 1, 120, "the vertical field");
    require_range(view.margin, 0, 0.35, "the margin");
    require_range(view.footer, 0, 0.25, "the footer");
    require_range(aspect, 1e-3, 1e3, "the picture's width over its height");
}

double to_radians(double degrees) {
    return degrees * std::numbers::pi / 180;
}

Vec3d unit(const Vec3d& v) {
    return v * (1 / length(v));
}

/// The axis from which azimuths are measured: the one that follows the largest part of `up` in the order x,
/// y, z, x.
Vec3d azimuth_axis(const Vec3d& up) {
    const Vec3d size{std::abs(up.x), std::abs(up.y), std::abs(up.z)};
    if (size.z >= size.x && size.z >= size.y) return {1, 0, 0};
    return size.y >= size.x ? Vec3d{0, 0, 1} : Vec3d{0, 1, 0};
}

/// A camera at the origin with the view's orientation.
Camera aim(const View& view) {
    const Vec3d up = unit(view.up);
    const Vec3d east = unit(azimuth_axis(up) - up * dot(up, azimuth_axis(up)));
    const Vec3d north = cross(up, east);
    const double azimuth = to_radians(view.azimuth_deg);
    const double elevation = to_radians(view.elevation_deg);
    const Vec3d level = east * std::cos(azimuth) + north * std::sin(azimuth);
    Camera camera;
    camera.world_up = up;
    camera.forward = -(level * std::cos(elevation) + up * std::sin(elevation));
    camera.right = unit(cross(camera.forward, up));
    camera.up = cross(camera.right, camera.forward);
    camera.tan_half_height = std::tan(to_radians(view.vertical_field_deg) / 2);
    return camera;
}

/// Fits the wedge that a camera sees along one axis of the picture to a set of points (x, z), where z is the
/// depth: -t_low (z - z0) <= x - x0 <= t_high (z - z0). Two sums bound x0 and z0 from both sides.
class WedgeFit {
  public:
    WedgeFit(double tan_low, double tan_high) : tan_low_(tan_low), tan_high_(tan_high) {}

    void add(double x, double z) {
        high_ = std::max(high_, x - tan_high_ * z);
        low_ = std::max(low_, -x - tan_low_ * z);
    }
    /// The largest z0 for which the wedge contains all points.
    double nearest_apex_z() const { return -(high_ + low_) / (tan_high_ + tan_low_); }
    /// For a z0 no larger than that, the midpoint of the range of x0 for which the wedge contains all points.
    double apex_x(double z0) const { return (high_ - low_ + (tan_high_ - tan_low_) * z0) / 2; }

  private:
    double tan_low_, tan_high_;
    double high_ = -std::numeric_limits<double>::infinity();
    double low_ = -std::numeric_limits<double>::infinity();
};

} // namespace

Camera camera_for(std::span<const Vec3f> points, const View& view, double aspect) {
    require_valid_view(view, aspect);
    if (!std::all_of(points.begin(), points.end(), [](const Vec3f& point) { return is_finite(point); })) {
        throw Error(ErrorCode::InvalidMesh, "a point to be drawn is not finite");
    }
    const Sphere bounds = smallest_enclosing_sphere(points);
    if (bounds.radius == 0) {
        throw Error(ErrorCode::InvalidMesh,
                    "all points to be drawn lie on one point; there is nothing to see");
    }

    Camera camera = aim(view);
    const double upper = camera.tan_half_height * (1 - 2 * view.margin);
    const double lower = camera.tan_half_height * (1 - 2 * view.margin - 2 * view.footer);
    const double side = camera.tan_half_height * std::max(aspect - 2 * view.margin, 0.1 * aspect);
    WedgeFit across(side, side);
    WedgeFit along(lower, upper);
    camera.floor_height = std::numeric_limits<double>::infinity();
    for (const Vec3f& point : points) {
        const Vec3d relative = Vec3d(point) - bounds.centre;
        const double depth = dot(relative, camera.forward);
        across.add(dot(relative, camera.right), depth);
        along.add(dot(relative, camera.up), depth);
        camera.floor_height = std::min(camera.floor_height, dot(Vec3d(point), camera.world_up));
    }
    const double depth = std::min(across.nearest_apex_z(), along.nearest_apex_z());
    camera.position = bounds.centre + camera.right * across.apex_x(depth) + camera.up * along.apex_x(depth) +
                      camera.forward * depth;
    return camera;
}

Camera camera_for(std::span<const RenderedObject> objects, const View& view, double aspect) {
    return camera_for(used_points(objects), view, aspect);
}

} // namespace echinus::render
