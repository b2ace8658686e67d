#include "mesh/local_frame.hpp"

#include "files/text.hpp"
#include "geometry/box.hpp"

#include <echinus/error.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace echinus {

namespace {

/// The largest rounding error, as a share of half the longest side of the box: 3e-5.
constexpr double kMostRounding = 0x1p-15;

Vec3d origin_of(const AlignedBox<double>& box) {
    const double half_side = box.sides().*box.longest_axis() / 2;
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
    AlignedBox<double> box;
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
                what + " is located around (" + number_text(origin.x) + ", " + number_text(origin.y) + ", " +
                    number_text(origin.z) +
                    "), too far from 0 for the floats of a simulation; move its mesh, and everything "
                    "around it, to 0");
}

TriangleMesh local_mesh(std::span<const Vec3d> positions, std::vector<Triangle> faces) {
    const std::span<const std::uint32_t> corners(faces.empty() ? nullptr : faces[0].data(), 3 * faces.size());
    LocalPositions local = to_local_frame(positions, corners);
    return {std::move(local.positions), std::move(faces), local.origin};
}

} // namespace echinus
