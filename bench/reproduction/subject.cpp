#include "subject.hpp"

#include "geometry/parallel.hpp"

#include <utility>

using namespace echinus;

JudgedPoints judged(std::string name, std::vector<Vec3f> points, const test::ExactJudge& judge) {
    std::vector<std::uint8_t> inside(points.size());
    parallel_for(points.size(), 0, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) inside[i] = judge.inside(points[i]) ? 1 : 0;
    });
    return {std::move(name), std::move(points), std::move(inside)};
}

Subject::Subject(std::string name_, std::string origin_, TriangleMesh mesh_, comparison::Axis up_,
                 std::size_t side_count_)
    : name(std::move(name_)), origin(std::move(origin_)), mesh(std::move(mesh_)), up(up_),
      side_count(side_count_), radius(inspect(mesh).bounding_sphere.radius),
      judge(mesh), sets{judged("U", comparison::uniform_points(mesh, side_count * side_count), judge),
                        judged("S", comparison::surface_points(mesh, side_count * side_count), judge),
                        judged("C", comparison::cloth_points(mesh, side_count, side_count, up), judge)} {}
