#include "measure.hpp"

#include "rivals/compare/clock.hpp"
#include "rivals/compare/point_sets.hpp"

#include <echinus/exact_map.hpp>

#include <fmt/format.h>

using namespace echinus;
using namespace echinus::rivals;

namespace {

constexpr std::size_t kPointCount = 100'000;

double wrong_percent(const SuperquadricMap& map, const ExactMap& exact, const std::vector<Vec3f>& points) {
    std::vector<std::uint8_t> said(points.size()), truth(points.size());
    map.contains_batch(points, said);
    contains_batch(exact, points, truth);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < points.size(); ++i) wrong += said[i] != truth[i] ? 1 : 0;
    return 100 * static_cast<double>(wrong) / static_cast<double>(points.size());
}

} // namespace

std::vector<std::string> head_of_measurements() {
    return {"mesh",
            "faces",
            "segments",
            "MB",
            "fit error, mean",
            "worst",
            "not covered",
            "buried",
            "build, s",
            "wrong near the surface",
            "wrong in the sphere"};
}

std::vector<std::string> measure(const std::string& name, const TriangleMesh& mesh,
                                 const SuperquadricMapOptions& options) {
    const double start = comparison::process_seconds();
    const SuperquadricMap map = SuperquadricMap::build(mesh, options);
    const double seconds = comparison::process_seconds() - start;
    const ExactMap exact = ExactMap::build(mesh);
    const SuperquadricReport& report = map.report();
    const FitError fit = fit_error(report);
    const auto percent = [](double share) { return fmt::format("{:.1f} %", 100 * share); };
    return {
        name,
        fmt::format("{}", mesh.faces.size()),
        fmt::format("{}", map.segment_count()),
        fmt::format("{:.2f}", static_cast<double>(map.byte_count()) / 1e6),
        percent(fit.mean),
        percent(fit.largest),
        percent(report.uncovered_area_share),
        percent(report.buried_area_share),
        fmt::format("{:.1f}", seconds),
        fmt::format("{:.2f} %", wrong_percent(map, exact, comparison::surface_points(mesh, kPointCount))),
        fmt::format("{:.2f} %", wrong_percent(map, exact, comparison::uniform_points(mesh, kPointCount)))};
}
