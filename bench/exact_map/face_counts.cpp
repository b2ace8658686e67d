#include "contestants.hpp"
#include "files/atomic_file.hpp"
#include "measurements.hpp"
#include "rivals/compare/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

using namespace echinus;
using namespace echinus::comparison;

namespace {

/// A torus of about so many faces, nearly square in pairs.
TriangleMesh torus_of(std::size_t face_count) {
    const auto minor_segments =
        static_cast<std::uint32_t>(std::lround(std::sqrt(static_cast<double>(face_count) / 5)));
    return make_torus(1, 0.4, minor_segments * 5 / 2, minor_segments);
}

struct Measured {
    std::vector<PlotPoint> exact_bytes, exact_build, embree_bytes, embree_build;
};

std::vector<std::string> measure(const TriangleMesh& mesh, const Setting& setting, Measured& measured) {
    const auto faces = static_cast<double>(mesh.faces.size());
    const int builds = faces > 500'000 ? 1 : faces > 50'000 ? 2 : 2 * setting.repetitions;
    const ExactMap map = ExactMap::build(mesh, one_thread());
    const double build_ms =
        1e3 * shortest_seconds(builds, [&] { (void)ExactMap::build(mesh, one_thread()); });
    const EmbreeRival embree(mesh);
    double embree_seconds = embree.build_seconds();
    for (int i = 1; i < builds; ++i)
        embree_seconds = std::min(embree_seconds, EmbreeRival(mesh).build_seconds());

    const std::vector<Vec3f> points = comparison::surface_points(mesh, setting.few_points() / 2);
    std::vector<std::uint8_t> ours, theirs;
    const auto ns =
        race(points.size(), setting.repetitions,
             std::array{asks_inside(map.view(), points, ours), asks_inside(embree, points, theirs)});

    const auto megabytes = static_cast<double>(map.view().byte_count()) / 1e6;
    const auto embree_megabytes = static_cast<double>(embree.byte_count()) / 1e6;
    measured.exact_bytes.push_back({faces, megabytes});
    measured.exact_build.push_back({faces, build_ms});
    measured.embree_bytes.push_back({faces, embree_megabytes});
    measured.embree_build.push_back({faces, 1e3 * embree_seconds});
    return {fmt::format("{}", mesh.faces.size()),
            fmt::format("{}", map.view().divisions),
            fmt::format("{:.3f}", megabytes),
            fmt::format("{:.1f}", 1e6 * megabytes / faces),
            fmt::format("{:.2f}", build_ms),
            fmt::format("{:.2f}", 1e3 * build_ms / faces),
            fmt::format("{:.1f}", map.statistics().expected_tests),
            fmt::format("{:.1f}", ns[0]),
            fmt::format("{:.3f}", embree_megabytes),
            fmt::format("{:.2f}", 1e3 * embree_seconds),
            fmt::format("{:.1f}", ns[1])};
}

Curve curve(const char* name, const std::vector<PlotPoint>& points, bool is_rival) {
    return {.name = fmt::format("{}, slope {:.2f}", name, fitted_exponent(points)),
            .points = points,
            .colour = is_rival ? "#c44e00" : "#0072b2",
            .dashed = is_rival};
}

void write_plot(const std::filesystem::path& file, const char* title, const char* y_label,
                const std::vector<PlotPoint>& exact, const std::vector<PlotPoint>& embree) {
    write_file(file, svg({.title = title,
                          .x_label = "faces",
                          .y_label = y_label,
                          .curves = {curve("exact map", exact, false), curve("Embree", embree, true)}}));
}

} // namespace

void measure_face_counts(const Setting& setting, Values& values) {
    std::vector<std::vector<std::string>> rows{{"faces", "divisions", "MB", "bytes per face", "build, ms",
                                                "µs per face", "expected tests", "contains on S, ns",
                                                "Embree: MB", "build, ms", "inside on S, ns"}};
    Measured measured;
    for (std::size_t faces = 1000; faces <= setting.most_faces; faces *= 4) {
        rows.push_back(measure(torus_of(faces), setting, measured));
        fmt::print(stderr, "      {} faces\n", faces);
    }
    write_plot(setting.images / "exact_bytes.svg", "Memory against faces", "all bytes that a query reads, MB",
               measured.exact_bytes, measured.embree_bytes);
    write_plot(setting.images / "exact_build.svg", "Build time against faces, one thread", "build, ms",
               measured.exact_build, measured.embree_build);
    values["faces"] = markdown_table(rows);
    values["bytes_slope"] = fmt::format("{:.2f}", fitted_exponent(measured.exact_bytes));
    values["build_slope"] = fmt::format("{:.2f}", fitted_exponent(measured.exact_build));
}
