#include "mesh/local_frame.hpp"

#include "geometry/number_text.hpp"

#include <echinus/error.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace echinus {

namespace {

/// Of half the longest side of the box: 3e-5.
constexpr double kMostRounding = 0x1p-15;

struct Box {
    Vec3d low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};

    void add(const Vec3d& p) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    double half_side() const { return std::max({high.x - low.x, high.y - low.y, high.z - low.z}) / 2; }
    double largest_coordinate() const { return std::max({-low.x, -low.y, -low.z, high.x, high.y, high.z}); }
};

Vec3d origin_of(const Box& box) {
    const double half_side = box.half_side();
    if (!(half_side > 0) || !(float_rounding(box.largest_coordinate()) > half_side * kMostRounding))
        return {};
    const double grid = std::ldexp(1, std::ilogb(half_side));
    const auto middle = [grid](double low, double high) {
        return std::round((low + (high - low) / 2) / grid) * grid + 0.0; // -0 becomes 0
    };
    return {middle(box.low.x, box.high.x), middle(box.low.y, box.high.y), middle(box.low.z, box.high.z)};
}

} // namespace

double float_rounding(double coordinate) {
    constexpr int kDigits = std::numeric_limits<float>::digits;
    constexpr double kLeast = std::numeric_limits<float>::denorm_min() / 2;
    return coordinate == 0 ? 0 : std::max(std::ldexp(1, std::ilogb(coordinate) - kDigits), kLeast);
}

LocalPositions to_local_frame(std::span<const Vec3d> positions, std::span<const std::uint32_t> used) {
    Box box;
    for (const std::uint32_t index : used)
        if (index < positions.size() && is_finite(positions[index])) box.add(positions[index]);
    LocalPositions local{{}, origin_of(box)};
    local.positions.reserve(positions.size());
    for (const Vec3d& position : positions) local.positions.push_back(to_local(position, local.origin));
    return local;
}

void move_to_origin(const Vec3d& origin, TriangleMesh& mesh) {
    if (origin == mesh.origin) return;
    for (Vec3f& vertex : mesh.vertices) vertex = to_local(Vec3d(vertex) + mesh.origin, origin);
    mesh.origin = origin;
}

void require_no_origin(const Vec3d& origin, const std::string& what) {
    if (origin == Vec3d{}) return;
    throw Error(ErrorCode::InvalidMesh,
                what + " stands around (" + number_text(origin.x) + ", " + number_text(origin.y) + ", " +
                    number_text(origin.z) +
                    "), too far from 0 for the floats of a simulation; move its mesh, and all that stands "
                    "there with it, to 0");
}

TriangleMesh local_mesh(std::span<const Vec3d> positions, std::vector<Triangle> faces) {
    const std::span<const std::uint32_t> corners(faces.empty() ? nullptr : faces[0].data(), 3 * faces.size());
    LocalPositions local = to_local_frame(positions, corners);
    return {std::move(local.positions), std::move(faces), local.origin};
}

} // namespace echinus
