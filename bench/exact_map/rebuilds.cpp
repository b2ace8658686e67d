#include "measurements.hpp"
#include "stopwatch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

using namespace echinus;

namespace {

/// The model, sheared a little, as an animation might.
TriangleMesh deformed(TriangleMesh mesh, float amount) {
    for (Vec3f& v : mesh.vertices) v.x += amount * v.z;
    return mesh;
}

std::vector<std::string> compare(const Model& model, int repetitions) {
    const std::array poses{model.mesh, deformed(model.mesh, 0.02F)};
    ExactMapBuilder builder(model.mesh.faces, one_thread());
    for (const TriangleMesh& pose : poses) builder.rebuild(pose.vertices);
    double build = std::numeric_limits<double>::infinity(), rebuild = build;
    for (int i = 0; i < 2 * repetitions; ++i) {
        const TriangleMesh& pose = poses[static_cast<std::size_t>(i) % 2];
        build = std::min(build, shortest_seconds(1, [&] { (void)ExactMap::build(pose, one_thread()); }));
        rebuild = std::min(rebuild, shortest_seconds(1, [&] { builder.rebuild(pose.vertices); }));
    }
    return {model.name, fmt::format("{}", model.mesh.faces.size()), fmt::format("{:.2f}", 1e3 * build),
            fmt::format("{:.2f}", 1e3 * rebuild), fmt::format("{:.2f}", rebuild / build)};
}

} // namespace

void measure_rebuilds(const Setting& setting, Values& values) {
    std::vector<std::vector<std::string>> rows{{"model", "faces", "build, ms", "rebuild, ms", "ratio"}};
    for (const Model& model : setting.models)
        if (model.closed) rows.push_back(compare(model, 3 * setting.repetitions));
    values["rebuilds"] = markdown_table(rows);
}
