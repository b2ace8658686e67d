#include "rivals/cgal.hpp"

#include "systems/ways.hpp"

using namespace echinus;

Ways contacts_ways(const CgalRival& cgal, std::size_t point_count) {
    return {way_one_by_one<DepthNormal>("side then nearest", point_count, [&](const Vec3f& point) {
        if (!cgal.inside(point)) return DepthNormal{};
        const Vec3d way_out = cgal.nearest(point) - Vec3d(point);
        const double depth = length(way_out);
        return DepthNormal{static_cast<float>(depth), Vec3f(way_out * (1 / depth))};
    })};
}
