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
    std::vector<double> ratios; // of neighbours in time: what the machine does meanwhile cancels out
    for (int i = 0; i < repetitions; ++i) {
        const TriangleMesh& pose = poses[static_cast<std::size_t>(i) % 2];
        const double a = shortest_seconds(1, [&] { (void)ExactMap::build(pose, one_thread()); });
        const double b = shortest_seconds(1, [&] { builder.rebuild(pose.vertices); });
        build = std::min(build, a);
        rebuild = std::min(rebuild, b);
        ratios.push_back(b / a);
    }
    std::ranges::sort(ratios);
    return {model.name, fmt::format("{}", model.mesh.faces.size()), fmt::format("{:.2f}", 1e3 * build),
            fmt::format("{:.2f}", 1e3 * rebuild), fmt::format("{:.2f}", ratios[ratios.size() / 2])};
}

} // namespace

void measure_rebuilds(const Setting& setting, Values& values) {
    std::vector<std::vector<std::string>> rows{
        {"model", "faces", "build, ms", "rebuild, ms", "ratio, median"}};
    for (const Model& model : setting.models)
        if (model.closed) rows.push_back(compare(model, 4 * setting.repetitions));
    values["rebuilds"] = markdown_table(rows);
}
