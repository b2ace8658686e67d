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
/// radial intervals in which surface lies, rounded outwards, with the faces that pass through. Between bands
/// there is no surface, so a comparison answers; within a band the band's faces are tested with exact
/// arithmetic. The number of cells trades memory for speed and never changes an answer.
///
/// "Exact" refers to the map's integer lattice, whose step is 1.9e-6 of the bounding radius: mesh and
/// particle are snapped to it, and from there on no sign is rounded (docs/accuracy.md). Sides are exact;
/// depths, normals and points are those of the snapped mesh, rounded to float.
///
/// All points are in the frame and unit of the mesh that the map was built from ("local").
namespace echinus {

struct ExactMapOptions {
    static constexpr std::uint32_t kMaxDivisions = 512;

    /// Each octant of directions is cut into divisions^2 cells. More cells: shorter bands and lists, faster
    /// answers near the surface, more bytes. 0 without a budget: 0.8 cells per face, or fewer where that is
    /// needed to keep ExactMapView::byte_count() within 512 bytes per face plus 64 KB, plus 12 bytes for each
    /// vertex beyond three per face. Most meshes take 50 bytes per face; only long faces that lie close
    /// together, such as the teeth of a comb, reach the limit. ExactMapStatistics tells what the queries
    /// cost.
    std::uint32_t divisions = 0;
    /// With divisions = 0: the most cells that keep ExactMapView::byte_count() within this, up to 16 times as
    /// many as by default; for an open surface, up to the default. The build takes three or four times as
    /// long as one with the divisions that it finds. 0: no budget.
    std::size_t byte_budget = 0;
    InsideRule rule = InsideRule::Nonzero;
    CentreChoice centre = CentreChoice::BoundingSphere;
    /// Of an open surface: look for the gaps between bands in which the winding number stays certain, so that
    /// queries there need not compute it. That takes up to some 0.2 s of one core. Without it answers are the
    /// same, but take up to eight times as long: for maps that last for a frame. Nothing changes for a closed
    /// mesh.
    bool find_certain_gaps = true;
    unsigned thread_count = 0; ///< 0: all cores. The bytes of the map do not depend on it.
};

/// Findings of the build, stored with the map.
struct ExactMapStatistics {
    std::uint32_t face_count = 0; ///< of the mesh
    /// Faces with two corners on one point of the lattice, where they have no area: they count for distances
    /// only.
    std::uint32_t dropped_faces = 0;
    /// Most faces of one band. In that band contains() looks at each of them, at 1 to 13 ns a face.
    std::uint32_t longest_list = 0;
    float mean_list = 0; ///< faces of a band, mean over all bands
    /// The cost of contains() near the surface: the faces that a query in a band looks at, expected for a
    /// particle on the surface (the mean over bands, each weighed by its number of faces). About 10 for most
    /// meshes at the default; hundreds or thousands where the default is limited by its bytes.
    float expected_tests = 0;
    /// Share of the bounding sphere's volume where the map itself has the answer, which is certain; elsewhere
    /// the winding number is computed for each point, and may be certain as well (Containment). 1 when the
    /// mesh is closed.
    float certain_share = 1;
    /// Share of directions, by solid angle, along which it has to be computed somewhere.
    float uncertain_directions = 0;
};

/// An exact map that owns its arrays, or keeps alive the file that they lie in. Immutable; copies share the
/// arrays. Any number of threads may query one map.
class ExactMap {
  public:
    /// Builds the map on all cores; same mesh and options, same bytes, whatever the number of threads.
    /// @param mesh  closed, or not, a soup of triangles too: then the winding number is the generalised one
    ///              (Jacobson et al. 2013). Gaps in which it stays away from every half have one answer;
    ///              everywhere else it is computed for each particle, in about a microsecond
    /// @throws Error InvalidMesh as inspect() does, or when the bounding radius lies outside [1e-15, 1e15];
    /// InvalidOptions for divisions beyond kMaxDivisions, divisions together with a budget, or a budget that
    /// the coarsest map exceeds
    static ExactMap build(const TriangleMesh& mesh, const ExactMapOptions& options = {});

    /// A map of arrays that already exist. They belong to `storage`, which the map keeps alive. The file
    /// reader uses this. Only ExactMapView::winding_tree is computed anew.
    /// @pre the invariants of ExactMapView hold
    ExactMap(const ExactMapView& view, const ExactMapStatistics& statistics, std::uint64_t source_hash,
             std::shared_ptr<const void> storage);

    /// A map converts to its view, so it can be passed to every query. A view must not outlive its map's
    /// arrays: a temporary map therefore gives none, and has to be named first.
    const ExactMapView& view() const& { return view_; }
    const ExactMapView& view() const&& = delete;
    operator const ExactMapView&() const& { return view_; }
    operator const ExactMapView&() const&& = delete;

    const ExactMapStatistics& statistics() const { return statistics_; }
    /// Identifies the mesh and the options that the map was built from; thread_count does not enter.
    std::uint64_t source_hash() const { return source_hash_; }

  private:
    ExactMapView view_;
    ExactMapStatistics statistics_;
    std::uint64_t source_hash_ = 0;
    std::shared_ptr<const void> storage_;
    std::shared_ptr<const void> winding_tree_; ///< memory of an open surface's, unless it is in the storage
};

// ---- Queries. noexcept, from any number of threads. Queries of one particle do not allocate
//
// NaN or infinity in a point: outside, no contact. On the lattice a particle never lies on the surface: it
// stands for itself moved by (e, e^2, e^3), with e infinitely small (docs/accuracy.md). So a particle on a
// face is inside or outside depending on the face's orientation, and neighbouring closed parts that share a
// face leave no gap and no overlap between them.

/// An answer about an open surface is *certain* where the generalised winding number is at least this far
/// from where the side turns, a half or minus a half, by InsideRule::Parity every half: clear of the places
/// where a hole makes the side a matter of taste. Of a closed surface all are.
inline constexpr double kCertainMargin = 0.1;

/// The side, and whether it is certain.
struct Containment {
    bool inside = false;
    bool certain = true; ///< see kCertainMargin
    /// The winding number was computed for this point. False where the map itself has the answer: everywhere
    /// for a closed surface, and for an open one in the gaps in which the number is shown to stay certain.
    bool computed = false;
};

/// Is the particle inside?
bool contains(const ExactMapView& map, Vec3f point_local) noexcept;

/// contains(), and whether the answer is certain.
Containment classify(const ExactMapView& map, Vec3f point_local) noexcept;

/// The winding number of the surface around a point: how often it goes around it, counted with sign. A whole
/// number where the surface is closed, and else the generalised winding number (Jacobson et al. 2013), whose
/// distance from a half says how much holes and gaps matter. contains() rounds it: inside is where it is
/// beyond one half (InsideRule::Nonzero).
///
/// NaN in a point: NaN. Otherwise, infinity in a point: 0. Does not allocate. Cost for an open surface: a
/// walk through a tree (Barill et al. 2018) of caps that close its holes, or of the faces of a soup, with an
/// error bound for each group that is seen from afar: a microsecond beside caps, 10 to 60 in soups, and more
/// the smaller the tolerance is; contains() needs less, a third of a microsecond and one to ten.
/// @param tolerance  the number may be off by this much, but not to the other side of a half; not negative,
///                   NaN counts as 0, and 0 as 1e-8, to which double can be relied upon
float winding_number(const ExactMapView& map, Vec3f point_local, float tolerance = 1e-2F) noexcept;

/// winding_number() for many points.
/// @param points_local  [n]
/// @param windings      [n] out. Does not overlap points_local
/// @param thread_count  0: all cores. Used for 32 768 points or more; the answers do not depend on it
/// @pre points_local.size() == windings.size()
void winding_number_batch(const ExactMapView& map, StridedSpan<const Vec3f> points_local,
                          std::span<float> windings, float tolerance = 1e-2F,
                          unsigned thread_count = 1) noexcept;

/// Inside?, the nearest point of the whole surface, and its distance: the global minimum, by a branch and
/// bound search. Where parts overlap or are nested, the nearest point may lie inside the solid: faces that do
/// not bound it count as surface too.
///
/// The normal is the direction from the surface point to a particle outside, or from a particle inside to the
/// surface point. For a particle within two lattice steps of the surface, where snapping would make this
/// direction arbitrary, it is the angle-weighted pseudonormal of the faces that meet there (Baerentzen and
/// Aanaes 2005).
///
/// Cost: contains(), and for particles inside or with a margin the search, by vector instructions
/// (instruction_set.hpp): near the surface about 0.3 microseconds for a particle, of which 0.1 are for the
/// side. It grows with the number of faces that are about equally near: from the centre of a sphere it visits
/// them all, at some tens of nanoseconds each (docs/exact_map.md). A margin bounds the search for particles
/// outside.
/// @param margin  particles outside get a contact too when the surface is at most this far; not negative,
///                NaN counts as 0
Contact contact(const ExactMapView& map, Vec3f point_local, float margin = 0) noexcept;

/// contains() for many points, by vector instructions (instruction_set.hpp): the same answers, up to
/// eight times as fast, for 8 points or more. Takes 90 KB of the stack; on one thread it does not allocate.
/// @param points_local  [n]
/// @param inside        [n] out: 1 inside, 0 outside. Does not overlap points_local
/// @param thread_count  0: all cores. Used for 32 768 points or more; the answers do not depend on it
/// @pre points_local.size() == inside.size()
void contains_batch(const ExactMapView& map, StridedSpan<const Vec3f> points_local,
                    std::span<std::uint8_t> inside, unsigned thread_count = 1) noexcept;

/// contact() for many points: the same answers, bit for bit, however many points are in a call. In small or
/// scattered calls a point costs as much as in contact() or a little less; where points lie closer together
/// than a few leaves of the tree are wide, sixteen of them share a search, and cost half as much or less. A
/// point that is about equally near to very many faces costs as much as in contact(). Takes 150 KB of the
/// stack. For more than 256 points it allocates for the time of the call up to 1.1 MB a thread and 1 byte a
/// point; where that fails, it answers one by one, as slowly as contact().
/// @param points_local  [n]
/// @param contacts      [n] out. Does not overlap points_local
/// @pre points_local.size() == contacts.size()
void contacts_batch(const ExactMapView& map, StridedSpan<const Vec3f> points_local, float margin,
                    std::span<Contact> contacts, unsigned thread_count = 1) noexcept;

/// The signed distance of a point from the surface, in the mesh's unit: negative inside, positive outside, as
/// in most signed distance fields. That is the opposite of Contact::depth, which is positive inside.
///
/// For every point, however far away: the value is that of contact() with an infinite margin, thus exact for
/// the snapped mesh (within 3.8e-6 R of that for the given one) and rounded to float. The sign is that of
/// contains(), also where the distance is 0: it is then -0 inside, so std::signbit() tells the side. Where
/// parts overlap or are nested, the distance is to the nearest face, even if that lies inside the solid. For
/// an open surface the sign follows the generalised winding number; classify() says where it is certain.
///
/// NaN in a point: NaN. Otherwise, infinity in a point: infinity. The gradient is 0 in both cases.
/// Does not allocate. Cost: that of contact() with an infinite margin.
/// @param gradient  out, unless null: the unit vector along which the distance grows fastest. It leads from
///                  the nearest point of the surface to a point outside, and from a point inside to the
///                  nearest point of the surface. Within two lattice steps of the surface it is the
///                  pseudonormal (see contact()). Where several points of the surface are nearest (on the
///                  medial axis), it is that of the first of their faces in the map's order
float signed_distance(const ExactMapView& map, Vec3f point_local, Vec3f* gradient = nullptr) noexcept;

/// signed_distance() for many points: the same answers, bit for bit, at the cost of contacts_batch() with an
/// infinite margin. Takes 150 KB of the stack; for more than 256 points up to 4.2 MB a thread and 1 byte a
/// point, for the time of the call. Where these cannot be had, it answers one by one.
/// @param points_local  [n]
/// @param distances     [n] out. Does not overlap points_local
/// @param gradients     [n] out, or empty: not wanted. Does not overlap points_local
/// @param thread_count  0: all cores. Used for 32 768 points or more; the answers do not depend on it
/// @pre points_local.size() == distances.size()
void signed_distance_batch(const ExactMapView& map, StridedSpan<const Vec3f> points_local,
                           std::span<float> distances, std::span<Vec3f> gradients = {},
                           unsigned thread_count = 1) noexcept;

/// Where a particle that moves along a segment first meets the surface.
struct SweepHit {
    float fraction = 1; ///< of the segment: 0 at `from`, 1 at `to`; 1 without a crossing
    Vec3f point;        ///< from + fraction (to - from), local; `to` without a crossing
    /// Unit normal of the face, out of the solid; 0 when nothing is met. Where both sides of the face are
    /// solid, or neither is, it points out of the face's front.
    Vec3f normal;
    std::int32_t face = Contact::kUnknownFace; ///< its number in the mesh
    bool entering = false;                     ///< the crossing leads from outside the solid to its inside

    bool found() const { return face != Contact::kUnknownFace; }
};

/// The first crossing of a segment with the surface. On the lattice, which faces are crossed is exact.
///
/// The segment is that between two lattice points at its ends or, where an end is beyond the lattice, where
/// it enters. No place of it is farther than a lattice step from the given segment, however far away the ends
/// are: all finite points will do. From ends more than 10^6 R apart `fraction`, a float, does not tell the
/// place as `point` does.
///
/// On a closed surface sweep() agrees with contains(): when nothing is met, the winding number is the same at
/// both ends. On an open surface it need not be: the generalised winding number also passes one half where
/// there is no face, so contains() may differ at the ends of a segment that meets nothing.
///
/// NaN or infinity in a point: nothing is met. Does not allocate. Cost: a few comparisons for a segment
/// within one gap of a cell, else the faces whose boxes the segment meets before its first crossing.
SweepHit sweep(const ExactMapView& map, Vec3f from_local, Vec3f to_local) noexcept;

// ---- Deforming surfaces

/// Builds maps of a surface whose vertices move while its triangles stay the same, such as an animated body:
/// memory is reused from one map to the next. Not for several threads at once.
class ExactMapBuilder {
  public:
    /// @throws Error InvalidOptions as ExactMap::build() does
    ExactMapBuilder(std::vector<Triangle> faces, const ExactMapOptions& options);
    ~ExactMapBuilder();
    ExactMapBuilder(ExactMapBuilder&&) noexcept;
    ExactMapBuilder& operator=(ExactMapBuilder&&) noexcept;

    /// The map of the faces with these vertices: the same, bit for bit, as that of ExactMap::build(). Centre,
    /// radius, lattice and resolution are computed anew.
    /// The builder keeps the map. A copy of the map keeps its arrays; without a copy the next rebuild()
    /// writes into the same memory, and views of the old map are no longer valid.
    /// @throws Error as ExactMap::build() does; the builder then holds no map and can be used again
    const ExactMap& rebuild(std::span<const Vec3f> vertices);

  private:
    struct Memory;
    std::unique_ptr<Memory> memory_;
};

// ---- Looking at a map

/// The map's mesh, on its lattice, without the dropped faces, which have no area there.
struct ExactMapSurface {
    TriangleMesh mesh; ///< local frame
    /// [face_count] The length of the longest list that each face is in: a query near the face may have to
    /// test so many. 0 for a face in no list, which is seen edge-on from the centre.
    std::vector<std::uint32_t> longest_list;
};
ExactMapSurface reconstruct_surface(const ExactMapView& map);

} // namespace echinus

ECHINUS_EXPORT_END
