#include "subjects.hpp"

#include <echinus/mesh_io.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

using namespace echinus;
using test::Axis;
namespace fs = std::filesystem;

namespace {

constexpr std::size_t kLargeFrom = 20'000; // faces

Subject subject(std::string name, TriangleMesh mesh, Axis up) {
    const double radius = inspect(mesh).bounding_sphere.radius;
    const bool large = mesh.faces.size() >= kLargeFrom;
    return {std::move(name), std::move(mesh), radius, large, up};
}

} // namespace

std::vector<comparison::JudgedSet> Subject::sets(std::size_t count) const {
    const auto side = static_cast<std::size_t>(std::sqrt(static_cast<double>(count)));
    return {{"U", test::uniform_points(mesh, count), {}},
            {"S", test::surface_points(mesh, count), {}},
            {"C", test::cloth_points(mesh, side, side, up), {}}};
}

std::vector<comparison::JudgedSet> Subject::sets_for_calls(std::size_t count, std::size_t call_size) const {
    std::vector<comparison::JudgedSet> result = sets(count);
    for (comparison::JudgedSet& set : result) {
        const std::size_t calls = std::max<std::size_t>(1, set.points.size() / call_size);
        std::vector<Vec3f> dealt;
        for (std::size_t call = 0; call < calls; ++call)
            for (std::size_t i = call; i < set.points.size(); i += calls) dealt.push_back(set.points[i]);
        set.points = std::move(dealt);
    }
    return result;
}

TriangleMesh torus_of(std::size_t face_count) {
    const auto minor_segments =
        static_cast<std::uint32_t>(std::lround(std::sqrt(static_cast<double>(face_count) / 5)));
    return make_torus(1, 0.4, minor_segments * 5 / 2, minor_segments);
}

Subject public_horse(const fs::path& debian_horse) {
    return subject("horse", repair(read_mesh(debian_horse), RepairOptions::all()).mesh, Axis::Y);
}

Subject torus_subject() {
    return subject("torus", make_torus(1, 0.4, 60, 24), Axis::Z);
}

Subject first_subject(const fs::path& meshes, const fs::path& debian_horse) {
    if (fs::exists(meshes / "horse_6k.obj"))
        return subject("horse_6k", read_mesh(meshes / "horse_6k.obj"), Axis::Z);
    return public_horse(debian_horse);
}

std::vector<std::function<Subject()>> subjects(const fs::path& meshes, const fs::path& debian_horse) {
    std::vector<std::function<Subject()>> result{[=] { return first_subject(meshes, debian_horse); },
                                                 torus_subject};
    if (fs::exists(meshes / "armadillo_52k.off"))
        result.emplace_back(
            [=] { return subject("armadillo_52k", read_mesh(meshes / "armadillo_52k.off"), Axis::Y); });
    else
        fmt::print(stderr,
                   "{}: no development meshes there: Debian's horse instead of horse_6k, and no armadillo\n",
                   meshes.string());
    result.emplace_back([] { return subject("torus_1M", torus_of(1'000'000), Axis::Z); });
    return result;
}
