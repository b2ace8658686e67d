#include "depths.hpp"

#include "geometry/parallel.hpp"

#include <echinus/distance_map.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

using namespace echinus;

namespace {

/// Radial depth over true depth, ascending.
std::vector<double> depth_ratios(const DistanceMapView& map, const Subject& subject,
                                 const JudgedPoints& set) {
    std::vector<double> ratios(set.points.size());
    parallel_for(set.points.size(), 0, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (!set.inside[i]) continue;
            const Contact c = contact(map, set.points[i]);
            if (c.inside) ratios[i] = c.depth / subject.judge.distance(Vec3d(set.points[i]));
        }
    });
    std::erase(ratios, 0.0);
    std::ranges::sort(ratios);
    return ratios;
}

/// 1 / cos of the angle between each face's normal and the ray through its middle, ascending, with the face's
/// area: what the ratio of depths tends to at the surface.
struct Slant {
    double secant, area;
};

std::vector<Slant> slants(const DistanceMapView& map, const TriangleMesh& mesh) {
    std::vector<Slant> result;
    for (const auto& [a, b, c] : mesh.faces) {
        const Vec3d va(mesh.vertices[a]), vb(mesh.vertices[b]), vc(mesh.vertices[c]);
        const Vec3d twice_area = cross(vb - va, vc - va);
        const Vec3d ray = (va + vb + vc) * (1.0 / 3) - Vec3d(map.centre);
        const double cosine = std::fabs(dot(twice_area, ray)) / (length(twice_area) * length(ray));
        result.push_back({1 / cosine, length(twice_area) / 2});
    }
    std::ranges::sort(result, {}, &Slant::secant);
    return result;
}

double quantile(const std::vector<double>& sorted, double share) {
    return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

double quantile(const std::vector<Slant>& sorted, double share) {
    double total = 0;
    for (const Slant& slant : sorted) total += slant.area;
    double below = 0;
    for (const Slant& slant : sorted)
        if ((below += slant.area) >= share * total) return slant.secant;
    return sorted.back().secant;
}

template <typename Sorted>
std::string median_and_ninth_decile(const Sorted& sorted) {
    return fmt::format("{:.2f} / {:.1f}", quantile(sorted, 0.5), quantile(sorted, 0.9));
}

} // namespace

void measure_depths(std::span<const Subject> subjects, Values& values) {
    std::vector<std::vector<std::string>> rows{{"model", "U", "S", "C", "at the surface, by area"}};
    for (const Subject& subject : subjects) {
        const DistanceMap map = DistanceMap::build(subject.mesh, {.correction = VertexCorrection::None});
        rows.push_back({subject.name});
        for (const JudgedPoints& set : subject.sets)
            rows.back().push_back(median_and_ninth_decile(depth_ratios(map, subject, set)));
        rows.back().push_back(median_and_ninth_decile(slants(map, subject.mesh)));
    }
    values["depths"] = markdown_table(rows);
}
