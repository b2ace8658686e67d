#include "render/painted_surface.hpp"

#include <echinus/error.hpp>
#include <echinus/render.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace echinus {

namespace {

void require_range(double value, double low, double high, const char* name) {
    if (value >= low && value <= high) return; // false for NaN, too
    throw Error(ErrorCode::InvalidOptions, std::string("View: ") + name + " is " + std::to_string(value) +
                                               ", but must lie in [" + std::to_string(low) + ", " +
                                               std::to_string(high) + "]");
}

void require_valid_view(const View& view, double aspect) {
    if (!is_finite(view.up) || length(view.up) == 0) {
        throw Error(ErrorCode::InvalidOptions, "View: the direction up must be finite and not zero");
    }
    require_range(view.azimuth_deg, -3600, 3600, "the azimuth");
    require_range(view.elevation_deg, -89, 89, "the elevation");
    require_range(view.vertical_field_deg, 1, 120, "the vertical field");
    require_range(view.margin, 0, 0.4, "the margin");
    require_range(aspect, 1e-3, 1e3, "the picture's width over its height");
}

double to_radians(double degrees) {
    return degrees * std::numbers::pi / 180;
}

Vec3d unit(const Vec3d& v) {
    return v * (1 / length(v));
}

/// The axis from which azimuths count: the one that follows the largest part of `up` in the order x, y, z, x.
Vec3d azimuth_axis(const Vec3d& up) {
    const Vec3d size{std::abs(up.x), std::abs(up.y), std::abs(up.z)};
    if (size.z >= size.x && size.z >= size.y) return {1, 0, 0};
    return size.y >= size.x ? Vec3d{0, 0, 1} : Vec3d{0, 1, 0};
}

/// A camera at the origin that looks the right way.
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

/// How far a wedge |x - x0| <= t (z - z0) must reach to hold a set of points given as (x, z): the two values
/// that bound x0 and z0 from both sides.
class WedgeFit {
  public:
    explicit WedgeFit(double tan_half) : tan_half_(tan_half) {}

    void add(double x, double z) {
        right_ = std::max(right_, x - tan_half_ * z);
        left_ = std::max(left_, -x - tan_half_ * z);
    }
    /// The largest z0 that holds all points.
    double apex_z() const { return -(right_ + left_) / (2 * tan_half_); }
    /// The x0 that leaves as much room on one side as on the other, for any z0.
    double apex_x() const { return (right_ - left_) / 2; }

  private:
    double tan_half_;
    double right_ = -std::numeric_limits<double>::infinity();
    double left_ = -std::numeric_limits<double>::infinity();
};

} // namespace

Camera frame(std::span<const Vec3f> points, const View& view, double aspect) {
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
    const double tan_used = camera.tan_half_height * (1 - 2 * view.margin);
    const double side_room = aspect - 2 * view.margin; // the border is as wide at the sides
    WedgeFit across(camera.tan_half_height * std::max(side_room, 0.1 * aspect));
    WedgeFit along(tan_used);
    camera.floor_height = std::numeric_limits<double>::infinity();
    for (const Vec3f& point : points) {
        const Vec3d relative = Vec3d(point) - bounds.centre;
        const double depth = dot(relative, camera.forward);
        across.add(dot(relative, camera.right), depth);
        along.add(dot(relative, camera.up), depth);
        camera.floor_height = std::min(camera.floor_height, dot(Vec3d(point), camera.world_up));
    }
    const double depth = std::min(across.apex_z(), along.apex_z());
    camera.position =
        bounds.centre + camera.right * across.apex_x() + camera.up * along.apex_x() + camera.forward * depth;
    return camera;
}

Camera frame(std::span<const RenderedObject> objects, const View& view, double aspect) {
    return frame(used_points(objects), view, aspect);
}

} // namespace echinus
