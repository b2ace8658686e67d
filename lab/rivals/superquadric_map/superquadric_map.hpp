#pragma once

#include "rivals/system.hpp"

#include <echinus/contact.hpp>
#include <echinus/distance_map.hpp>
#include <echinus/geometry.hpp>
#include <echinus/mesh.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

/// The map that the distance map grew out of: SQ-Map of Moustakas, Tzovaras and Strintzis, "SQ-Map: efficient
/// layered collision detection and haptic rendering", IEEE TVCG 13(1), 2007. The model is cut into nearly
/// convex segments, each gets a superquadric around it, and on each superquadric a grid of samples tells how
/// far below it the surface lies. A particle is in the solid when it is in one of the segments.
///
/// The following is as in the papers: decomposition into segments; superquadrics with sizes, exponents and
/// pose; one distance per sample, that "of the point closer to the bounding surface" (Vogiannou et al.,
/// conclusion); a grid of 200 x 200 samples, uniform in (eta, omega) and periodic in omega; inside-outside
/// function first, map second. The papers leave the following open: - segments come from HACD
/// (decompose.hpp), where SQ-Map goes by visual salience and curvature; - a segment's convex hull closes it
/// where it borders on others (segments.hpp): a ray ends at the segment's outermost face or, where it meets
/// none, at the hull. Caps over the border, tried first, left gaps between segments: 10 times as many wrong
/// answers in the bounding sphere of a torus and of a horse; - the superquadric is the one nearest to the
/// hull (fit.hpp), whose centre then lies within, enlarged about that centre until it holds the segment; -
/// distances are radial, along rays from the superquadric's centre, and rays are cast by exact integers, as
/// for the other maps; samples lie half a step off the poles, uniform in the angles of the formula: exponents
/// below 1 draw them towards edges and corners, and at 0.3 a box has a quarter of a side's length between the
/// two samples next to its middle; - a ray that misses the hull too, as it may where that is flat, leaves its
/// sample empty. A particle whose nearest sample is empty is not in the segment; other empty samples do not
/// enter the interpolation; - of several segments, the one that the particle is deepest in answers.
///
/// Wrong by sampling, by one distance a ray (all from the centre to the outermost face counts as solid), and
/// where a hull leaves the solid. Depth is radial: at least the distance to the segment's surface, often
/// more.
namespace echinus::rivals {

struct SuperquadricMapOptions {
    static constexpr std::uint32_t kMinSampleCount = 4;
    static constexpr std::uint32_t kMaxSampleCount = 4096;
    static constexpr std::uint32_t kMaxSegmentCount = 4096;

    /// Memory and query time grow with it, errors shrink. 0: as many as `concavity` asks for. There are more
    /// where the mesh has more parts (decompose.hpp).
    std::uint32_t segment_count = 0;
    /// How far a segment may be from its convex hull, in diagonals of the mesh's box; looked at when
    /// segment_count is 0. In (0, 1].
    double concavity = 0.05;
    std::uint32_t omega_count = 200; ///< samples around; memory grows with the product of the two
    std::uint32_t eta_count = 200;   ///< samples from pole to pole
    /// If not 0: the finest grid of as many samples along both whose map takes at most so many bytes,
    /// instead.
    std::size_t byte_budget = 0;
    EntryFormat sample_format =
        EntryFormat::Float32; ///< Unorm16 halves the bytes, costs 8e-6 of a segment's size
    /// Meshes with more faces are simplified for the decomposition alone: decompose.hpp has HACD's times.
    std::uint32_t decomposition_face_limit = 6000;
    unsigned thread_count =
        0; ///< 0: all cores, for fits and samples. The bytes of the map do not depend on it.
};

struct FittedSegments;
struct SegmentArrays;

/// A model's segments, each with its superquadric: all of a map but its samples, and most of its build time.
/// Fitted once, it serves maps of all resolutions. Immutable; copies share what was fitted.
class SuperquadricSegments {
  public:
    /// @param mesh     as for SuperquadricMap::build()
    /// @param options  grid and samples are not looked at
    /// @throws Error as SuperquadricMap::build(), and what `progress` throws
    static SuperquadricSegments fit(const TriangleMesh& mesh, const SuperquadricMapOptions& options = {},
                                    const Progress& progress = {});

    std::size_t count() const;

  private:
    friend class SuperquadricMap;
    explicit SuperquadricSegments(std::shared_ptr<const FittedSegments> fitted)
        : fitted_(std::move(fitted)) {}

    std::shared_ptr<const FittedSegments> fitted_;
};

/// Immutable; copies share the arrays. Any number of threads may query one map. Points are in the frame and
/// unit of the mesh.
class SuperquadricMap final : public System {
  public:
    /// Time: HACD's (decompose.hpp), 0.1 s a segment for its fit, and the rays. The same mesh and options
    /// give the same map on one machine; powers and fits are the C library's and the compiler's, so others
    /// may differ in last digits.
    /// @param mesh  closed; which way it is wound does not matter. One that encloses no volume gives a map
    /// without segments, for which everything is outside
    /// @throws Error InvalidMesh as inspect() does, for an open mesh, when the bounding radius lies outside
    /// [1e-15, 1e15], or as decompose() does; InvalidOptions when an option lies outside the bounds above or
    /// the coarsest grid exceeds the budget; and what `progress` throws, when HACD's memory is not freed
    static SuperquadricMap build(const TriangleMesh& mesh, const SuperquadricMapOptions& options = {},
                                 const Progress& progress = {});

    /// The second half of build().
    /// @param options  those of the segments are not looked at
    /// @throws Error InvalidOptions as build(), and what `progress` throws
    static SuperquadricMap sample(const SuperquadricSegments& segments,
                                  const SuperquadricMapOptions& options = {}, const Progress& progress = {});

    /// All that a query reads: for each segment 76 bytes of pose, sizes and exponents, 8 bytes for each row
    /// and each column of its grid (sines and cosines to their powers, for normals), and 4 bytes a sample, 2
    /// if Unorm16.
    std::size_t byte_count() const override;
    std::string name() const override { return "superquadric"; }
    std::string_view counted() const override { return "frames, powers and samples of all segments"; }

    std::size_t segment_count() const;
    std::uint32_t omega_count() const;
    std::uint32_t eta_count() const;

    /// Is the particle in a segment? NaN and infinity are not.
    bool contains(const Vec3f& point_local) const noexcept override;

    /// Inside?, and the way out along the ray from the centre of the segment that the particle is deepest in;
    /// outside, of the one whose surface is nearest, along its ray, if within the margin. The normal is that
    /// of the map's surface there; the face is unknown. @param margin  not negative, NaN counts as 0
    Contact contact(const Vec3f& point_local, float margin = 0) const noexcept override;

    void contains_batch(std::span<const Vec3f> points, std::span<std::uint8_t> inside) const override;
    void contacts_batch(std::span<const Vec3f> points, float margin,
                        std::span<Contact> contacts) const override;
    using System::contacts_batch;

  private:
    explicit SuperquadricMap(std::shared_ptr<const SegmentArrays> arrays) : arrays_(std::move(arrays)) {}

    std::shared_ptr<const SegmentArrays> arrays_;
};

} // namespace echinus::rivals
