#include "support/distance_maps.hpp"
#include "support/instruction_sets.hpp"
#include "support/random_points.hpp"
#include "support/samples.hpp"

#include <echinus/distance_map.hpp>

#include <gtest/gtest.h>

#include <bit>
#include <limits>
#include <string>

using namespace echinus;

namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

bool same_bits(float a, float b) {
    return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b) || (a != a && b != b);
}

bool same_bits(const Vec3f& a, const Vec3f& b) {
    return same_bits(a.x, b.x) && same_bits(a.y, b.y) && same_bits(a.z, b.z);
}

bool same_bits(const Contact& a, const Contact& b) {
    return same_bits(a.point, b.point) && same_bits(a.normal, b.normal) && same_bits(a.depth, b.depth) &&
           a.face == b.face && a.inside == b.inside && a.certain == b.certain && a.feature == b.feature;
}

/// Particles around a map and at all special places: centre, axes, seam, poles, far away, not finite.
std::vector<Vec3f> particles_about(const DistanceMapView& map, std::size_t random_count) {
    std::vector<Vec3f> points;
    const float r = map.radius;
    const float kOdd[] = {0.0F, -0.0F,     1e-30F,   1e-6F * r,  0.5F * r, r,
                          -r,   -0.5F * r, 1e4F * r, -1e-6F * r, -1e-30F};
    for (float x : kOdd)
        for (float y : kOdd)
            for (float z : kOdd) points.push_back(map.centre + Vec3f{x, y, z});
    points = test::sampled(points);
    for (float bad : {kNaN, kInfinity, -kInfinity, std::numeric_limits<float>::max(),
                      std::numeric_limits<float>::denorm_min()})
        for (const Vec3f& p : {Vec3f{bad, 0, 0}, Vec3f{0, bad, 0}, Vec3f{0, 0, bad}, Vec3f{bad, bad, bad}})
            points.push_back(p);
    test::Random random(7);
    for (std::size_t i = 0; i < random_count; i += test::kSampleStride)
        points.push_back(map.centre + test::in_cube(random, 1.1F * r));
    // Along the seam and around the poles, where a grid of directions closes.
    for (std::size_t i = 0; i < random_count / 8; i += test::kSampleStride) {
        const Vec3f p = test::in_cube(random, r);
        const float tiny = 0.01F * p.z;
        for (const Vec3f& d :
             {Vec3f{p.x, 0.01F * p.y, p.z}, Vec3f{0.01F * p.x, p.y, p.z}, Vec3f{p.x, p.y, tiny},
              Vec3f{p.x * 0.01F, p.y * 0.01F, p.z}, Vec3f{p.x, p.y * 0.01F, tiny}})
            points.push_back(map.centre + d);
    }
    return points;
}

void expect_batches_as_single_particles(const DistanceMapView& map, const std::string& what,
                                        std::size_t random_count = 4000) {
    const std::vector<Vec3f> points = particles_about(map, random_count);
    test::under_each_instruction_set([&](std::string_view name) {
        std::vector<std::uint8_t> inside(points.size());
        contains_batch(map, points, inside);
        for (std::size_t i = 0; i < points.size(); ++i)
            ASSERT_EQ(inside[i], contains(map, points[i]) ? 1 : 0) << what << ' ' << name << ' ' << i;
        for (float margin : {0.0F, 0.1F * map.radius, kInfinity, -1.0F, kNaN}) {
            std::vector<Contact> contacts(points.size());
            contacts_batch(map, points, margin, contacts);
            for (std::size_t i = 0; i < points.size(); ++i)
                ASSERT_TRUE(same_bits(contacts[i], contact(map, points[i], margin)))
                    << what << ' ' << name << ' ' << i << ' ' << margin;
        }
    });
}

} // namespace

TEST(DistanceMapBatch, HasTheBitsOfSingleParticlesOnMapsOfMeshes) {
    const TriangleMesh box = make_box({2, 3, 4});
    const TriangleMesh torus = make_torus(1, 0.4, 60, 24);
    for (const TriangleMesh* mesh : {&box, &torus})
        for (EntryFormat format : {EntryFormat::Float32, EntryFormat::Unorm16})
            for (PoleAxis axis : {PoleAxis::X, PoleAxis::Y, PoleAxis::Z})
                for (VertexCorrection correction :
                     {VertexCorrection::None, VertexCorrection::Paper, VertexCorrection::Signed}) {
                    const DistanceMap map = DistanceMap::build(*mesh, {.longitude_count = 40,
                                                                       .colatitude_count = 30,
                                                                       .correction = correction,
                                                                       .entry_format = format,
                                                                       .pole_axis = axis});
                    expect_batches_as_single_particles(map, mesh == &box ? "box" : "torus", 1000);
                }
}

TEST(DistanceMapBatch, HasTheBitsOfSingleParticlesOnMapsOfOtherGrids) {
    const TriangleMesh box = make_box({2, 3, 4});
    const TriangleMesh torus = make_torus(1, 0.4, 60, 24);
    for (const TriangleMesh* mesh : {&box, &torus})
        for (EntryFormat format : {EntryFormat::Float32, EntryFormat::Unorm16})
            for (DirectionGrid grid :
                 {DirectionGrid::Octahedral, DirectionGrid::Cube, DirectionGrid::Ellipsoidal})
                for (std::uint32_t count : {4U, 5U, 20U})
                    for (VertexCorrection correction :
                         {VertexCorrection::None, VertexCorrection::Paper, VertexCorrection::Signed}) {
                        const DistanceMap map = DistanceMap::build(*mesh, {.grid = grid,
                                                                           .longitude_count = count,
                                                                           .colatitude_count = 2 * count,
                                                                           .divisions = count,
                                                                           .correction = correction,
                                                                           .entry_format = format});
                        expect_batches_as_single_particles(map, mesh == &box ? "box" : "torus", 1000);
                    }
}

TEST(DistanceMapBatch, HasTheBitsOfSingleParticlesOnAnySoundMap) {
    for (std::uint32_t seed = 0; seed < 12; ++seed) {
        const EntryFormat format = seed % 2 == 0 ? EntryFormat::Float32 : EntryFormat::Unorm16;
        const std::uint32_t size = 4 + seed * 3;
        const DistanceMap map = test::random_map_parts(format, size, size + seed % 3, seed).map();
        expect_batches_as_single_particles(map, "random map " + std::to_string(seed), 1000);
        for (const DirectionGrid grid : test::kEveryGrid) {
            const DistanceMap other = test::random_map_parts(format, grid, 4 + seed, seed).map();
            expect_batches_as_single_particles(
                other, std::string("random map, ") + test::name_of(grid) + ' ' + std::to_string(seed), 1000);
        }
    }
}

TEST(DistanceMapBatch, HasTheBitsOfSingleParticlesOnMapsWithHardlyAnyEntriesAndWithMany) {
    for (const bool centre_inside : {false, true}) {
        test::HandMadeMap map(8, 4, centre_inside);
        expect_batches_as_single_particles(map.view(), "no entry", 100);
        map.entries(7, 3) = {0.5F};
        expect_batches_as_single_particles(map.view(), "an entry", 100);
        map.entries(0, 0) = {0.25F, 0.5F, 0.75F};
        expect_batches_as_single_particles(map.view(), "four entries", 100);
        map.fill({0.1F, 0.2F, 0.3F, 0.4F, 0.5F, 0.6F, 0.7F});
        map.entries(3, 2) = {0.25F, 0.5F, 0.75F, 0.8F, 0.9F};
        expect_batches_as_single_particles(map.view(), "many entries", 100);
        map.fill({0.0F, 0.0F});
        expect_batches_as_single_particles(map.view(), "entries at the centre", 100);
    }
}

TEST(DistanceMapBatch, HasTheBitsOfSingleParticlesForEachSizeAndStride) {
    const DistanceMap map = DistanceMap::build(make_torus(1, 0.4, 60, 24));
    struct Vertex {
        float weight;
        Vec3f position;
        std::uint32_t colour;
    };
    std::vector<Vertex> vertices;
    test::Random random(8);
    for (int i = 0; i < 600; ++i) vertices.push_back({1, test::in_cube(random, 1.4F), 0});
    std::vector<Vec3f> packed;
    for (const Vertex& vertex : vertices) packed.push_back(vertex.position);
    test::under_each_instruction_set([&](std::string_view name) {
        for (std::size_t size = 0; size <= vertices.size(); size += size < 70 ? 1 : 53) {
            const StridedSpan<const Vec3f> strided(&vertices.front().position, size, sizeof(Vertex));
            const StridedSpan<const Vec3f> dense(packed.data(), size);
            for (const StridedSpan<const Vec3f>& points : {strided, dense}) {
                // One answer more than there are particles; it must stay unchanged.
                std::vector<std::uint8_t> inside(size + 1, 77);
                std::vector<Contact> contacts(size + 1);
                contacts.back().face = 77;
                contains_batch(map, points, std::span(inside).first(size));
                contacts_batch(map, points, 0.05F, std::span(contacts).first(size));
                for (std::size_t i = 0; i < size; ++i) {
                    ASSERT_EQ(inside[i], contains(map, packed[i]) ? 1 : 0) << name << ' ' << size;
                    ASSERT_TRUE(same_bits(contacts[i], contact(map, packed[i], 0.05F)))
                        << name << ' ' << size;
                }
                ASSERT_EQ(inside.back(), 77);
                ASSERT_EQ(contacts.back().face, 77U);
            }
        }
    });
}

TEST(DistanceMapBatch, HasTheSameBitsOnAnyNumberOfThreads) {
    for (const DirectionGrid grid : test::kEveryGrid) {
        const DistanceMap map = DistanceMap::build(make_torus(1, 0.4, 60, 24), {.grid = grid});
        test::Random random(9);
        std::vector<Vec3f> points(150'001); // enough for several threads
        for (Vec3f& p : points) p = test::in_cube(random, 1.4F);
        std::vector<std::uint8_t> inside(points.size());
        std::vector<Contact> contacts(points.size());
        contains_batch(map, points, inside, 1);
        contacts_batch(map, points, 0.05F, contacts, 1);
        for (const unsigned thread_count : {0U, 2U, 3U}) {
            std::vector<std::uint8_t> other_inside(points.size());
            std::vector<Contact> other_contacts(points.size());
            contains_batch(map, points, other_inside, thread_count);
            contacts_batch(map, points, 0.05F, other_contacts, thread_count);
            ASSERT_EQ(inside, other_inside);
            for (std::size_t i = 0; i < points.size(); ++i)
                ASSERT_TRUE(same_bits(contacts[i], other_contacts[i])) << i;
        }
    }
}
