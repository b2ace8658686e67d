#include "rivals/unshipped/unshipped.hpp"

#include <echinus/intersections.hpp>

#include <embree3/rtcore.h>

#include <algorithm>
#include <type_traits>

namespace echinus::rivals {

namespace {

template <auto release>
struct Releaser {
    template <typename T>
    void operator()(T* handle) const {
        release(handle);
    }
};
using Device = std::unique_ptr<std::remove_pointer_t<RTCDevice>, Releaser<rtcReleaseDevice>>;
using Scene = std::unique_ptr<std::remove_pointer_t<RTCScene>, Releaser<rtcReleaseScene>>;

/// Faces as Embree asks for them; their boxes may be larger.
struct Faces {
    const TriangleMesh* mesh;
    float margin = 0;

    std::array<Vec3f, 3> corners(std::uint32_t face) const {
        const auto [a, b, c] = mesh->faces[face];
        return {mesh->vertices[a], mesh->vertices[b], mesh->vertices[c]};
    }
};

void bound_face(const RTCBoundsFunctionArguments* arguments) {
    const auto& faces = *static_cast<const Faces*>(arguments->geometryUserPtr);
    const auto [a, b, c] = faces.corners(arguments->primID);
    RTCBounds& box = *arguments->bounds_o;
    box.lower_x = std::min({a.x, b.x, c.x}) - faces.margin;
    box.lower_y = std::min({a.y, b.y, c.y}) - faces.margin;
    box.lower_z = std::min({a.z, b.z, c.z}) - faces.margin;
    box.upper_x = std::max({a.x, b.x, c.x}) + faces.margin;
    box.upper_y = std::max({a.y, b.y, c.y}) + faces.margin;
    box.upper_z = std::max({a.z, b.z, c.z}) + faces.margin;
}

/// @param faces  must outlive the scene
Scene scene_of(RTCDevice device, Faces& faces) {
    Scene scene(rtcNewScene(device));
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(faces.mesh->faces.size()));
    rtcSetGeometryUserData(geometry, &faces);
    rtcSetGeometryBoundsFunction(geometry, bound_face, nullptr);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene.get(), geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene.get());
    return scene;
}

struct Search {
    const Faces &model, &other;
    std::span<std::uint8_t> meets;
};

void test_pairs(void* search, RTCCollision* pairs, unsigned count) {
    const auto& [model, other, meets] = *static_cast<const Search*>(search);
    for (unsigned i = 0; i < count; ++i)
        if (meets[pairs[i].primID1] == 0 &&
            triangles_intersect(model.corners(pairs[i].primID0), other.corners(pairs[i].primID1)))
            meets[pairs[i].primID1] = 1;
}

void count_pairs(void* sum, RTCCollision*, unsigned count) {
    *static_cast<std::size_t*>(sum) += count;
}

} // namespace

struct EmbreeTriangles::Structure {
    explicit Structure(const TriangleMesh& mesh) : model(mesh) { scene = scene_of(device.get(), faces); }

    TriangleMesh model;
    mutable Faces faces{&model};
    Device device{rtcNewDevice("threads=1")};
    Scene scene;
};

EmbreeTriangles::EmbreeTriangles(const TriangleMesh& model)
    : structure_(std::make_unique<const Structure>(model)) {}
EmbreeTriangles::~EmbreeTriangles() = default;

void EmbreeTriangles::find_intersecting(const TriangleMesh& mesh, std::span<std::uint8_t> meets) const {
    std::fill(meets.begin(), meets.end(), std::uint8_t{0});
    Faces faces{&mesh};
    const Scene scene = scene_of(structure_->device.get(), faces);
    Search search{structure_->faces, faces, meets};
    rtcCollide(structure_->scene.get(), scene.get(), test_pairs, &search);
}

std::size_t EmbreeTriangles::count_near_boxes(const TriangleMesh& mesh, float reach) const {
    Faces faces{&mesh, reach};
    const Scene scene = scene_of(structure_->device.get(), faces);
    std::size_t count = 0;
    rtcCollide(structure_->scene.get(), scene.get(), count_pairs, &count);
    return count;
}

} // namespace echinus::rivals
