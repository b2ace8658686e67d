#include "rivals/vdb_grid.hpp"

#include <nanovdb/util/OpenToNanoVDB.h>
#include <nanovdb/util/SampleFromVoxels.h>

#include <cmath>

using namespace echinus;

struct NanoVdbRival::Impl {
    nanovdb::GridHandle<nanovdb::HostBuffer> handle;

    explicit Impl(const TriangleMesh& mesh)
        : handle(nanovdb::openToNanoVDB<nanovdb::HostBuffer>(*OpenVdbRival::Impl(mesh).grid)) {}
    const nanovdb::FloatGrid& grid() const { return *handle.grid<float>(); }
};

NanoVdbRival::NanoVdbRival(const TriangleMesh& mesh) : impl_(std::make_unique<const Impl>(mesh)) {}

NanoVdbRival::~NanoVdbRival() = default;

void NanoVdbRival::contains(std::span<const Vec3f> points, std::span<std::uint8_t> inside) const {
    const nanovdb::FloatGrid& grid = impl_->grid();
    const auto accessor = grid.getAccessor();
    nanovdb::SampleFromVoxels<std::decay_t<decltype(accessor)>, 1, false> sample(accessor);
    for (std::size_t i = 0; i < points.size(); ++i)
        inside[i] = sample(grid.worldToIndexF(nanovdb::Vec3f(points[i].x, points[i].y, points[i].z))) < 0;
}

void NanoVdbRival::contacts(std::span<const Vec3f> points, std::span<DepthNormal> contacts) const {
    const nanovdb::FloatGrid& grid = impl_->grid();
    const auto accessor = grid.getAccessor();
    // Keeps the eight samples for the gradient.
    nanovdb::SampleFromVoxels<std::decay_t<decltype(accessor)>, 1, true> sample(accessor);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto p = grid.worldToIndexF(nanovdb::Vec3f(points[i].x, points[i].y, points[i].z));
        const float distance = sample(p);
        if (distance >= 0) {
            contacts[i] = {};
            continue;
        }
        const auto gradient = sample.gradient(p); // of the index space, which has the world's axes
        const Vec3f normal(gradient[0], gradient[1], gradient[2]);
        contacts[i] = {-distance, normal * (1 / length(normal))};
    }
}

std::size_t NanoVdbRival::byte_count() const {
    return impl_->handle.size();
}
