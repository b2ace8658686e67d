#pragma once

#include "rivals/system.hpp"

#include <echinus/mesh.hpp>

#include <memory>
#include <span>

namespace echinus::rivals {

/// Bullet's own static triangle mesh (btBvhTriangleMeshShape), queried as its users do; for reference.
///
/// To Bullet such a mesh is a sheet, not a solid. It has no test for a particle in it, so a ray decides the
/// side: is the first face along a fixed direction seen from behind? (Of two faces in one place either may be
/// first.) It has no depth of a particle either, only contacts of small shapes with single faces, so the way
/// out is that to the nearest contact of a sphere around the particle. A particle deeper than the sphere's
/// radius, the reach, touches nothing: it is inside, and Bullet offers no way out. A longer reach costs time,
/// since the sphere meets more faces.
class BulletMesh final : public System {
  public:
    /// A typical soft-body margin in games, in bounding radii.
    static constexpr double kUsualReach = 0.05;
    static constexpr std::size_t kMaxFaces = (std::size_t{1} << 21) - 1; ///< of Bullet's compressed tree

    /// @param mesh   closed; copied
    /// @param reach  radius of the sphere, in bounding radii of the mesh; from 1e-3 to 2
    /// @throws Error InvalidMesh as inspect() does, for an open mesh, when the bounding radius lies outside
    /// [1e-15, 1e15], or for more than kMaxFaces faces; InvalidOptions for a reach out of range
    static BulletMesh build(const TriangleMesh& mesh, double reach = kUsualReach);

    BulletMesh(BulletMesh&&) noexcept;
    BulletMesh& operator=(BulletMesh&&) noexcept;
    ~BulletMesh() override;

    std::string name() const override { return "bullet"; }
    std::size_t byte_count() const override;
    std::string_view counted() const override { return "compressed tree, vertices and faces"; }

    void contains_batch(std::span<const Vec3f> points, std::span<std::uint8_t> inside) const override;
    void contacts_batch(std::span<const Vec3f> points, float margin,
                        std::span<Contact> contacts) const override;
    using System::contacts_batch;

  private:
    struct Shape;
    explicit BulletMesh(std::unique_ptr<const Shape> shape);

    std::unique_ptr<const Shape> shape_;
};

} // namespace echinus::rivals
