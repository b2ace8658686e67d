#include "systems.hpp"

#include "rivals/classified_grid/classified_grid.hpp"
#include "rivals/dense_grid/dense_grid.hpp"
#include "rivals/maps/maps.hpp"

using namespace echinus;
using namespace echinus::rivals;

namespace {

/// The bytes that the paper gives for its map of the horse.
constexpr std::size_t kPaperBytes = 630'000;

BenchSystem distance(std::string name, const TriangleMesh& mesh, DirectionGrid grid) {
    DistanceMapOptions options;
    options.grid = grid;
    options.thread_count = 1;
    return bench_system(std::move(name), true, [&mesh, options] { return distance_map(mesh, options); });
}

BenchSystem dense(std::string name, const TriangleMesh& mesh, SampleFormat format) {
    return bench_system(std::move(name), false, [&mesh, format] {
        return DenseGrid::with_bytes(mesh, kPaperBytes, {.format = format});
    });
}

} // namespace

std::vector<BenchSystem> systems_on(const Subject& subject) {
    const TriangleMesh& mesh = subject.mesh;
    std::vector<BenchSystem> list{
        bench_system("exact map", true, [&mesh] { return exact_map(mesh, {.thread_count = 1}); }),
        distance("distance map", mesh, DirectionGrid::Spherical),
        distance("octahedral distance map", mesh, DirectionGrid::Octahedral),
    };
    // As many bytes as the exact map, which gives the same answers.
    const ExactMap map = ExactMap::build(mesh);
    list.push_back(bench_system("classified grid", false, [&mesh, bytes = map.view().byte_count()] {
        return ClassifiedGrid::build(mesh, bytes);
    }));
    list.push_back(dense("dense grid 0.63 MB", mesh, SampleFormat::Float32));
    list.push_back(dense("dense grid 0.63 MB 16 bit", mesh, SampleFormat::Snorm16));
    if (!subject.large) // as many samples across the bounding sphere as the paper's distance field has
        list.push_back(bench_system("dense grid 2R/200", false, [&mesh, spacing = subject.radius * 2 / 200] {
            return DenseGrid::with_spacing(mesh, spacing);
        }));
    for (BenchSystem& library : libraries_on(subject)) list.push_back(std::move(library));
    return list;
}
