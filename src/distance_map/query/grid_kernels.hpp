#pragma once

#include <echinus/distance_map.hpp>

/// The kernels of the grids, in separate files so that they are compiled in parallel: every grid is compiled
/// for every instruction set and kind of answer.
namespace echinus {

/// The batch queries of query.cpp for one kind of grid.
struct GridKernels {
    void (*contains)(const DistanceMapView& map, const StridedSpan<const Vec3f>& points_local,
                     std::uint8_t* inside);
    void (*contacts)(const DistanceMapView& map, const StridedSpan<const Vec3f>& points_local, float margin,
                     Contact* contacts);
};

/// The kernels of each grid for the instruction set in use.
GridKernels spherical_kernels() noexcept;
GridKernels ellipsoidal_kernels() noexcept;
GridKernels octahedral_kernels() noexcept;
GridKernels cube_kernels() noexcept;

} // namespace echinus
