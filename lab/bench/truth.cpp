#include "truth.hpp"

#include "compare/turns.hpp"
#include "files/atomic_file.hpp"
#include "judges/exact_judge.hpp"
#include "judges/judge_trees.hpp"
#include "mesh/mesh_hash.hpp"

#include <fmt/format.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <functional>
#include <memory>
#include <thread>

using namespace echinus;
using comparison::JudgedSet;
using comparison::Truth;
namespace fs = std::filesystem;

namespace {

std::uint64_t hash_of(const Subject& subject, const JudgedSet& set) {
    return XXH64(set.points.data(), set.points.size() * sizeof(Vec3f), mesh_hash(subject.mesh, 1));
}

bool read_cached(const fs::path& path, Truth& truth) {
    std::ifstream file(path, std::ios::binary);
    file.read(reinterpret_cast<char*>(truth.inside.data()), std::ssize(truth.inside));
    file.read(reinterpret_cast<char*>(truth.distance.data()),
              std::ssize(truth.distance) * std::ptrdiff_t{sizeof(float)});
    return file.good() && file.peek() == std::ifstream::traits_type::eof();
}

void write_cached(const fs::path& path, const Truth& truth) {
    fs::create_directories(path.parent_path());
    AtomicFile file(path);
    file.write(truth.inside.data(), truth.inside.size());
    file.write(truth.distance.data(), truth.distance.size() * sizeof(float));
    file.commit();
}

std::vector<test::Corners> corners_of(const TriangleMesh& mesh) {
    std::vector<test::Corners> corners;
    for (const Triangle& face : mesh.faces)
        corners.push_back(
            {Vec3d(mesh.vertices[face[0]]), Vec3d(mesh.vertices[face[1]]), Vec3d(mesh.vertices[face[2]])});
    return corners;
}

std::function<bool(const Vec3f&)> judge_of_sides(const TriangleMesh& mesh, SideJudge side_judge) {
    if (side_judge == SideJudge::Parity)
        return [judge = std::make_shared<const test::ExactJudge>(mesh)](const Vec3f& p) {
            return judge->inside(p);
        };
    return [tree = std::make_shared<const test::SolidAngleTree>(mesh)](const Vec3f& p) {
        return tree->winding_number(Vec3d(p)) > 0.5;
    };
}

void find_truth(const Subject& subject, SideJudge side_judge, const JudgedSet& set, Truth& truth) {
    const std::function<bool(const Vec3f&)> is_inside = judge_of_sides(subject.mesh, side_judge);
    const test::DistanceTree tree(corners_of(subject.mesh));
    constexpr std::size_t kBatch = 4096;
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
        for (std::size_t begin = next.fetch_add(kBatch); begin < set.points.size();
             begin = next.fetch_add(kBatch))
            for (std::size_t i = begin; i < std::min(begin + kBatch, set.points.size()); ++i) {
                truth.inside[i] = is_inside(set.points[i]) ? 1 : 0;
                truth.distance[i] = static_cast<float>(tree.distance(Vec3d(set.points[i])));
            }
    };
    std::vector<std::jthread> others;
    for (unsigned i = 1; i < std::thread::hardware_concurrency(); ++i) others.emplace_back(work);
    work();
}

} // namespace

void judge(const Subject& subject, const fs::path& cache, JudgedSet& set, SideJudge side_judge) {
    const fs::path path =
        cache / fmt::format("{}_{}_{:016x}{}.truth", subject.name, set.name, hash_of(subject, set),
                            side_judge == SideJudge::Parity ? "" : "_winding");
    set.truth = {std::vector<std::uint8_t>(set.points.size()), std::vector<float>(set.points.size()), {}};
    if (read_cached(path, set.truth)) return;
    comparison::unpin();
    find_truth(subject, side_judge, set, set.truth);
    comparison::pin_to_one_core();
    write_cached(path, set.truth);
}
