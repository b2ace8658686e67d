#include "rivals/embree_tree/embree_tree.hpp"

#include "rivals/common/closed_mesh.hpp"

#include <echinus/geometry.hpp>

#include <embree3/rtcore.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <string>

namespace echinus::rivals {

namespace {

/// The nearest point of a triangle: the region of Voronoi in which p lies, by inner products (Ericson,
/// "Real-Time Collision Detection", 2005, section 5.1.5). In single precision, as games have it.
Vec3f nearest_on_triangle(const Vec3f& p, const Vec3f& a, const Vec3f& b, const Vec3f& c) {
    const Vec3f ab = b - a, ac = c - a, ap = p - a;
    const float d1 = dot(ab, ap), d2 = dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) return a;
    const Vec3f bp = p - b;
    const float d3 = dot(ab, bp), d4 = dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) return b;
    const Vec3f cp = p - c;
    const float d5 = dot(ab, cp), d6 = dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) return c;
    const float vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + ab * (d1 / (d1 - d3));
    const float vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + ac * (d2 / (d2 - d6));
    const float va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 >= d3 && d5 >= d6) return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    const float scale = 1 / (va + vb + vc);
    return a + ab * (vb * scale) + ac * (vc * scale);
}

constexpr float kInfinity = std::numeric_limits<float>::infinity();
/// Not along an axis, where meshes often have edges.
constexpr Vec3f kDirection{0.3F, 0.5F, 0.81F};
constexpr std::size_t kPacket = 16;

/// Embree's memory, and the copy of the mesh in it.
struct Surface {
    const Vec3f* vertices = nullptr;
    const Triangle* faces = nullptr;

    Vec3f corner(std::uint32_t face, std::size_t k) const { return vertices[faces[face][k]]; }
    Vec3f normal(std::uint32_t face) const {
        const Vec3f across = cross(corner(face, 1) - corner(face, 0), corner(face, 2) - corner(face, 0));
        const float l = length(across);
        return l > 0 ? across * (1 / l) : Vec3f{};
    }
};

struct NearestSoFar {
    const Surface& surface;
    EmbreeTree::Nearest nearest;
};

bool visit_face(RTCPointQueryFunctionArguments* arguments) {
    auto& [surface, nearest] = *static_cast<NearestSoFar*>(arguments->userPtr);
    const std::uint32_t face = arguments->primID;
    const Vec3f p{arguments->query->x, arguments->query->y, arguments->query->z};
    const Vec3f on_face =
        nearest_on_triangle(p, surface.corner(face, 0), surface.corner(face, 1), surface.corner(face, 2));
    const float distance = length(p - on_face);
    if (distance >= arguments->query->radius) return false;
    arguments->query->radius = distance;
    nearest = {on_face, distance, face};
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

/// Sixteen rays from points along the fixed direction. Those beyond the last point, and those from points
/// that are not finite, are not traced.
struct Packet {
    alignas(64) int valid[kPacket];
    alignas(64) RTCRayHit16 rays{};

    explicit Packet(std::span<const Vec3f> points) {
        for (std::size_t i = 0; i < kPacket; ++i) {
            const bool traced = i < points.size() && is_finite(points[i]);
            const Vec3f origin = traced ? points[i] : Vec3f{};
            valid[i] = traced ? -1 : 0;
            rays.ray.org_x[i] = origin.x;
            rays.ray.org_y[i] = origin.y;
            rays.ray.org_z[i] = origin.z;
            rays.ray.dir_x[i] = kDirection.x;
            rays.ray.dir_y[i] = kDirection.y;
            rays.ray.dir_z[i] = kDirection.z;
            rays.ray.tfar[i] =
                traced ? kInfinity : -kInfinity; // without AVX-512 Embree does not look at `valid`
            rays.ray.mask[i] = ~0U;
            rays.ray.id[i] = static_cast<unsigned>(i);
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

std::string device_options(unsigned thread_count) {
    return "threads=" + std::to_string(thread_count); // 0: all
}

} // namespace

struct EmbreeTree::Scene {
    std::atomic<std::ptrdiff_t> bytes = 0; // outlives the device, which goes on counting
    RaySides sides;
    RTCDevice device;
    RTCScene scene = nullptr;
    Surface surface;

    Scene(const TriangleMesh& mesh, RaySides sides_, unsigned thread_count)
        : sides(sides_), device(rtcNewDevice(device_options(thread_count).c_str())) {
        rtcSetDeviceMemoryMonitorFunction(device, count_bytes, &bytes);
        scene = rtcNewScene(device);
        rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
        rtcSetSceneBuildQuality(scene, sides == RaySides::Parity ? RTC_BUILD_QUALITY_MEDIUM
                                                                 : RTC_BUILD_QUALITY_HIGH);
        const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* vertices = static_cast<Vec3f*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3f), mesh.vertices.size()));
        auto* faces = static_cast<Triangle*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(Triangle), mesh.faces.size()));
        std::ranges::copy(mesh.vertices, vertices);
        std::ranges::copy(mesh.faces, faces);
        surface = {vertices, faces};
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);
        rtcReleaseGeometry(geometry); // the scene keeps it, and its buffers
        rtcCommitScene(scene);
    }
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;
    ~Scene() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }

    RTCRayHit first_hit(const Vec3f& origin, const Vec3f& direction, float farthest) const {
        RTCRayHit result = ray_from(origin, direction, farthest);
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcIntersect1(scene, &context, &result);
        return result;
    }

    bool parity(const Vec3f& point) const {
        CountingContext counting;
        RTCRayHit ray = ray_from(point, kDirection, kInfinity);
        rtcIntersect1(scene, &counting.context, &ray);
        return counting.counts[0] % 2 != 0;
    }

    bool first_is_seen_from_behind(const Vec3f& point) const {
        const RTCHit hit = first_hit(point, kDirection, kInfinity).hit;
        return hit.geomID != RTC_INVALID_GEOMETRY_ID && is_seen_from_behind(hit.Ng_x, hit.Ng_y, hit.Ng_z);
    }

    void parities(Packet& packet, std::span<std::uint8_t> inside) const {
        CountingContext counting;
        rtcIntersect16(packet.valid, scene, &counting.context, &packet.rays);
        for (std::size_t i = 0; i < inside.size(); ++i) inside[i] = counting.counts[i] % 2;
    }

    void first_hits(Packet& packet, std::span<std::uint8_t> inside) const {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcIntersect16(packet.valid, scene, &context, &packet.rays);
        const RTCHit16& hit = packet.rays.hit;
        for (std::size_t i = 0; i < inside.size(); ++i)
            inside[i] = hit.geomID[i] != RTC_INVALID_GEOMETRY_ID &&
                        is_seen_from_behind(hit.Ng_x[i], hit.Ng_y[i], hit.Ng_z[i]);
    }
};

EmbreeTree EmbreeTree::build(const TriangleMesh& mesh, RaySides sides, unsigned thread_count) {
    require_closed(mesh, "a ray that tells sides");
    return build_open(mesh, sides, thread_count);
}

EmbreeTree EmbreeTree::build_open(const TriangleMesh& mesh, RaySides sides, unsigned thread_count) {
    require_valid(mesh);
    return EmbreeTree(std::make_unique<const Scene>(mesh, sides, thread_count));
}

EmbreeTree::EmbreeTree(std::unique_ptr<const Scene> scene) : scene_(std::move(scene)) {}
EmbreeTree::EmbreeTree(EmbreeTree&&) noexcept = default;
EmbreeTree& EmbreeTree::operator=(EmbreeTree&&) noexcept = default;
EmbreeTree::~EmbreeTree() = default;

std::size_t EmbreeTree::byte_count() const {
    return static_cast<std::size_t>(scene_->bytes.load());
}

bool EmbreeTree::contains(const Vec3f& point) const {
    if (!is_finite(point)) return false;
    return scene_->sides == RaySides::Parity ? scene_->parity(point)
                                             : scene_->first_is_seen_from_behind(point);
}

void EmbreeTree::contains_one_by_one(std::span<const Vec3f> points, std::span<std::uint8_t> inside) const {
    for (std::size_t i = 0; i < points.size(); ++i) inside[i] = contains(points[i]) ? 1 : 0;
}

void EmbreeTree::contains_batch(std::span<const Vec3f> points, std::span<std::uint8_t> inside) const {
    for (std::size_t begin = 0; begin < points.size(); begin += kPacket) {
        const std::size_t count = std::min(kPacket, points.size() - begin);
        Packet packet(points.subspan(begin, count));
        const auto answers = inside.subspan(begin, count);
        if (scene_->sides == RaySides::Parity)
            scene_->parities(packet, answers);
        else
            scene_->first_hits(packet, answers);
    }
}

void EmbreeTree::contacts_batch(std::span<const Vec3f> points, float margin,
                                std::span<Contact> contacts) const {
    std::uint8_t inside[kPacket];
    for (std::size_t begin = 0; begin < points.size(); begin += kPacket) {
        const std::size_t count = std::min(kPacket, points.size() - begin);
        contains_batch(points.subspan(begin, count), std::span(inside).first(count));
        for (std::size_t i = 0; i < count; ++i) {
            const Vec3f& point = points[begin + i];
            Contact& contact = contacts[begin + i] = no_contact(point);
            const bool is_inside = inside[i] != 0;
            if (!is_inside && !(margin > 0)) continue;
            const auto [on_surface, distance, face] = nearest(point, is_inside ? kInfinity : margin);
            if (face == kNoIndex) continue;
            const Vec3f out = is_inside ? on_surface - point : point - on_surface;
            contact.inside = is_inside;
            contact.point = on_surface;
            contact.depth = is_inside ? distance : -distance;
            contact.face = face;
            contact.normal = distance > 0 ? out * (1 / distance) : scene_->surface.normal(face);
        }
    }
}

EmbreeTree::Nearest EmbreeTree::nearest(const Vec3f& point, float farthest) const {
    NearestSoFar found{scene_->surface, {point, kInfinity, kNoIndex}};
    if (!is_finite(point)) return found.nearest;
    RTCPointQuery query{point.x, point.y, point.z, 0, farthest};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(scene_->scene, &query, &context, visit_face, &found);
    return found.nearest;
}

bool EmbreeTree::crossed(const Vec3f& from, const Vec3f& to) const {
    return scene_->first_hit(from, to - from, 1).hit.geomID != RTC_INVALID_GEOMETRY_ID;
}

} // namespace echinus::rivals
