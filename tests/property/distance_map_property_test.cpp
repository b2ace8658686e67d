#include "property/shape_parts.hpp"
#include "support/distance_maps.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <iterator>
#include <limits>

using namespace echinus;
using test::Choices;

// Random solids, distance maps of them and points, the same on every run.

namespace {

constexpr std::uint64_t kCases = 300;
constexpr int kPointCount = 60;

bool same(const Vec3f& a, const Vec3f& b) {
    using Bits = std::array<std::uint32_t, 3>;
    return std::bit_cast<Bits>(a) == std::bit_cast<Bits>(b);
}

/// A solid without self-intersections: each vertex of a sphere is moved, but not past its neighbours' rays.
/// Only its poles reach the bounding sphere, so that centre 0 and radius 1 hold without rounding. The other
/// coordinates are multiples of 2^-12, so that translating by whole numbers and scaling by powers of two are
/// exact.
TriangleMesh random_star(Choices& choices) {
    const auto count = [&](int most) { return static_cast<std::uint32_t>(choices.between(3, most)); };
    const std::uint32_t meridians = count(13);
    TriangleMesh mesh = make_sphere(1, meridians, count(8));
    for (Vec3f& vertex : mesh.vertices) {
        if (std::fabs(vertex.z) > 0.9999F) continue;
        const auto jitter = [&] { return choices.within(-0.05, 0.05); };
        const double x = vertex.x + jitter(), y = vertex.y + jitter(), z = vertex.z + jitter();
        const double scale = choices.within(0.2, 0.9) * 4096;
        vertex = Vec3f(Vec3d{std::round(x * scale), std::round(y * scale), std::round(z * scale)} * 0x1p-12);
    }
    return mesh;
}

TriangleMesh random_solid(Choices& choices) {
    const auto count = [&](int least, int most) {
        return static_cast<std::uint32_t>(choices.between(least, most));
    };
    if (choices.chance(0.3)) return random_star(choices);
    if (choices.chance(0.5)) {
        const std::uint32_t around = count(3, 23);
        return make_torus(1, choices.between(1, 19) / 20.0, around, count(3, 11));
    }
    const auto edge = [&] { return std::ldexp(choices.between(1, 15), choices.between(-12, 0)); };
    const double x = edge(), y = edge();
    return make_box({x, y, edge()}, count(1, 3));
}

/// One solid or two apart, of any size. The centre may lie outside.
TriangleMesh random_mesh(Choices& choices) {
    TriangleMesh mesh = random_solid(choices);
    if (choices.chance(0.5)) test::append(mesh, test::moved(random_solid(choices), {40, 3, 1}));
    const auto size = static_cast<float>(std::ldexp(1, choices.between(-20, 20)));
    for (Vec3f& v : mesh.vertices) v *= size;
    return mesh;
}

DistanceMapOptions random_options(Choices& choices) {
    DistanceMapOptions options;
    options.longitude_count = static_cast<std::uint32_t>(choices.between(4, 39));
    options.colatitude_count = static_cast<std::uint32_t>(choices.between(4, 39));
    options.correction =
        choices.one_of(std::array{VertexCorrection::None, VertexCorrection::Paper, VertexCorrection::Signed});
    options.entry_format = choices.one_of(std::array{EntryFormat::Float32, EntryFormat::Unorm16});
    options.pole_axis = choices.one_of(std::array{PoleAxis::X, PoleAxis::Y, PoleAxis::Z});
    options.thread_count = 1;
    return options;
}

/// A map of a mesh or, as the steepest case, one of random entries.
DistanceMap random_map_or_noise(Choices& choices) {
    const DistanceMapOptions options = random_options(choices);
    if (choices.chance(0.7)) return DistanceMap::build(random_mesh(choices), options);
    return test::random_map_parts(options.entry_format, options.longitude_count, options.colatitude_count,
                                  static_cast<std::uint32_t>(choices.between(0, 1 << 30)))
        .map();
}

/// Any float, special values more often than the others.
float any_float(test::Choices& choices) {
    using Limits = std::numeric_limits<float>;
    constexpr float kOdd[] = {0.0F,
                              -0.0F,
                              Limits::denorm_min(),
                              Limits::min(),
                              Limits::max(),
                              Limits::infinity(),
                              Limits::quiet_NaN()};
    if (choices.chance(0.3)) return choices.one_of(kOdd);
    return std::bit_cast<float>(static_cast<std::uint32_t>(choices.within(0, 0x1p32)));
}

/// Points around a map, many of them at special places: on the pole axis and the seam, at the centre and very
/// near to it.
Vec3f point_about(const DistanceMapView& map, test::Choices& choices) {
    const auto coordinate = [&] { return static_cast<float>(choices.within(-1.1, 1.1)) * map.radius; };
    const float x = coordinate(), y = coordinate(), z = coordinate();
    const double kind = choices.within(0, 1);
    Vec3f d{x, y, z};
    if (kind < 0.05)
        d = {0, 0, z};
    else if (kind < 0.10)
        d = {x, 0, 0};
    else if (kind < 0.15)
        d = {x, std::copysign(0.0F, y), z};
    else if (kind < 0.20)
        d *= static_cast<float>(std::ldexp(1, -static_cast<int>(choices.within(0, 120))));
    else if (kind < 0.22)
        d = {};
    return map.centre + d;
}

template <typename Transform>
TriangleMesh transformed(TriangleMesh mesh, const Transform& transform) {
    for (Vec3f& vertex : mesh.vertices) vertex = transform(vertex);
    return mesh;
}

std::vector<float> entries_of(const DistanceMapView& map, std::uint32_t longitude, std::uint32_t colatitude) {
    const std::size_t d = std::size_t{colatitude} * map.longitude_count + longitude;
    std::vector<float> entries;
    for (std::uint32_t i = map.entry_offsets[d]; i < map.entry_offsets[d + 1]; ++i)
        entries.push_back(map.entry_format == EntryFormat::Float32
                              ? map.entries_float32[i]
                              : static_cast<float>(map.entries_unorm16[i]) * (map.radius / 65535));
    return entries;
}

/// Either no contact, or a finite one with a unit normal whose push-out lies on the particle's own ray, is as
/// long as the depth and leads out of the solid.
void require_sound(const DistanceMapView& map, const Vec3f& p, float margin, const Contact& c) {
    EXPECT_TRUE(c.inside == contains(map, p));
    EXPECT_TRUE(c.face == kNoIndex);
    if (!c.found()) {
        EXPECT_TRUE(same(c.point, p));
        EXPECT_TRUE(c.depth == 0 && same(c.normal, {}));
        return;
    }
    EXPECT_TRUE(is_finite(p) && is_finite(c.point) && is_finite(c.normal));
    EXPECT_TRUE(std::fabs(length(c.normal) - 1) < 1e-5F);
    EXPECT_TRUE((c.inside ? c.depth >= 0 : c.depth <= 0 && -c.depth <= margin));

    const Vec3d d = Vec3d(p) - Vec3d(map.centre);
    const Vec3d way = Vec3d(c.point) - Vec3d(p);
    const Vec3d from_centre = Vec3d(c.point) - Vec3d(map.centre);
    const double tolerance = 1e-6 * (length(Vec3d(map.centre)) + map.radius + length(d));
    EXPECT_TRUE(length(from_centre) <= map.radius + tolerance);
    EXPECT_TRUE(std::fabs(length(way) - std::fabs(c.depth)) <= tolerance);
    EXPECT_TRUE(length(cross(from_centre, d)) <= tolerance * length(d));
    if (c.depth > tolerance) EXPECT_TRUE(dot(Vec3d(c.normal), way) > 0);
    if (c.depth < -tolerance) EXPECT_TRUE(dot(Vec3d(c.normal), way) < 0);
}

} // namespace

TEST(DistanceMapProperty, EntriesAscendInTheSphereForEveryCorrection) {
    for (std::uint64_t seed = 0; seed < kCases; ++seed) {
        SCOPED_TRACE(seed);
        Choices choices(seed);
        const TriangleMesh mesh = random_mesh(choices);
        const DistanceMap map = DistanceMap::build(mesh, random_options(choices));
        const DistanceMapView& view = map;
        for (std::uint32_t j = 0; j < view.colatitude_count; ++j)
            for (std::uint32_t i = 0; i < view.longitude_count; ++i) {
                const auto entries = entries_of(view, i, j);
                ASSERT_TRUE(std::is_sorted(entries.begin(), entries.end()));
                if (!entries.empty())
                    ASSERT_TRUE(entries.front() >= 0 && entries.back() <= view.radius * (1 + 1e-6F));
            }
        ASSERT_LE(map.statistics().clamped_entries, map.statistics().corrected_entries);
    }
}

TEST(DistanceMapProperty, MovingMeshAndPointsTogetherChangesNoBit) {
    for (std::uint64_t seed = 0; seed < kCases; ++seed) {
        SCOPED_TRACE(seed);
        Choices choices(seed);
        const TriangleMesh star = random_star(choices);
        const DistanceMapOptions options = random_options(choices);
        const auto whole = [&] { return static_cast<float>(choices.between(-100, 100)); };
        const float x = whole(), y = whole();
        const Vec3f offset{x, y, whole()};
        const auto size = static_cast<float>(std::ldexp(1, choices.between(-30, 30)));
        const auto move = [&](const Vec3f& p) { return (p + offset) * size; };

        const DistanceMap still = DistanceMap::build(star, options);
        const DistanceMap moved = DistanceMap::build(transformed(star, move), options);
        ASSERT_TRUE(same(moved.view().centre, move(still.view().centre)));
        ASSERT_TRUE(std::ranges::equal(moved.view().entry_offsets, still.view().entry_offsets));
        for (int i = 0; i < kPointCount; ++i) {
            Vec3f p = point_about(still, choices) * 4096;
            p = Vec3f{std::round(p.x), std::round(p.y), std::round(p.z)} * 0x1p-12F;
            p += Vec3f{}; // a translation loses the sign of a zero
            const Contact a = contact(still, p, 0.25F);
            const Contact b = contact(moved, move(p), 0.25F * size);
            ASSERT_EQ(a.inside, b.inside);
            ASSERT_EQ(a.depth * size, b.depth);
            ASSERT_TRUE(same(a.normal, b.normal));
        }
    }
}

TEST(DistanceMapProperty, TurningTheMeshByAQuarterAboutThePoleTurnsTheMap) {
    for (std::uint64_t seed = 0; seed < kCases; ++seed) {
        SCOPED_TRACE(seed);
        Choices choices(seed);
        const TriangleMesh star = random_star(choices);
        DistanceMapOptions options = random_options(choices);
        options.longitude_count = 4 * static_cast<std::uint32_t>(choices.between(1, 9));
        options.pole_axis = PoleAxis::Z;
        options.correction = VertexCorrection::None; // a vertex on the pole is corrected at longitude 0
        const DistanceMap still = DistanceMap::build(star, options);
        const auto turn = [](const Vec3f& p) { return Vec3f{-p.y, p.x, p.z}; };
        const DistanceMap turned = DistanceMap::build(transformed(star, turn), options);
        for (std::uint32_t j = 0; j < options.colatitude_count; ++j)
            for (std::uint32_t i = 0; i < options.longitude_count; ++i) {
                const std::uint32_t quarter_on = (i + options.longitude_count / 4) % options.longitude_count;
                ASSERT_EQ(entries_of(turned, quarter_on, j), entries_of(still, i, j));
            }
    }
}

TEST(DistanceMapProperty, ContactsAreSoundAndAnyFloatsGetAFiniteAnswerOrNone) {
    for (std::uint64_t seed = 0; seed < kCases; ++seed) {
        SCOPED_TRACE(seed);
        Choices choices(seed);
        const DistanceMap map = random_map_or_noise(choices);
        for (int i = 0; i < kPointCount; ++i) {
            const float near = static_cast<float>(choices.within(0, 0.5)) * map.view().radius;
            const Vec3f about = point_about(map, choices);
            require_sound(map, about, near, contact(map, about, near));

            const float x = any_float(choices), y = any_float(choices);
            const Vec3f p{x, y, any_float(choices)};
            const float margin = any_float(choices);
            const Contact c = contact(map, p, margin);
            if (!is_finite(p))
                EXPECT_TRUE(!c.found() && !contains(map, p) && usable_sample_count(map, p) == 0);
            require_sound(map, p, margin > 0 ? margin : 0, c);
        }
        if (HasFailure()) return;
    }
}
