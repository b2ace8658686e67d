#include "contains/field.hpp"

using namespace echinus;

namespace {

Competitor competitor_of(const Listed<ContainsSystem>& listed, const ContainsSystem& system, double build_ms,
                         ContainsWay way, std::size_t point_count) {
    const auto inside = std::make_shared<std::vector<std::uint8_t>>(point_count);
    return {listed.name,
            way.name,
            listed.role,
            system.byte_count(),
            build_ms,
            way.as_whole,
            [=, answer = std::move(way.answer)](std::span<const Vec3f> points, std::size_t first) {
                answer(points, std::span(*inside).subspan(first, points.size()));
            },
            [=](std::size_t i) {
                return DepthNormal{(*inside)[i] != 0 ? 1.0F : 0.0F, {}};
            }};
}

} // namespace

ContainsList all_contains_systems() {
    ContainsList list;
    list_exact_map(list);
    list_distance_map(list);
    list_contains_rivals(list);
    return list;
}

ContainsList all_contains_sizes() {
    ContainsList list;
    list_sizes_of_exact_map(list);
    list_sizes_of_distance_map(list);
    list_sizes_of_contains_rivals(list);
    return list;
}

ContainsField::ContainsField(const Subject& subject, std::size_t point_count, const ContainsList& systems,
                             bool one_way) {
    for (const Listed<ContainsSystem>& listed : systems) {
        if (subject.large && !listed.joins_large) continue;
        std::unique_ptr<ContainsSystem> system;
        const double build_ms = time_build(listed, subject.mesh, system);
        for (ContainsWay& way : system->ways()) {
            competitors_.push_back(competitor_of(listed, *system, build_ms, std::move(way), point_count));
            if (one_way) break;
        }
        systems_.push_back(std::move(system));
    }
}
