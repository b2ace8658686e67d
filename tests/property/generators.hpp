#pragma once

#include "support/random_points.hpp"

#include <echinus/distance_map.hpp>

#include <rapidcheck.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <limits>

/// The inputs of the properties: random solids, maps of them and points. RapidCheck shrinks the counts; a
/// seed determines the details of a shape.
namespace echinus::test {

/// The same cases on every run. To search further: RC_PARAMS="seed=7 max_success=10000" test_property
[[maybe_unused]] inline const int kFixedSeed = setenv("RC_PARAMS", "seed=1", 0);

/// A solid without self-intersections: each vertex of a sphere is moved, but not past its neighbours' rays.
/// Only its poles reach the bounding sphere, so that centre 0 and radius 1 hold without rounding. The other
/// coordinates are multiples of 2^-12, so that translating by whole numbers and scaling by powers of two are
/// exact.
inline TriangleMesh random_star() {
    const auto meridians = *rc::gen::inRange<std::uint32_t>(3, 14).as("meridians");
    const auto parallels = *rc::gen::inRange<std::uint32_t>(3, 9).as("parallels");
    test::PortableRandom random(*rc::gen::arbitrary<std::uint32_t>().as("seed of the star"));
    TriangleMesh mesh = make_sphere(1, meridians, parallels);
    for (Vec3f& vertex : mesh.vertices) {
        if (std::fabs(vertex.z) > 0.9999F) continue;
        const auto jitter = [&] { return random.uniform(-0.05, 0.05); };
        const double x = vertex.x + jitter(), y = vertex.y + jitter(), z = vertex.z + jitter();
        const double scale = random.uniform(0.2, 0.9) * 4096;
        vertex = Vec3f(Vec3d{std::round(x * scale), std::round(y * scale), std::round(z * scale)} * 0x1p-12);
    }
    return mesh;
}

inline TriangleMesh random_torus() {
    const auto major = *rc::gen::inRange<std::uint32_t>(3, 24).as("segments around");
    const auto minor = *rc::gen::inRange<std::uint32_t>(3, 12).as("segments across");
    return make_torus(1, *rc::gen::inRange(1, 20).as("tube in twentieths") / 20.0, major, minor);
}

inline TriangleMesh random_box() {
    const auto edge = [] {
        return std::ldexp(*rc::gen::inRange(1, 16).as("edge"), *rc::gen::inRange(-12, 1).as("exponent"));
    };
    const double x = edge(), y = edge();
    return make_box({x, y, edge()}, *rc::gen::inRange<std::uint32_t>(1, 4).as("segments"));
}

inline TriangleMesh random_part() {
    switch (*rc::gen::inRange(0, 3).as("star, torus or box")) {
    case 0:
        return random_star();
    case 1:
        return random_torus();
    default:
        return random_box();
    }
}

/// One solid or two apart, of any size. The centre may lie outside.
inline TriangleMesh random_mesh() {
    TriangleMesh mesh = random_part();
    if (*rc::gen::arbitrary<bool>().as("two parts")) {
        const TriangleMesh other = random_part();
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        for (const Vec3f& v : other.vertices) mesh.vertices.push_back(v + Vec3f{40, 3, 1});
        for (const auto& [a, b, c] : other.faces) mesh.faces.push_back({a + first, b + first, c + first});
    }
    const auto size = static_cast<float>(std::ldexp(1, *rc::gen::inRange(-20, 21).as("log2 of the size")));
    for (Vec3f& v : mesh.vertices) v *= size;
    return mesh;
}

inline DistanceMapOptions random_options() {
    DistanceMapOptions options;
    options.longitude_count = *rc::gen::inRange<std::uint32_t>(4, 40).as("longitudes");
    options.colatitude_count = *rc::gen::inRange<std::uint32_t>(4, 40).as("colatitudes");
    options.correction =
        *rc::gen::element(VertexCorrection::None, VertexCorrection::Paper, VertexCorrection::Signed);
    options.entry_format = *rc::gen::element(EntryFormat::Float32, EntryFormat::Unorm16);
    options.pole_axis = *rc::gen::element(PoleAxis::X, PoleAxis::Y, PoleAxis::Z);
    options.thread_count = 1;
    return options;
}

/// Any float, special values more often than the others.
inline float any_float(test::PortableRandom& random) {
    using Limits = std::numeric_limits<float>;
    constexpr float kOdd[] = {0.0F,
                              -0.0F,
                              Limits::denorm_min(),
                              Limits::min(),
                              Limits::max(),
                              Limits::infinity(),
                              Limits::quiet_NaN()};
    if (random.uniform() < 0.3) return kOdd[static_cast<std::size_t>(random.uniform(0, std::size(kOdd)))];
    return std::bit_cast<float>(static_cast<std::uint32_t>(random.uniform(0, 0x1p32)));
}

/// Points around a map, many of them at special places: on the pole axis and the seam, at the centre and very
/// near to it.
inline Vec3f point_about(const DistanceMapView& map, test::PortableRandom& random) {
    const auto coordinate = [&] { return static_cast<float>(random.uniform(-1.1, 1.1)) * map.radius; };
    const float x = coordinate(), y = coordinate(), z = coordinate();
    const double kind = random.uniform();
    Vec3f d{x, y, z};
    if (kind < 0.05)
        d = {0, 0, z};
    else if (kind < 0.10)
        d = {x, 0, 0};
    else if (kind < 0.15)
        d = {x, std::copysign(0.0F, y), z};
    else if (kind < 0.20)
        d *= static_cast<float>(std::ldexp(1, -static_cast<int>(random.uniform(0, 120))));
    else if (kind < 0.22)
        d = {};
    return map.centre + d;
}

} // namespace echinus::test
