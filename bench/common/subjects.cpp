#include "common/subjects.hpp"

#include "rivals/compare/point_sets.hpp"

#include <echinus/mesh_io.hpp>

#include <fmt/format.h>

#include <cmath>
#include <cstdio>

using namespace echinus;
namespace fs = std::filesystem;

namespace {

constexpr std::size_t kLargeFrom = 20'000; // faces

Subject subject(std::string name, TriangleMesh mesh, bool z_is_up) {
    const double radius = inspect(mesh).bounding_sphere.radius;
    const bool large = mesh.faces.size() >= kLargeFrom;
    return {.name = std::move(name),
            .mesh = std::move(mesh),
            .radius = radius,
            .large = large,
            .z_is_up = z_is_up};
}

} // namespace

std::vector<ParticleSet> Subject::sets(std::size_t count) const {
    const auto side = static_cast<std::size_t>(std::sqrt(static_cast<double>(count)));
    const comparison::Axis up = z_is_up ? comparison::Axis::Z : comparison::Axis::Y;
    return {{"U", comparison::uniform_points(mesh, count)},
            {"S", comparison::surface_points(mesh, count)},
            {"C", comparison::cloth_points(mesh, side, side, up)}};
}

TriangleMesh torus_of(std::size_t face_count) {
    const auto minor_segments =
        static_cast<std::uint32_t>(std::lround(std::sqrt(static_cast<double>(face_count) / 5)));
    return make_torus(1, 0.4, minor_segments * 5 / 2, minor_segments);
}

Subject horse_subject(const fs::path& meshes, const fs::path& debian_horse) {
    if (fs::exists(meshes / "horse_6k.obj"))
        return subject("horse_6k", read_mesh(meshes / "horse_6k.obj"), true);
    return subject("horse", repair(read_mesh(debian_horse), RepairOptions::all()).mesh, false);
}

std::vector<std::function<Subject()>> subjects(const fs::path& meshes, const fs::path& debian_horse) {
    std::vector<std::function<Subject()>> result{
        [=] { return horse_subject(meshes, debian_horse); },
        [] { return subject("torus", make_torus(1, 0.4, 60, 24), true); }};
    if (fs::exists(meshes / "armadillo_52k.off"))
        result.emplace_back(
            [=] { return subject("armadillo_52k", read_mesh(meshes / "armadillo_52k.off"), false); });
    else
        fmt::print(stderr,
                   "{}: no development meshes there: Debian's horse instead of horse_6k, and no armadillo\n",
                   meshes.string());
    result.emplace_back([] { return subject("torus_1M", torus_of(1'000'000), true); });
    return result;
}
