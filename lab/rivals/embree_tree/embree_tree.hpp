#pragma once

#include "rivals/system.hpp"

#include <echinus/mesh.hpp>

#include <limits>
#include <memory>
#include <span>

namespace echinus::rivals {

/// How a ray tracer decides the side of a particle, by a ray along a fixed direction.
enum class RaySides : std::uint8_t {
    /// An odd number of faces crossed. A ray through an edge or a vertex may meet the faces there twice, or
    /// not at all: Embree's robust mode closes the gaps between faces and does not count each crossing once
    /// (github.com/RenderKit/embree issue 188).
    Parity,
    /// The first face is seen from behind. Less work than all faces, and as wrong beside edges that are seen
    /// edge-on; where parts overlap, the nearest decides, and of two faces in one place either.
    FirstHit,
};

/// The representative of bounding-volume trees: Embree 3 with its robust intersections. Sides by rays, ways
/// out by a point query with the distance to each face in single precision (Ericson, "Real-Time Collision
/// Detection", 2005, section 5.1.5). It has one size, and that of the mesh: no resolution.
class EmbreeTree final : public System {
  public:
    /// The tree is built with spatial splits for FirstHit and without for Parity: a face that was split may
    /// be reported more than once (Embree's manual, rtcSetSceneBuildQuality).
    /// @param mesh  closed; copied
    /// @throws Error InvalidMesh as inspect() does, for an open mesh, or when the bounding radius lies
    /// outside [1e-15, 1e15]
    static EmbreeTree build(const TriangleMesh& mesh, RaySides sides = RaySides::Parity,
                            unsigned thread_count = 1);
    /// The same around a mesh that may be open, where a side is what one ray happens to meet.
    /// @throws Error InvalidMesh as inspect() does
    static EmbreeTree build_open(const TriangleMesh& mesh, RaySides sides = RaySides::Parity,
                                 unsigned thread_count = 1);

    EmbreeTree(EmbreeTree&&) noexcept;
    EmbreeTree& operator=(EmbreeTree&&) noexcept;
    ~EmbreeTree() override;

    std::string name() const override { return "embree"; }
    std::size_t byte_count() const override;
    std::string_view counted() const override { return "tree, vertices and faces, by Embree's own account"; }

    bool contains(const Vec3f& point) const override; ///< one ray, not in a packet
    /// Rays one by one.
    void contains_one_by_one(std::span<const Vec3f> points, std::span<std::uint8_t> inside) const;
    /// Rays in packets of sixteen, for which Embree has kernels of its own.
    void contains_batch(std::span<const Vec3f> points, std::span<std::uint8_t> inside) const override;
    /// The normal leads from a particle inside to the nearest point, and from there to one outside; a
    /// particle on it has that of the face.
    void contacts_batch(std::span<const Vec3f> points, float margin,
                        std::span<Contact> contacts) const override;
    using System::contacts_batch;

    struct Nearest {
        Vec3f point;
        float distance;
        /// The mesh's number; kNoIndex for a point that is not finite or not so near.
        std::uint32_t face;
    };
    /// The nearest point of the surface, from either side, if it is nearer than `farthest`.
    Nearest nearest(const Vec3f& point, float farthest = std::numeric_limits<float>::infinity()) const;

    /// Does a face cross the straight way between two points?
    bool crossed(const Vec3f& from, const Vec3f& to) const;

  private:
    struct Scene;
    explicit EmbreeTree(std::unique_ptr<const Scene> scene);

    std::unique_ptr<const Scene> scene_;
};

} // namespace echinus::rivals
