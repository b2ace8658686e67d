#include "property/generators.hpp"
#include "support/distance_maps.hpp"

#include <echinus/map_file.hpp>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

using namespace echinus;

namespace {

constexpr int kPointCount = 60;

bool same(const Vec3f& a, const Vec3f& b) {
    using Bits = std::array<std::uint32_t, 3>;
    return std::bit_cast<Bits>(a) == std::bit_cast<Bits>(b);
}

bool same(const Contact& a, const Contact& b) {
    return a.inside == b.inside && a.face == b.face && same(a.point, b.point) && same(a.normal, b.normal) &&
           std::bit_cast<std::uint32_t>(a.depth) == std::bit_cast<std::uint32_t>(b.depth);
}

test::PortableRandom random_for_points() {
    return test::PortableRandom(*rc::gen::arbitrary<std::uint32_t>().as("seed of the points"));
}

DistanceMap random_map() {
    const TriangleMesh mesh = test::random_mesh();
    return DistanceMap::build(mesh, test::random_options());
}

/// A map of a mesh or, as the steepest case, one of random entries.
DistanceMap random_map_or_noise() {
    if (*rc::gen::inRange(0, 3).as("noise at 0") != 0) return random_map();
    const DistanceMapOptions options = test::random_options();
    return test::random_map_parts(options.entry_format, options.longitude_count, options.colatitude_count,
                                  *rc::gen::arbitrary<std::uint32_t>().as("seed of the entries"))
        .map();
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
    RC_ASSERT(c.inside == contains(map, p));
    RC_ASSERT(c.face == Contact::kUnknownFace);
    if (!c.found()) {
        RC_ASSERT(same(c.point, p));
        RC_ASSERT(c.depth == 0 && same(c.normal, {}));
        return;
    }
    RC_ASSERT(is_finite(p) && is_finite(c.point) && is_finite(c.normal));
    RC_ASSERT(std::fabs(length(c.normal) - 1) < 1e-5F);
    RC_ASSERT((c.inside ? c.depth >= 0 : c.depth <= 0 && -c.depth <= margin));

    const Vec3d d = Vec3d(p) - Vec3d(map.centre);
    const Vec3d way = Vec3d(c.point) - Vec3d(p);
    const Vec3d from_centre = Vec3d(c.point) - Vec3d(map.centre);
    const double tolerance = 1e-6 * (length(Vec3d(map.centre)) + map.radius + length(d));
    RC_ASSERT(length(from_centre) <= map.radius + tolerance);
    RC_ASSERT(std::fabs(length(way) - std::fabs(c.depth)) <= tolerance);
    RC_ASSERT(length(cross(from_centre, d)) <= tolerance * length(d));
    if (c.depth > tolerance) RC_ASSERT(dot(Vec3d(c.normal), way) > 0);
    if (c.depth < -tolerance) RC_ASSERT(dot(Vec3d(c.normal), way) < 0);
}

} // namespace

RC_GTEST_PROP(DistanceMapProperty, EveryRayOfAClosedMeshHasTheParityOfTheCentre, ()) {
    const TriangleMesh mesh = test::random_mesh();
    const DistanceMap map = DistanceMap::build(mesh, test::random_options());
    const DistanceMapView& view = map;
    RC_ASSERT(view.centre_inside == (winding_number(mesh, Vec3d(view.centre)) > 0.5));
    RC_ASSERT(map.statistics().wrong_parity_share == 0);
    for (std::size_t d = 0; d < view.direction_count(); ++d)
        RC_ASSERT((view.entry_offsets[d + 1] - view.entry_offsets[d]) % 2 == (view.centre_inside ? 1U : 0U));
}

RC_GTEST_PROP(DistanceMapProperty, EntriesAscendInTheSphereForEveryCorrection, ()) {
    const DistanceMap map = random_map();
    const DistanceMapView& view = map;
    for (std::uint32_t j = 0; j < view.colatitude_count; ++j)
        for (std::uint32_t i = 0; i < view.longitude_count; ++i) {
            const auto entries = entries_of(view, i, j);
            RC_ASSERT(std::is_sorted(entries.begin(), entries.end()));
            if (!entries.empty())
                RC_ASSERT(entries.front() >= 0 && entries.back() <= view.radius * (1 + 1e-6F));
        }
    RC_ASSERT(map.statistics().clamped_entries <= map.statistics().corrected_entries);
}

RC_GTEST_PROP(DistanceMapProperty, AnswersAreTheSameAfterSavingAndLoading, ()) {
    const DistanceMap map = random_map();
    const auto bytes = std::make_shared<const std::vector<std::byte>>(serialise(map));
    const auto loaded = std::get<DistanceMap>(load_map(*bytes, bytes, "bytes"));
    RC_ASSERT(loaded.source_hash() == map.source_hash());
    auto random = random_for_points();
    for (int i = 0; i < kPointCount; ++i) {
        const Vec3f p = test::point_about(map, random);
        RC_ASSERT(contains(loaded, p) == contains(map, p));
        RC_ASSERT(same(contact(loaded, p, map.view().radius), contact(map, p, map.view().radius)));
    }
}

RC_GTEST_PROP(DistanceMapProperty, BatchesAnswerAsSinglePointsDo, ()) {
    const DistanceMap map = random_map();
    auto random = random_for_points();
    const float margin = static_cast<float>(random.uniform(0, 0.5)) * map.view().radius;
    std::vector<Vec3f> points(static_cast<std::size_t>(*rc::gen::inRange(0, 50).as("points")));
    for (Vec3f& p : points) p = test::point_about(map, random);
    std::vector<std::uint8_t> inside(points.size(), 7);
    std::vector<Contact> contacts(points.size());
    contains_batch(map, points, inside);
    contacts_batch(map, points, margin, contacts);
    for (std::size_t i = 0; i < points.size(); ++i) {
        RC_ASSERT(inside[i] == (contains(map, points[i]) ? 1 : 0));
        RC_ASSERT(same(contacts[i], contact(map, points[i], margin)));
    }
}

RC_GTEST_PROP(DistanceMapProperty, MovingMeshAndPointsTogetherChangesNoBit, ()) {
    const TriangleMesh star = test::random_star();
    const DistanceMapOptions options = test::random_options();
    const auto whole = [] { return static_cast<float>(*rc::gen::inRange(-100, 101).as("offset")); };
    const float x = whole(), y = whole();
    const Vec3f offset{x, y, whole()};
    const auto size = static_cast<float>(std::ldexp(1, *rc::gen::inRange(-30, 31).as("log2 of the size")));
    const auto move = [&](const Vec3f& p) { return (p + offset) * size; };

    const DistanceMap still = DistanceMap::build(star, options);
    const DistanceMap moved = DistanceMap::build(transformed(star, move), options);
    RC_ASSERT(same(moved.view().centre, move(still.view().centre)));
    RC_ASSERT(std::ranges::equal(moved.view().entry_offsets, still.view().entry_offsets));
    auto random = random_for_points();
    for (int i = 0; i < kPointCount; ++i) {
        Vec3f p = test::point_about(still, random) * 4096;
        p = Vec3f{std::round(p.x), std::round(p.y), std::round(p.z)} * 0x1p-12F;
        p += Vec3f{}; // a translation loses the sign of a zero
        const Contact a = contact(still, p, 0.25F);
        const Contact b = contact(moved, move(p), 0.25F * size);
        RC_ASSERT(a.inside == b.inside);
        RC_ASSERT(a.depth * size == b.depth);
        RC_ASSERT(same(a.normal, b.normal));
    }
}

RC_GTEST_PROP(DistanceMapProperty, TurningTheMeshByAQuarterAboutThePoleTurnsTheMap, ()) {
    const TriangleMesh star = test::random_star();
    DistanceMapOptions options = test::random_options();
    options.longitude_count = 4 * *rc::gen::inRange<std::uint32_t>(1, 10).as("longitudes / 4");
    options.pole_axis = PoleAxis::Z;
    options.correction = VertexCorrection::None; // a vertex on the pole is corrected at longitude 0
    const DistanceMap still = DistanceMap::build(star, options);
    const auto turn = [](const Vec3f& p) { return Vec3f{-p.y, p.x, p.z}; };
    const DistanceMap turned = DistanceMap::build(transformed(star, turn), options);
    for (std::uint32_t j = 0; j < options.colatitude_count; ++j)
        for (std::uint32_t i = 0; i < options.longitude_count; ++i) {
            const std::uint32_t quarter_on = (i + options.longitude_count / 4) % options.longitude_count;
            const auto before = entries_of(still, i, j);
            const auto after = entries_of(turned, quarter_on, j);
            RC_ASSERT(after.size() == before.size());
            for (std::size_t k = 0; k < before.size(); ++k)
                RC_ASSERT(std::fabs(after[k] - before[k]) < 1e-5F);
            if (options.correction == VertexCorrection::None) RC_ASSERT(after == before);
        }
}

RC_GTEST_PROP(DistanceMapProperty, ContactsAreSound, ()) {
    const DistanceMap map = random_map_or_noise();
    auto random = random_for_points();
    for (int i = 0; i < kPointCount; ++i) {
        const float margin = static_cast<float>(random.uniform(0, 0.5)) * map.view().radius;
        const Vec3f p = test::point_about(map, random);
        require_sound(map, p, margin, contact(map, p, margin));
    }
}

RC_GTEST_PROP(DistanceMapProperty, AnyFloatsGetAFiniteAnswerOrNone, ()) {
    const DistanceMap map = random_map_or_noise();
    auto random = random_for_points();
    for (int i = 0; i < kPointCount; ++i) {
        const float x = test::any_float(random), y = test::any_float(random);
        const Vec3f p{x, y, test::any_float(random)};
        const float margin = test::any_float(random);
        const Contact c = contact(map, p, margin);
        if (!is_finite(p)) RC_ASSERT(!c.found() && !contains(map, p) && usable_sample_count(map, p) == 0);
        require_sound(map, p, margin > 0 ? margin : 0, c);
    }
}
