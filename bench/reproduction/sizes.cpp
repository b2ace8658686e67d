#include "sizes.hpp"

#include "names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <utility>

using namespace echinus;

namespace {

/// The shortest of several builds, on one thread: what disturbs a measurement only ever adds to it.
double build_milliseconds(const TriangleMesh& mesh, DistanceMapOptions options) {
    options.thread_count = 1;
    double best = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 7; ++i) {
        const auto start = std::chrono::steady_clock::now();
        DistanceMap::build(mesh, options);
        const std::chrono::duration<double, std::milli> duration = std::chrono::steady_clock::now() - start;
        best = std::min(best, duration.count());
    }
    return best;
}

/// Each direction a dynamic array of a 32-bit program (three pointers) with its floats on the heap: the
/// layout that comes nearest to what the paper prints.
double dynamic_array_bytes(const DistanceMapView& map) {
    return 12 * static_cast<double>(map.direction_count()) + 4 * static_cast<double>(map.entry_count());
}

} // namespace

void measure_sizes(const Subject& subject, Values& values) {
    std::vector<std::vector<std::string>> rows{{"pole", "entries per direction, mean", "most",
                                                "float32, flat: MB", "unorm16, flat: MB", "12 + 4 bytes: MB",
                                                "12 + 4 bytes: MiB", "build, ms"}};
    for (const PoleAxis axis : kAxes) {
        DistanceMapOptions options{.correction = VertexCorrection::None, .pole_axis = axis};
        const DistanceMap map = DistanceMap::build(subject.mesh, options);
        const double milliseconds = build_milliseconds(subject.mesh, options);
        options.entry_format = EntryFormat::Unorm16;
        const DistanceMap small = DistanceMap::build(subject.mesh, options);
        const DistanceMapView& view = map;
        const double directions = static_cast<double>(view.direction_count());
        rows.push_back({name_of(axis),
                        fmt::format("{:.2f}", static_cast<double>(view.entry_count()) / directions),
                        fmt::format("{}", map.statistics().max_entries),
                        fmt::format("{:.3f}", static_cast<double>(view.byte_count()) / 1e6),
                        fmt::format("{:.3f}", static_cast<double>(small.view().byte_count()) / 1e6),
                        fmt::format("{:.3f}", dynamic_array_bytes(view) / 1e6),
                        fmt::format("{:.3f}", dynamic_array_bytes(view) / (1 << 20)),
                        fmt::format("{:.1f}", milliseconds)});
    }
    values[subject.name + ".sizes"] = markdown_table(rows);
}

void measure_torus_shapes(Values& values) {
    std::vector<std::vector<std::string>> rows{
        {"minor / major radius"}, {"pole along the axis, MiB"}, {"pole across it, MiB"}};
    for (int tenths = 3; tenths <= 9; ++tenths) {
        rows[0].push_back(fmt::format("0.{}", tenths));
        const TriangleMesh torus = make_torus(1, tenths / 10.0, 60, 24);
        for (const auto& [row, axis] : {std::pair{1, PoleAxis::Z}, std::pair{2, PoleAxis::X}}) {
            const DistanceMap map =
                DistanceMap::build(torus, {.correction = VertexCorrection::None, .pole_axis = axis});
            rows[row].push_back(fmt::format("{:.2f}", dynamic_array_bytes(map) / (1 << 20)));
        }
    }
    values["torus_shapes"] = markdown_table(rows);
}
