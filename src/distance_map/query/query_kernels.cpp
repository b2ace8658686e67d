#include "distance_map/query/query_kernels.hpp"

#include "distance_map/query/grid_kernels.hpp"

namespace echinus {

namespace {

GridKernels kernels_of(DirectionGrid grid) noexcept {
    switch (grid) {
    case DirectionGrid::Ellipsoidal:
        return ellipsoidal_kernels();
    case DirectionGrid::Octahedral:
        return octahedral_kernels();
    case DirectionGrid::Cube:
        return cube_kernels();
    default:
        return spherical_kernels();
    }
}

} // namespace

bool kernels_read(const DistanceMapView& map) noexcept {
    constexpr std::size_t kMinEntries = 4; // a row
    constexpr std::size_t kMaxEntries = std::size_t{1}
                                        << 30; // offsets in bytes of 16-bit entries have 31 bits
    return map.entry_count() >= kMinEntries && map.entry_count() < kMaxEntries;
}

void contains_by_kernel(const DistanceMapView& map, const StridedSpan<const Vec3f>& points_local,
                        std::span<std::uint8_t> inside) noexcept {
    kernels_of(map.grid).contains(map, points_local, inside.data());
}

void contacts_by_kernel(const DistanceMapView& map, const StridedSpan<const Vec3f>& points_local,
                        float margin, std::span<Contact> contacts) noexcept {
    kernels_of(map.grid).contacts(map, points_local, margin, contacts.data());
}

} // namespace echinus
