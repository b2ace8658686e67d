#include "rivals/common/closed_mesh.hpp"
#include "rivals/unshipped/unshipped.hpp"

#include <nanovdb/util/OpenToNanoVDB.h>
#include <nanovdb/util/SampleFromVoxels.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>

#include <limits>
#include <vector>

namespace echinus::rivals {

namespace {

openvdb::FloatGrid::Ptr distances_around(const TriangleMesh& mesh, double spacing) {
    openvdb::initialize();
    const auto transform = openvdb::math::Transform::createLinearTransform(spacing);
    std::vector<openvdb::Vec3s> vertices;
    for (const Vec3f& v : mesh.vertices)
        vertices.emplace_back(transform->worldToIndex(openvdb::Vec3d(v.x, v.y, v.z)));
    std::vector<openvdb::Vec3I> faces;
    for (const auto& [a, b, c] : mesh.faces) faces.emplace_back(a, b, c);
    const openvdb::tools::QuadAndTriangleDataAdapter<openvdb::Vec3s, openvdb::Vec3I> adapter(vertices, faces);
    return openvdb::tools::meshToVolume<openvdb::FloatGrid>(adapter, *transform, 3,
                                                            std::numeric_limits<float>::max());
}

class NanoField final : public System {
  public:
    NanoField(const TriangleMesh& mesh, double spacing)
        : handle_(nanovdb::openToNanoVDB<nanovdb::HostBuffer>(*distances_around(mesh, spacing))) {}

    std::string name() const override { return "nanovdb"; }
    std::size_t byte_count() const override { return handle_.size(); }
    std::string_view counted() const override { return "the block of the grid"; }

    void contains_batch(std::span<const Vec3f> points, std::span<std::uint8_t> inside) const override {
        const auto accessor = grid().getAccessor();
        nanovdb::SampleFromVoxels<std::decay_t<decltype(accessor)>, 1, false> sample(accessor);
        for (std::size_t i = 0; i < points.size(); ++i)
            inside[i] = is_finite(points[i]) && sample(voxel_of(points[i])) < 0;
    }

    void contacts_batch(std::span<const Vec3f> points, float /*margin*/,
                        std::span<Contact> contacts) const override {
        const auto accessor = grid().getAccessor();
        // Keeps the eight samples for the gradient.
        nanovdb::SampleFromVoxels<std::decay_t<decltype(accessor)>, 1, true> sample(accessor);
        for (std::size_t i = 0; i < points.size(); ++i) {
            contacts[i] = no_contact(points[i]);
            if (!is_finite(points[i])) continue;
            const auto voxel = voxel_of(points[i]);
            const float distance = sample(voxel);
            if (!(distance < 0)) continue;
            const auto gradient = sample.gradient(voxel); // the voxels have the world's axes
            const Vec3f normal(gradient[0], gradient[1], gradient[2]);
            contacts[i] = contact_along(points[i], -distance, normal * (1 / length(normal)));
        }
    }
    using System::contacts_batch;

  private:
    const nanovdb::FloatGrid& grid() const { return *handle_.grid<float>(); }
    nanovdb::Vec3f voxel_of(const Vec3f& p) const {
        return grid().worldToIndexF(nanovdb::Vec3f(p.x, p.y, p.z));
    }

    nanovdb::GridHandle<nanovdb::HostBuffer> handle_;
};

} // namespace

std::unique_ptr<const System> nano_field(const TriangleMesh& mesh, double spacing) {
    require_closed(mesh, "a field of signed distances");
    return std::make_unique<const NanoField>(mesh, spacing);
}

} // namespace echinus::rivals
