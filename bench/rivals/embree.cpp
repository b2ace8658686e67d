#include "rivals/embree.hpp"

#include "rivals/compare/clock.hpp"
#include "rivals/systems/common/nearest_on_triangle.hpp"

#include <embree3/rtcore.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

using namespace echinus;

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
/// Not along an axis, where meshes like to have their edges.
constexpr Vec3f kDirection{0.3F, 0.5F, 0.81F};

struct NearestSoFar {
    const TriangleMesh& mesh;
    Vec3f point;
    float distance = kInfinity;
};

bool visit_face(RTCPointQueryFunctionArguments* arguments) {
    auto& nearest = *static_cast<NearestSoFar*>(arguments->userPtr);
    const Triangle& face = nearest.mesh.faces[arguments->primID];
    const std::vector<Vec3f>& vertices = nearest.mesh.vertices;
    const Vec3f p{arguments->query->x, arguments->query->y, arguments->query->z};
    const Vec3f on_face =
        rivals::nearest_on_triangle(p, vertices[face[0]], vertices[face[1]], vertices[face[2]]);
    const Vec3f offset = p - on_face;
    const float distance = std::sqrt(dot(offset, offset));
    if (distance >= arguments->query->radius) return false;
    arguments->query->radius = nearest.distance = distance;
    nearest.point = on_face;
    return true;
}

RTCRayHit ray_from(const Vec3f& origin, const Vec3f& direction, float farthest) {
    RTCRayHit result{};
    result.ray.org_x = origin.x;
    result.ray.org_y = origin.y;
    result.ray.org_z = origin.z;
    result.ray.dir_x = direction.x;
    result.ray.dir_y = direction.y;
    result.ray.dir_z = direction.z;
    result.ray.tfar = farthest;
    result.ray.mask = ~0U;
    result.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    return result;
}

RTCRayHit first_hit(RTCScene scene, const Vec3f& origin, const Vec3f& direction, float farthest) {
    RTCRayHit result = ray_from(origin, direction, farthest);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, &result);
    return result;
}

constexpr std::size_t kPacket = 16;

/// Sixteen rays from points along the fixed direction; those beyond the last point are not traced.
struct Packet {
    alignas(64) int valid[kPacket];
    alignas(64) RTCRayHit16 rays{};

    explicit Packet(std::span<const Vec3f> points) {
        for (std::size_t i = 0; i < kPacket; ++i) {
            const Vec3f& origin = points[std::min(i, points.size() - 1)];
            valid[i] = i < points.size() ? -1 : 0;
            rays.ray.org_x[i] = origin.x;
            rays.ray.org_y[i] = origin.y;
            rays.ray.org_z[i] = origin.z;
            rays.ray.dir_x[i] = kDirection.x;
            rays.ray.dir_y[i] = kDirection.y;
            rays.ray.dir_z[i] = kDirection.z;
            rays.ray.tnear[i] = 0;
            rays.ray.tfar[i] = kInfinity;
            rays.ray.mask[i] = ~0U;
            rays.ray.id[i] = static_cast<unsigned>(i);
            rays.ray.flags[i] = 0;
            rays.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        }
    }
};

/// A context that counts faces instead of stopping at one.
struct CountingContext {
    RTCIntersectContext context; // first, so that Embree's pointer to it is one to all
    std::uint8_t counts[kPacket] = {};

    CountingContext() {
        rtcInitIntersectContext(&context);
        context.filter = count_faces;
    }

    static void count_faces(const RTCFilterFunctionNArguments* arguments) {
        auto& self = *reinterpret_cast<CountingContext*>(arguments->context);
        for (unsigned i = 0; i < arguments->N; ++i)
            if (arguments->valid[i] != 0) {
                ++self.counts[RTCRayN_id(arguments->ray, arguments->N, i)];
                arguments->valid[i] = 0; // go on
            }
    }
};

bool is_seen_from_behind(float normal_x, float normal_y, float normal_z) {
    return dot(Vec3f{normal_x, normal_y, normal_z}, kDirection) > 0;
}

bool count_bytes(void* counter, ssize_t bytes, bool /*after_the_fact*/) {
    *static_cast<std::atomic<std::ptrdiff_t>*>(counter) += bytes;
    return true;
}

} // namespace

struct EmbreeRival::Impl {
    const TriangleMesh& mesh;
    std::atomic<std::ptrdiff_t> bytes = 0;
    double build_seconds = 0;
    RTCDevice device = rtcNewDevice("threads=1");
    RTCScene scene = nullptr;

    explicit Impl(const TriangleMesh& mesh_) : mesh(mesh_) {
        rtcSetDeviceMemoryMonitorFunction(device, count_bytes, &bytes);
        const double start = comparison::thread_seconds();
        scene = rtcNewScene(device);
        rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
        rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
        const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        std::ranges::copy(mesh.vertices, static_cast<Vec3f*>(rtcSetNewGeometryBuffer(
                                             geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                             sizeof(Vec3f), mesh.vertices.size())));
        std::ranges::copy(mesh.faces, static_cast<Triangle*>(rtcSetNewGeometryBuffer(
                                          geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                          sizeof(Triangle), mesh.faces.size())));
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene);
        build_seconds = comparison::thread_seconds() - start;
    }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;
    ~Impl() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }
};

EmbreeRival::EmbreeRival(const TriangleMesh& mesh) : impl_(std::make_unique<Impl>(mesh)) {}

EmbreeRival::~EmbreeRival() = default;

bool EmbreeRival::inside(const Vec3f& point) const {
    const RTCRayHit found = first_hit(impl_->scene, point, kDirection, kInfinity);
    return found.hit.geomID != RTC_INVALID_GEOMETRY_ID &&
           is_seen_from_behind(found.hit.Ng_x, found.hit.Ng_y, found.hit.Ng_z);
}

void EmbreeRival::first_hits(std::span<const Vec3f> points, std::span<std::uint8_t> inside) const {
    for (std::size_t i = 0; i < points.size(); ++i) inside[i] = this->inside(points[i]) ? 1 : 0;
}

void EmbreeRival::first_hits_by_packets(std::span<const Vec3f> points, std::span<std::uint8_t> inside) const {
    for (std::size_t begin = 0; begin < points.size(); begin += kPacket) {
        const std::size_t count = std::min(kPacket, points.size() - begin);
        Packet packet(points.subspan(begin, count));
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcIntersect16(packet.valid, impl_->scene, &context, &packet.rays);
        const RTCHit16& hit = packet.rays.hit;
        for (std::size_t i = 0; i < count; ++i)
            inside[begin + i] = hit.geomID[i] != RTC_INVALID_GEOMETRY_ID &&
                                is_seen_from_behind(hit.Ng_x[i], hit.Ng_y[i], hit.Ng_z[i]);
    }
}

void EmbreeRival::parities(std::span<const Vec3f> points, std::span<std::uint8_t> inside) const {
    for (std::size_t i = 0; i < points.size(); ++i) {
        CountingContext counting;
        RTCRayHit ray = ray_from(points[i], kDirection, kInfinity);
        rtcIntersect1(impl_->scene, &counting.context, &ray);
        inside[i] = counting.counts[0] % 2;
    }
}

void EmbreeRival::parities_by_packets(std::span<const Vec3f> points, std::span<std::uint8_t> inside) const {
    for (std::size_t begin = 0; begin < points.size(); begin += kPacket) {
        const std::size_t count = std::min(kPacket, points.size() - begin);
        Packet packet(points.subspan(begin, count));
        CountingContext counting;
        rtcIntersect16(packet.valid, impl_->scene, &counting.context, &packet.rays);
        for (std::size_t i = 0; i < count; ++i) inside[begin + i] = counting.counts[i] % 2;
    }
}

EmbreeRival::Nearest EmbreeRival::nearest(const Vec3f& point) const {
    RTCPointQuery query{point.x, point.y, point.z, 0, kInfinity};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    NearestSoFar nearest{impl_->mesh, {}};
    rtcPointQuery(impl_->scene, &query, &context, visit_face, &nearest);
    return {nearest.point, nearest.distance};
}

bool EmbreeRival::crossed(const Vec3f& from, const Vec3f& to) const {
    return first_hit(impl_->scene, from, to - from, 1).hit.geomID != RTC_INVALID_GEOMETRY_ID;
}

std::size_t EmbreeRival::byte_count() const {
    return static_cast<std::size_t>(impl_->bytes.load());
}

double EmbreeRival::build_seconds() const {
    return impl_->build_seconds;
}
