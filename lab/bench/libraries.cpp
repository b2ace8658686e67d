#include "rivals/bullet_mesh/bullet_mesh.hpp"
#include "rivals/common/closed_mesh.hpp"
#include "rivals/embree_tree/embree_tree.hpp"
#include "rivals/sparse_field/sparse_field.hpp"
#include "rivals/unshipped/unshipped.hpp"
#include "systems.hpp"

#include <cmath>

using namespace echinus;
using namespace echinus::rivals;

std::vector<BenchSystem> libraries_on(const Subject& subject) {
    const TriangleMesh& mesh = subject.mesh;
    std::vector<BenchSystem> list{
        bench_system("Embree", false, [&mesh] { return EmbreeTree::build(mesh, RaySides::FirstHit); }),
        bench_system("Embree parity", false, [&mesh] { return EmbreeTree::build(mesh); }),
    };
    if (subject.large) return list;
    list.push_back(bench_system("CGAL", false, [&mesh] { return cgal_tree(mesh); }));
    [[maybe_unused]] const double spacing = subject.radius * 2 / 200;
#ifdef ECHINUS_BENCH_OPENVDB
    const auto samples = static_cast<std::uint32_t>(std::lround(box_of(mesh).longest_side() / spacing)) + 1;
    list.push_back(bench_system("OpenVDB 2R/200", false,
                                [&mesh, samples] { return SparseField::with_samples(mesh, samples); }));
#endif
#ifdef ECHINUS_BENCH_NANOVDB
    list.push_back(
        bench_system("NanoVDB 2R/200", false, [&mesh, spacing] { return nano_field(mesh, spacing); }));
#endif
#ifdef ECHINUS_BENCH_BULLET
    list.push_back(bench_system("Bullet", false, [&mesh] { return BulletMesh::build(mesh); }));
#endif
#ifdef ECHINUS_BENCH_FCL
    list.push_back(bench_system("FCL", false, [&mesh] { return fcl_tree(mesh); }));
#endif
    return list;
}

std::vector<BenchSystem> labelling_libraries(const TriangleMesh& mesh) {
    std::vector<BenchSystem> list{
        bench_system("Embree", false, [&mesh] { return EmbreeTree::build_open(mesh, RaySides::FirstHit); }),
        bench_system("Embree parity", false, [&mesh] { return EmbreeTree::build_open(mesh); }),
    };
    if (inspect(mesh).closed)
        list.push_back(bench_system("CGAL", false, [&mesh] { return cgal_tree(mesh); }));
    return list;
}

std::vector<NamedTriangleRival> triangle_rivals(const TriangleMesh& model) {
    std::vector<NamedTriangleRival> list;
    list.push_back({"Embree", std::make_unique<const EmbreeTriangles>(model)});
    list.push_back({"CGAL", cgal_triangles(model)});
#ifdef ECHINUS_BENCH_FCL
    list.push_back({"FCL", fcl_triangles(model)});
#endif
    return list;
}
