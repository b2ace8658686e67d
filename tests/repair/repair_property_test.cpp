#include "support/meshes.hpp"

#include <echinus/mesh.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <random>
#include <string>
#include <utility>

using namespace echinus;
using namespace echinus::test;

namespace {

using Random = std::mt19937;

int below(Random& random, int count) {
    return static_cast<int>(random() % static_cast<unsigned>(count));
}

/// A box on a small grid. Each side is cut along one of its diagonals.
TriangleMesh random_block(Random& random) {
    std::array<std::array<float, 2>, 3> limits{};
    for (auto& [low, high] : limits) {
        low = static_cast<float>(below(random, 3));
        high = low + 1 + static_cast<float>(below(random, 2));
    }
    TriangleMesh mesh;
    for (std::size_t i = 0; i < 8; ++i)
        mesh.vertices.push_back({limits[0][i & 1], limits[1][i >> 1 & 1], limits[2][i >> 2 & 1]});
    const std::array<std::array<std::uint32_t, 4>, 6> sides{
        {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
    for (const auto& [a, b, c, d] : sides)
        if (below(random, 2) == 0)
            mesh.faces.insert(mesh.faces.end(), {{a, b, c}, {a, c, d}});
        else
            mesh.faces.insert(mesh.faces.end(), {{a, b, d}, {b, c, d}});
    return mesh;
}

/// Blocks that touch in sides, edges and corners, overlap, lie in each other or coincide, some inside out,
/// with common vertices.
TriangleMesh random_assembly(Random& random) {
    TriangleMesh mesh;
    const int count = 1 + below(random, 4);
    for (int i = 0; i < count; ++i) {
        TriangleMesh block = random_block(random);
        if (below(random, 5) == 0) block = turned_inside_out(block);
        mesh = joined({mesh, block});
        if (below(random, 6) == 0) mesh = joined({mesh, block});
    }
    mesh = weld(mesh);
    std::shuffle(mesh.faces.begin(), mesh.faces.end(), random);
    return mesh;
}

RepairOptions random_safe_options(Random& random) {
    RepairOptions options;
    options.drop_duplicate_faces = below(random, 2) == 0;
    options.drop_doubled_patches = below(random, 2) == 0;
    options.flip_inside_out = below(random, 2) == 0;
    options.close_seams = below(random, 2) == 0;
    options.drop_loose_slivers = below(random, 2) == 0;
    options.orient_faces = below(random, 2) == 0;
    return options;
}

/// Loses, doubles, turns and adds faces, and parts corners by less and more than maps resolve.
TriangleMesh damaged(TriangleMesh mesh, Random& random) {
    const int count = 1 + below(random, 5);
    for (int i = 0; i < count; ++i) {
        Triangle& face = mesh.faces[random() % mesh.faces.size()];
        switch (below(random, 6)) {
        case 0:
            if (mesh.faces.size() > 4) std::swap(face, mesh.faces.back()), mesh.faces.pop_back();
            break;
        case 1:
            mesh.faces.push_back(Triangle(face));
            break;
        case 2:
            std::swap(face[0], face[1]);
            break;
        case 3:
            mesh.vertices.push_back(mesh.vertices[face[0]] +
                                    Vec3f{0, 0, below(random, 2) == 0 ? 1e-7F : 1e-4F});
            face[0] = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
            break;
        case 4: {
            const auto any = [&] { return static_cast<std::uint32_t>(random() % mesh.vertices.size()); };
            mesh.faces.push_back({any(), any(), any()});
            break;
        }
        default: // a corner within an edge that only one of its faces has
            mesh.vertices.push_back((mesh.vertices[face[0]] + mesh.vertices[face[1]]) * 0.5F);
            const auto middle = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
            const Triangle rest{middle, face[1], face[2]};
            face[1] = middle;
            mesh.faces.push_back(rest);
        }
    }
    return mesh;
}

using Point = std::array<float, 3>;

/// How many more faces run one way along edges than the other, in total; corners at equal positions are one.
/// Shares no code with repair().
std::size_t total_imbalance(const TriangleMesh& mesh) {
    std::map<std::pair<Point, Point>, int> sums;
    const auto point = [&](std::uint32_t v) {
        return Point{mesh.vertices[v].x, mesh.vertices[v].y, mesh.vertices[v].z};
    };
    for (const Triangle& face : mesh.faces)
        for (std::size_t k = 0; k < 3; ++k) {
            const Point a = point(face[k]), b = point(face[(k + 1) % 3]);
            if (a < b) ++sums[{a, b}];
            if (b < a) --sums[{b, a}];
        }
    std::size_t total = 0;
    for (const auto& [edge, sum] : sums) total += static_cast<std::size_t>(std::abs(sum));
    return total;
}

std::string as_obj(const TriangleMesh& mesh) {
    std::string text;
    for (const Vec3f& p : mesh.vertices)
        text += "v " + std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z) + "\n";
    for (const Triangle& face : mesh.faces) {
        text += "f";
        for (const std::uint32_t v : face) text += " " + std::to_string(v + 1);
        text += "\n";
    }
    return text;
}

} // namespace

TEST(RepairProperty, NeverOpensAClosedMesh) {
    for (unsigned seed = 0; seed < 600; ++seed) {
        Random random(seed);
        const TriangleMesh mesh = random_assembly(random);
        ASSERT_EQ(total_imbalance(mesh), 0U);
        for (const RepairOptions& options : {RepairOptions::all(), random_safe_options(random)}) {
            const RepairedMesh repaired = repair(mesh, options);
            ASSERT_EQ(total_imbalance(repaired.mesh), 0U) << "seed " << seed << "\n" << as_obj(mesh);
            ASSERT_TRUE(inspect(repaired.mesh).closed) << "seed " << seed << "\n" << as_obj(mesh);
        }
    }
}

TEST(RepairProperty, NeverMakesADamagedMeshMoreOpen) {
    for (unsigned seed = 0; seed < 600; ++seed) {
        Random random(seed);
        const TriangleMesh mesh = damaged(random_assembly(random), random);
        for (const RepairOptions& options : {RepairOptions::all(), random_safe_options(random)}) {
            const RepairedMesh repaired = repair(mesh, options);
            ASSERT_LE(total_imbalance(repaired.mesh), total_imbalance(mesh)) << "seed " << seed << "\n"
                                                                             << as_obj(mesh);
        }
    }
}

TEST(RepairProperty, FindsNothingToMendInWhatItMended) {
    for (unsigned seed = 0; seed < 600; ++seed) {
        Random random(seed);
        const TriangleMesh mesh = damaged(random_assembly(random), random);
        const RepairedMesh once = repair(mesh, RepairOptions::all());
        const RepairedMesh twice = repair(once.mesh, RepairOptions::all());
        ASSERT_EQ(once.mesh.faces, twice.mesh.faces) << "seed " << seed << "\n" << as_obj(mesh);
        ASSERT_FALSE(twice.report.changed_anything()) << "seed " << seed;
        ASSERT_EQ(once.report.changed_anything(), once.mesh.faces != mesh.faces) << "seed " << seed;
    }
}

TEST(RepairProperty, GivesABlockBackThatWasTurnedDoubledAndTornApart) {
    for (unsigned seed = 0; seed < 300; ++seed) {
        Random random(seed);
        const TriangleMesh block = random_block(random);
        TriangleMesh mesh = block;
        for (Triangle& face : mesh.faces) {
            for (std::uint32_t& corner : face) {
                if (below(random, 4) != 0) continue;
                mesh.vertices.push_back(mesh.vertices[corner]);
                mesh.vertices.back().x += 1e-7F * static_cast<float>(below(random, 3));
                corner = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
            }
            if (below(random, 2) == 0) std::swap(face[0], face[1]);
        }
        const MeshReport report = inspect(repair(mesh, RepairOptions::all()).mesh);
        ASSERT_TRUE(report.closed && report.manifold) << "seed " << seed << "\n" << as_obj(mesh);
        ASSERT_NEAR(report.signed_volume, inspect(block).signed_volume, 1e-5) << "seed " << seed;
    }
}
