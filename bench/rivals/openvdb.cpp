#include "rivals/vdb_grid.hpp"

#include <openvdb/math/Stencils.h>
#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/MeshToVolume.h>

#include <limits>

using namespace echinus;

OpenVdbRival::Impl::Impl(const TriangleMesh& mesh) {
    openvdb::initialize();
    const double spacing = inspect(mesh).bounding_sphere.radius * 2 / 200;
    const auto transform = openvdb::math::Transform::createLinearTransform(spacing);
    std::vector<openvdb::Vec3s> vertices;
    for (const Vec3f& v : mesh.vertices)
        vertices.emplace_back(transform->worldToIndex(openvdb::Vec3d(v.x, v.y, v.z)));
    std::vector<openvdb::Vec3I> faces;
    for (const Triangle& face : mesh.faces) faces.emplace_back(face[0], face[1], face[2]);
    const openvdb::tools::QuadAndTriangleDataAdapter<openvdb::Vec3s, openvdb::Vec3I> adapter(vertices, faces);
    grid = openvdb::tools::meshToVolume<openvdb::FloatGrid>(adapter, *transform, 3,
                                                            std::numeric_limits<float>::max());
}

OpenVdbRival::OpenVdbRival(const TriangleMesh& mesh) : impl_(std::make_unique<const Impl>(mesh)) {}

OpenVdbRival::~OpenVdbRival() = default;

void OpenVdbRival::contains(std::span<const Vec3f> points, std::span<std::uint8_t> inside) const {
    const auto accessor = impl_->grid->getConstAccessor();
    const openvdb::math::Transform& transform = impl_->grid->transform();
    for (std::size_t i = 0; i < points.size(); ++i) {
        const openvdb::Vec3d p = transform.worldToIndex({points[i].x, points[i].y, points[i].z});
        inside[i] = openvdb::tools::BoxSampler::sample(accessor, p) < 0;
    }
}

void OpenVdbRival::contacts(std::span<const Vec3f> points, std::span<DepthNormal> contacts) const {
    openvdb::math::BoxStencil<openvdb::FloatGrid> stencil(*impl_->grid);
    const openvdb::math::Transform& transform = impl_->grid->transform();
    for (std::size_t i = 0; i < points.size(); ++i) {
        const openvdb::Vec3s p(transform.worldToIndex({points[i].x, points[i].y, points[i].z}));
        stencil.moveTo(openvdb::Vec3d(p));
        const float distance = stencil.interpolation(p);
        if (distance >= 0) {
            contacts[i] = {};
            continue;
        }
        openvdb::Vec3s normal = stencil.gradient(p);
        normal.normalize();
        contacts[i] = {-distance, {normal[0], normal[1], normal[2]}};
    }
}

std::size_t OpenVdbRival::byte_count() const {
    return impl_->grid->memUsage();
}
