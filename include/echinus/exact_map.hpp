#pragma once

#include <echinus/contact.hpp>
#include <echinus/directions.hpp>
#include <echinus/exact_map_view.hpp>
#include <echinus/export.hpp>
#include <echinus/geometry.hpp>
#include <echinus/mesh.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

ECHINUS_EXPORT_BEGIN

/// The exact map. Directions around the centre are divided into cells. Each cell stores its *bands*: the
/// radial intervals that contain surface, rounded outwards, with the faces that pass through them. Between
/// bands there is no surface, so a comparison of radii gives the answer; within a band its faces are tested
/// with exact arithmetic. The number of cells trades memory for speed and does not change any answer.
///
/// "Exact" refers to the map's integer lattice, whose step is 1.9e-6 of the bounding radius: mesh and
/// particle are snapped to it, and all signs computed afterwards are exact (docs/accuracy.md). Inside and
/// outside are exact; depths, normals and points are those of the snapped mesh, rounded to float.
///
/// All points are in the frame and unit of the mesh from which the map was built ("local").
namespace echinus {

struct ExactMapOptions {
    static constexpr std::uint32_t kMaxDivisions = 512;

    /// Each octant of directions is divided into divisions^2 cells. More cells give shorter bands and lists
    /// and faster answers near the surface, but take more bytes. 0 without a budget means 0.8 cells per face,
    /// or fewer if that is needed to keep ExactMapView::byte_count() within 512 bytes per face plus 64 KiB,
    /// plus 12 bytes for each vertex beyond three per face. Most meshes take 50 bytes per face; only long
    /// faces that lie close together, such as the teeth of a comb, reach the limit. ExactMapStatistics
    /// estimates the cost of queries.
    std::uint32_t divisions = 0;
    /// With divisions = 0: the map gets as many cells as fit when ExactMapView::byte_count() is limited to
    /// this budget, but at most 16 times the default number, or the default number for an open surface. The
    /// build takes three or four times as long as one with the resulting number of divisions. 0 means no
    /// budget.
    std::size_t byte_budget = 0;
    InsideRule rule = InsideRule::Nonzero;
    CentreChoice centre = CentreChoice::BoundingSphere;
    /// For an open surface: search for gaps between bands in which the winding number stays certain, so that
    /// queries there need not compute it. The search takes up to about 0.2 s of one core. Without the search,
    /// answers are the same but take up to eight times as long, which is acceptable for a map that is used
    /// for one frame only. The option has no effect on a closed mesh.
    bool find_certain_gaps = true;
    unsigned thread_count = 0; ///< 0: all cores. The bytes of the map do not depend on it.
};

/// Statistics of the build, stored with the map.
struct ExactMapStatistics {
    std::uint32_t face_count = 0; ///< the number of the mesh's faces
    /// Faces with two corners at one point of the lattice, which have no area there. They affect distances
    /// and intersections with triangles, but not which points are inside.
    std::uint32_t dropped_faces = 0;
    /// The largest number of faces in a band. In that band contains() tests each of them, at 1 to 13 ns per
    /// face.
    std::uint32_t longest_list = 0;
    float mean_list = 0; ///< mean number of faces in a band
    /// The cost of contains() near the surface: the expected number of faces that a query for a particle on
    /// the surface tests (the mean over bands, weighted by their numbers of faces). It is about 10 for most
    /// meshes with default options, and hundreds or thousands where the size of the map is limited.
    float expected_tests = 0;
    /// Share of the bounding sphere's volume in which the map stores the answer; there it is certain.
    /// Elsewhere the winding number is computed for each point; the answer may be certain there as well
    /// (Containment). It is 1 for a closed mesh.
    float certain_share = 1;
    /// Share of directions, by solid angle, along which the winding number must be computed somewhere.
    float uncertain_directions = 0;
};

/// An exact map that owns its arrays, or keeps alive the file that contains them. It is immutable, and copies
/// share the arrays. Any number of threads may query one map.
class ExactMap {
  public:
    /// Builds the map on all cores. The same mesh and options give the same bytes for any number of threads.
    /// @param mesh  any mesh. If it is open or a triangle soup, the winding number is the generalised one
    /// (Jacobson et al. 2013). A gap in which that number stays away from every threshold (kCertainMargin)
    /// has one stored answer; everywhere else the number is computed for each particle, in about a
    /// microsecond
    /// @throws Error InvalidMesh as inspect() does, or when the bounding radius lies outside [1e-15, 1e15],
    /// no face is larger than a step of the lattice, or too many faces lie on each other; InvalidOptions for
    /// divisions beyond kMaxDivisions, divisions together with a budget, or a budget that the coarsest map
    /// exceeds
    static ExactMap build(const TriangleMesh& mesh, const ExactMapOptions& options = {});

    /// Makes a map from existing arrays. They belong to `storage`, which the map keeps alive. The file reader
    /// uses this constructor. Only ExactMapView::winding_tree is computed.
    /// @pre the invariants of ExactMapView hold
    ExactMap(const ExactMapView& view, const ExactMapStatistics& statistics, std::uint64_t source_hash,
             std::shared_ptr<const void> storage);

    /// A map converts to its view, so it can be passed to every query. Since a view must not outlive its
    /// map's arrays, a temporary map does not convert: store it in a variable first.
    const ExactMapView& view() const& { return view_; }
    const ExactMapView& view() const&& = delete;
    operator const ExactMapView&() const& { return view_; }
    operator const ExactMapView&() const&& = delete;

    const ExactMapStatistics& statistics() const { return statistics_; }
    /// Identifies the mesh and the options from which the map was built; it does not depend on thread_count.
    std::uint64_t source_hash() const { return source_hash_; }

  private:
    ExactMapView view_;
    ExactMapStatistics statistics_;
    std::uint64_t source_hash_ = 0;
    std::shared_ptr<const void> storage_;
    std::shared_ptr<const void> winding_tree_; ///< memory of the winding tree, unless it is in the storage
};

// ---- Queries. They are noexcept and may run on any number of threads. Queries of one particle do not
// allocate.
//
// A point with NaN or infinity is outside and has no contact; for a point with NaN this is not certain. On
// the lattice no particle lies on the surface: it is treated as if it were moved by (e, e^2, e^3), with e
// infinitely small (docs/accuracy.md). So a particle on a face is inside or outside depending on the face's
// orientation, and neighbouring closed parts that share a face have neither a gap nor an overlap between
// them.

/// An answer about an open surface is *certain* if the generalised winding number differs by at least this
/// margin from every threshold between inside and outside: from one half and minus one half or, with
/// InsideRule::Parity, from every odd multiple of one half. Near a threshold the answer depends on how a hole
/// would be closed. For a closed surface all answers are certain, except about a point with NaN.
inline constexpr double kCertainMargin = 0.1;

/// Whether a particle is inside, and whether this is certain.
struct Containment {
    bool inside = false;
    bool certain = true; ///< see kCertainMargin
    /// Whether the winding number was computed for this point. It is not computed where the map stores the
    /// answer: everywhere for a closed surface, and for an open one in the gaps in which the answer was
    /// proven to be certain.
    bool computed = false;
};

/// Is the particle inside?
bool contains(const ExactMapView& map, Vec3f point_local) noexcept;

/// The answer of contains(), and whether it is certain.
Containment classify(const ExactMapView& map, Vec3f point_local) noexcept;

/// classify() for many points.
/// @param points_local  [n]
/// @param answers       [n] out. Must not overlap points_local
/// @param thread_count  number of threads for 32 768 points or more; 0: all cores. The answers do not depend
/// on it
/// @pre points_local.size() == answers.size()
void classify_batch(const ExactMapView& map, StridedSpan<const Vec3f> points_local,
                    std::span<Containment> answers, unsigned thread_count = 1) noexcept;

/// The winding number of the surface around a point: the signed number of times that the surface surrounds
/// it. It is an integer for a closed surface, and otherwise the generalised winding number (Jacobson et al.
/// 2013): the nearer it is to one half, the more holes and gaps matter. contains() rounds the number: a point
/// is inside if the absolute value exceeds one half (InsideRule::Nonzero).
///
/// The result is NaN for a point with NaN, and otherwise 0 for a point with infinity. The query does not
/// allocate. For an open surface it traverses a tree (Barill et al. 2018) of caps that close the holes, or of
/// the faces of a soup, with an error bound for each distant group. This takes 1 microsecond with caps and 10
/// to 60 microseconds for soups, and longer for a smaller tolerance; contains() takes a third of a
/// microsecond with caps and 1 to 10 microseconds for soups.
/// @param tolerance  the largest error of the result; the result is never on the wrong side of an odd
/// multiple of one half. Not negative; NaN counts as 0, and 0 as 1e-8, the accuracy of these sums in double
float winding_number(const ExactMapView& map, Vec3f point_local, float tolerance = 1e-2F) noexcept;

/// winding_number() for many points.
/// @param points_local  [n]
/// @param windings      [n] out. Must not overlap points_local
/// @param thread_count  number of threads for 32 768 points or more; 0: all cores. The answers do not depend
/// on it
/// @pre points_local.size() == windings.size()
void winding_number_batch(const ExactMapView& map, StridedSpan<const Vec3f> points_local,
                          std::span<float> windings, float tolerance = 1e-2F,
                          unsigned thread_count = 1) noexcept;

/// Finds whether the particle is inside, and finds the nearest point of the whole surface and its distance:
/// the global minimum, by a branch-and-bound search. Where parts overlap or are nested, the nearest point may
/// lie inside the solid, since faces that do not bound the solid count as surface, too.
///
/// The normal points from the surface point to a particle that is outside, and from a particle that is inside
/// to the surface point. For a particle within two lattice steps of the surface, where snapping would make
/// this direction arbitrary, it is the angle-weighted pseudonormal of the faces that meet there (Baerentzen
/// and Aanaes 2005).
///
/// The cost is that of contains() plus, for particles inside or with a margin, that of the search with vector
/// instructions (instruction_set.hpp): near the surface about 0.3 microseconds per particle in total, of
/// which contains() takes 0.1. It grows with the number of faces at about the same distance: from the centre
/// of a sphere the search visits all faces, at some tens of nanoseconds each (docs/exact_map.md). A margin
/// limits the search for particles outside.
/// @param margin  particles outside also get a contact if the surface is at most this far away; not negative,
/// NaN counts as 0
Contact contact(const ExactMapView& map, Vec3f point_local, float margin = 0) noexcept;

/// contains() for many points, with the same answers. It uses vector instructions (instruction_set.hpp), and
/// for 8 points or more it is up to eight times as fast as single queries. Each thread keeps 90 KB of memory
/// from its first call on; if this memory cannot be allocated, the points are processed one by one.
/// @param points_local  [n]
/// @param inside        [n] out: 1 inside, 0 outside. Must not overlap points_local
/// @param thread_count  number of threads for 32 768 points or more; 0: all cores. The answers do not depend
/// on it
/// @pre points_local.size() == inside.size()
void contains_batch(const ExactMapView& map, StridedSpan<const Vec3f> points_local,
                    std::span<std::uint8_t> inside, unsigned thread_count = 1) noexcept;

/// contact() for many points, with the same answers, bit for bit, for any number of points. In small or
/// scattered batches a point costs as much as in contact() or a little less. If points are closer together
/// than the width of a few leaves of the tree, sixteen of them share a search, and each costs half as much or
/// less. A point at about the same distance from very many faces costs as much as in contact(). Each thread
/// keeps 100 KB of memory from its first call on. For more than 256 points the function temporarily allocates
/// up to 1.1 MB per thread and 1 byte per point. If memory does not suffice, it processes the points one by
/// one, as slowly as contact().
/// @param points_local  [n]
/// @param contacts      [n] out. Must not overlap points_local
/// @pre points_local.size() == contacts.size()
void contacts_batch(const ExactMapView& map, StridedSpan<const Vec3f> points_local, float margin,
                    std::span<Contact> contacts, unsigned thread_count = 1) noexcept;

/// The signed distance of a point from the surface, in the mesh's unit: negative inside, positive outside, as
/// in most signed distance fields. The sign is the opposite of that of Contact::depth, which is positive
/// inside.
///
/// The function works for every point, however far away. The value is that of contact() with an infinite
/// margin, so it is exact for the snapped mesh, except for rounding to float, and differs from the distance
/// to the given mesh by at most 3.8e-6 R. The sign is that of contains(), even if the distance is 0: it is
/// then -0 inside, so std::signbit() tells whether the point is inside. Where parts overlap or are nested,
/// the distance is to the nearest face, even if that lies inside the solid. For an open surface the sign
/// follows the generalised winding number; classify() tells whether it is certain.
///
/// The result is NaN for a point with NaN, and otherwise infinite for a point with infinity. The gradient is
/// 0 in both cases. The query does not allocate. The cost is that of contact() with an infinite margin.
/// @param gradient  out, unless null: the unit vector along which the distance grows fastest. It points from
/// the nearest surface point to a query point outside, and from a query point inside to the nearest surface
/// point. Within two lattice steps of the surface it is the pseudonormal (see contact()). If several surface
/// points are nearest (on the medial axis), the gradient belongs to the point whose face comes first in the
/// map's order
float signed_distance(const ExactMapView& map, Vec3f point_local, Vec3f* gradient = nullptr) noexcept;

/// signed_distance() for many points, with the same answers, bit for bit, at the cost of contacts_batch()
/// with an infinite margin. It takes as much memory as contacts_batch(), but up to 4.2 MB per thread for more
/// than 256 points.
/// @param points_local  [n]
/// @param distances     [n] out. Must not overlap points_local
/// @param gradients     [n] out, or empty if not needed. Must not overlap points_local
/// @param thread_count  number of threads for 32 768 points or more; 0: all cores. The answers do not depend
/// on it
/// @pre points_local.size() == distances.size()
void signed_distance_batch(const ExactMapView& map, StridedSpan<const Vec3f> points_local,
                           std::span<float> distances, std::span<Vec3f> gradients = {},
                           unsigned thread_count = 1) noexcept;

/// The point at which a particle that moves along a segment first meets the surface.
struct SweepHit {
    float fraction = 1; ///< position on the segment: 0 at `from`, 1 at `to`; 1 without a crossing
    Vec3f point;        ///< from + fraction (to - from), local; `to` without a crossing
    /// Outward unit normal of the face; 0 without a crossing. If both sides of the face are solid, or neither
    /// is, it is the normal of the face's front.
    Vec3f normal;
    std::uint32_t face = kNoIndex; ///< the index of the crossed face in the mesh
    bool entering = false;         ///< the crossing leads into the solid

    bool found() const { return face != kNoIndex; }
};

/// The first crossing of a segment with the surface. The test for crossed faces is exact on the lattice.
///
/// The segment is snapped: its ends become lattice points or, if an end is beyond the lattice, the point at
/// which the segment enters the lattice. The snapped segment deviates from the given one by at most a lattice
/// step, however far away the ends are, so all finite points are allowed. If the ends are more than 10^6 R
/// apart, the float `fraction` is less accurate than `point`.
///
/// On a closed surface sweep() agrees with contains(): without a crossing the winding number is the same at
/// both ends. On an open surface the generalised winding number also crosses one half where there is no face,
/// so contains() may differ at the ends of a segment without a crossing.
///
/// There is no crossing if a point has NaN or infinity. The query does not allocate. A segment within one gap
/// of a cell takes a few comparisons; other segments are tested against the faces whose boxes they meet
/// before the first crossing.
SweepHit sweep(const ExactMapView& map, Vec3f from_local, Vec3f to_local) noexcept;

/// sweep() for many segments.
/// @param from_local, to_local  [n]
/// @param hits                  [n] out. Must not overlap the points
/// @param thread_count          the number of threads for 32 768 segments or more; 0: all cores
/// @pre all three arrays have the same size
void sweep_batch(const ExactMapView& map, StridedSpan<const Vec3f> from_local,
                 StridedSpan<const Vec3f> to_local, std::span<SweepHit> hits,
                 unsigned thread_count = 1) noexcept;

// ---- Deforming surfaces

/// Builds maps of a surface whose vertices move while its triangles stay the same, such as an animated body.
/// It reuses memory from one map to the next. It must not be used by several threads at once.
class ExactMapBuilder {
  public:
    /// @throws Error InvalidOptions as ExactMap::build() does
    ExactMapBuilder(std::vector<Triangle> faces, const ExactMapOptions& options);
    ~ExactMapBuilder();
    ExactMapBuilder(ExactMapBuilder&&) noexcept;
    ExactMapBuilder& operator=(ExactMapBuilder&&) noexcept;

    /// Builds the map of the faces with these vertices, bit-identical to that of ExactMap::build(). Centre,
    /// radius, lattice and resolution are recomputed. The memory of the previous map is reused unless that
    /// map or a copy of it still exists.
    /// @throws Error as ExactMap::build() does; the builder can be used again
    [[nodiscard]] ExactMap rebuild(std::span<const Vec3f> vertices);

  private:
    struct Memory;
    std::unique_ptr<Memory> memory_;
};

// ---- Inspecting a map
/// The map's mesh on its lattice, without the dropped faces, which have no area there.
struct ExactMapSurface {
    TriangleMesh mesh; ///< local frame
    /// [face_count] For each face the length of the longest list that contains it: the largest number of
    /// faces that a query near it may have to test. It is 0 for a face in no list: one that is seen edge-on
    /// from the centre.
    std::vector<std::uint32_t> longest_list;
};
ExactMapSurface reconstruct_surface(const ExactMapView& map);

} // namespace echinus

ECHINUS_EXPORT_END
