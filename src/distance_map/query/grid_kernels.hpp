#pragma once

#include <echinus/distance_map.hpp>

/// The kernels of the grids, in several files so that they compile side by side: every grid is compiled for
/// every instruction set, format of entries and kind of answer.
namespace echinus {

/// The batches of query.cpp on one kind of grid.
struct GridKernels {
    void (*contains)(const DistanceMapView& map, const StridedSpan<const Vec3f>& points_local,
                     std::uint8_t* inside);
    void (*contacts)(const DistanceMapView& map, const StridedSpan<const Vec3f>& points_local, float margin,
                     Contact* contacts);
};

/// For the instruction set in use.
GridKernels spherical_kernels() noexcept;
GridKernels ellipsoidal_kernels() noexcept;
GridKernels octahedral_kernels() noexcept;
GridKernels cube_kernels() noexcept;

} // namespace echinus
