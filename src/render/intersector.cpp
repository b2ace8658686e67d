#include "render/intersector.hpp"

#include <echinus/error.hpp>

#include <embree3/rtcore.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <string>

namespace echinus::render {

namespace {

struct ReleaseDevice {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct ReleaseScene {
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
struct ReleaseGeometry {
    void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
using Device = std::unique_ptr<RTCDeviceTy, ReleaseDevice>;
using Scene = std::unique_ptr<RTCSceneTy, ReleaseScene>;
using Geometry = std::unique_ptr<RTCGeometryTy, ReleaseGeometry>;

void require_success(RTCDevice device, const std::string& action) {
    const RTCError error = rtcGetDeviceError(device);
    if (error == RTC_ERROR_NONE) return;
    throw Error(ErrorCode::InvalidOptions,
                "Embree cannot " + action + " (its error number is " + std::to_string(error) + ")");
}

template <typename T>
void copy_buffer(RTCDevice device, RTCGeometry geometry, RTCBufferType type, RTCFormat format,
                 const std::vector<T>& values) {
    void* buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(T), values.size());
    require_success(device, "hold a mesh of this size");
    std::memcpy(buffer, values.data(), values.size() * sizeof(T));
}

/// Embree requires the masks of its packets to be aligned to the packet's width.
struct alignas(64) ValidMask {
    std::array<int, Intersector::kPacketSize> lanes{}; // -1: trace, 0: skip
};

ValidMask fill(std::span<const Ray> rays, RTCRay16& packet) {
    ValidMask valid;
    // If Embree has no packets of 16, for instance without AVX-512, it ignores the mask, but skips a ray
    // whose end is before its beginning (observed in Embree 3.12).
    std::fill(std::begin(packet.tnear), std::end(packet.tnear), 0.0F);
    std::fill(std::begin(packet.tfar), std::end(packet.tfar), -std::numeric_limits<float>::infinity());
    for (std::size_t i = 0; i < rays.size(); ++i) {
        valid.lanes[i] = -1;
        packet.org_x[i] = rays[i].origin.x;
        packet.org_y[i] = rays[i].origin.y;
        packet.org_z[i] = rays[i].origin.z;
        packet.dir_x[i] = rays[i].direction.x;
        packet.dir_y[i] = rays[i].direction.y;
        packet.dir_z[i] = rays[i].direction.z;
        packet.tfar[i] = std::numeric_limits<float>::infinity();
        packet.time[i] = 0;
        packet.mask[i] = 0xFFFFFFFF;
        packet.flags[i] = 0;
    }
    return valid;
}

} // namespace

struct Intersector::Impl {
    Device device;
    Scene scene;
};

Intersector::Intersector(const TriangleMesh& mesh) : impl_(std::make_unique<Impl>()) {
    impl_->device.reset(rtcNewDevice(nullptr));
    RTCDevice device = impl_->device.get();
    require_success(device, "start");
    impl_->scene.reset(rtcNewScene(device));
    rtcSetSceneFlags(impl_->scene.get(), RTC_SCENE_FLAG_ROBUST);

    const Geometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
    copy_buffer(device, geometry.get(), RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, mesh.vertices);
    copy_buffer(device, geometry.get(), RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, mesh.faces);
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometry(impl_->scene.get(), geometry.get());
    // On one thread, because the shape of the tree decides which of two faces a ray through their common edge
    // hits, and is random with several threads. (Embree's own "threads=1" would bind the whole process.)
    tbb::task_arena(1).execute([&] { rtcCommitScene(impl_->scene.get()); });
    require_success(device, "build its tree");
}

Intersector::~Intersector() = default;

void Intersector::first_hits(std::span<const Ray> rays, std::span<RayHit> hits) const noexcept {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    RTCRayHit16 packet;
    const ValidMask valid = fill(rays, packet.ray);
    std::fill(std::begin(packet.hit.geomID), std::end(packet.hit.geomID), RTC_INVALID_GEOMETRY_ID);
    rtcIntersect16(valid.lanes.data(), impl_->scene.get(), &context, &packet);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        hits[i] = packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID
                      ? RayHit{}
                      : RayHit{packet.hit.primID[i], packet.ray.tfar[i], packet.hit.u[i], packet.hit.v[i]};
    }
}

std::uint32_t Intersector::blocked(std::span<const Ray> rays) const noexcept {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay16 packet;
    const ValidMask valid = fill(rays, packet);
    rtcOccluded16(valid.lanes.data(), impl_->scene.get(), &context, &packet);
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (packet.tfar[i] < 0) bits |= 1U << i; // marks a hit in Embree
    }
    return bits;
}

} // namespace echinus::render
