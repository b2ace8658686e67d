// What every system pays: the stream of particles, and one look into a table.

#include "systems/ways.hpp"

#include <cmath>

using namespace echinus;

namespace {

/// Is each particle nearer to the centre than the radius there?
/// @param radius  float (float x, float y, float z) by the direction from the centre
template <typename Radius>
void compare_with_radius(std::span<const Vec3f> points, Vec3f centre, Radius radius,
                         std::span<std::uint8_t> inside) {
    const std::size_t count = points.size();
    const Vec3f* const p = points.data();
    std::uint8_t* const out = inside.data();
#pragma omp simd
    for (std::size_t i = 0; i < count; ++i) {
        const float x = p[i].x - centre.x, y = p[i].y - centre.y, z = p[i].z - centre.z;
        const float r = radius(x, y, z);
        out[i] = x * x + y * y + z * z < r * r ? 1 : 0;
    }
}

/// Reads each particle and writes its byte: is it within the sphere that bounds the mesh?
struct Stream {
    Vec3f centre;
    float radius;

    explicit Stream(const Sphere& sphere)
        : centre(sphere.centre), radius(static_cast<float>(sphere.radius)) {}
    std::size_t byte_count() const { return 0; }
};

Ways stream_ways(const Stream& stream, std::size_t point_count) {
    return {way_of<std::uint8_t>("stream", point_count, [&](auto points, auto inside) {
        const float radius = stream.radius;
        compare_with_radius(
            points, stream.centre, [=](float, float, float) { return radius; }, inside);
    })};
}

/// A map of directions with one radius each: an octahedral square of 256 x 256 floats, the nearest sample,
/// one gather a particle. It answers for the sphere.
struct OneGather {
    static constexpr std::int32_t kSide = 256;
    Vec3f centre;
    std::vector<float> radii;

    explicit OneGather(const Sphere& sphere)
        : centre(sphere.centre), radii(kSide * kSide, static_cast<float>(sphere.radius)) {}
    std::size_t byte_count() const { return radii.size() * sizeof(float); }

    /// The octahedron unfolded into a square (Meyer et al. 2010, "On Floating-Point Normal Vectors").
    static std::int32_t sample_of(float x, float y, float z) {
        const float scale = 1 / (std::fabs(x) + std::fabs(y) + std::fabs(z) + 1e-30F);
        const float u = x * scale, v = y * scale;
        const float folded_u = z < 0 ? std::copysign(1 - std::fabs(v), u) : u;
        const float folded_v = z < 0 ? std::copysign(1 - std::fabs(u), v) : v;
        constexpr float kHalf = 0.4999F * static_cast<float>(kSide);
        const auto column = static_cast<std::int32_t>((folded_u + 1) * kHalf);
        const auto row = static_cast<std::int32_t>((folded_v + 1) * kHalf);
        return row * kSide + column;
    }
};

Ways one_gather_ways(const OneGather& map, std::size_t point_count) {
    return {way_of<std::uint8_t>("one gather", point_count, [&](auto points, auto inside) {
        const float* const radii = map.radii.data();
        const auto radius = [=](float x, float y, float z) { return radii[OneGather::sample_of(x, y, z)]; };
        compare_with_radius(points, map.centre, radius, inside);
    })};
}

} // namespace

void list_floors(const TriangleMesh& mesh, std::vector<System>& list) {
    const Sphere sphere = inspect(mesh).bounding_sphere;
    list.push_back(system_of(
        "floor", Role::Floor, [=] { return std::make_shared<Stream>(sphere); }, stream_ways));
    list.push_back(system_of(
        "floor", Role::Floor, [=] { return std::make_shared<OneGather>(sphere); }, one_gather_ways));
}
