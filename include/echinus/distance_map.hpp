#pragma once

#include <echinus/contact.hpp>
#include <echinus/directions.hpp>
#include <echinus/export.hpp>
#include <echinus/geometry.hpp>
#include <echinus/mesh.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

ECHINUS_EXPORT_BEGIN

/// The paper's map. It has a grid of directions around the centre C of the model's bounding sphere, and for
/// each direction the sorted distances of all points where its ray meets the surface (Vogiannou et al.,
/// "Distance Maps for Collision Detection of Deformable Models", section 2). Since the map is sampled, it can
/// be wrong near silhouettes and between samples; docs/reproduction.md has the error rates.
///
/// All points are in the frame and unit of the mesh from which the map was built ("local").
namespace echinus {

/// The treatment of mesh vertices that linear interpolation between samples cuts off (the paper's figure 1b).
enum class VertexCorrection : std::uint8_t {
    None,  ///< entries are the exact crossings
    Paper, ///< the four samples around a vertex are increased by the missing distance, in every layer
    /// Entries of layers in which the ray leaves the solid are increased, and those of layers in which it
    /// enters are decreased, so that both corrections enlarge the solid.
    Signed,
};

/// The format in which an entry is stored.
enum class EntryFormat : std::uint8_t {
    Float32,
    Unorm16, ///< half the bytes: steps of 1/65535 of the largest entry; the error is at most R / 131070
             ///< = 7.6e-6 R, and sqrt(3) times as much on octahedral and ellipsoidal grids
};

struct DistanceMapOptions {
    static constexpr std::uint32_t kMinSampleCount = 4;
    static constexpr std::uint32_t kMaxSampleCount = 8192;
    static constexpr std::uint32_t kMinDivisions = 4;
    static constexpr std::uint32_t kMaxDivisions = 4096;

    DirectionGrid grid = DirectionGrid::Spherical; ///< decides which of the numbers below are used
    /// Spherical and ellipsoidal: number of samples of the longitude phi; memory and build time grow with the
    /// product of this and colatitude_count.
    std::uint32_t longitude_count = 200;
    /// Spherical and ellipsoidal: number of samples of the colatitude theta; doubling both numbers divides
    /// the share of wrong signs by 2.5.
    std::uint32_t colatitude_count = 200;
    /// Octahedral and cube: the number of parts into which each edge is divided. The octahedron has (2
    /// divisions + 1)^2 samples, and the cube 6 (divisions + 1)^2; the octahedron with 100 divisions and the
    /// cube with 81 take as many bytes as 200 x 200 directions.
    std::uint32_t divisions = 100;
    VertexCorrection correction =
        VertexCorrection::Signed;                    ///< None is unbiased; Signed misses fewer particles
    EntryFormat entry_format = EntryFormat::Float32; ///< Unorm16 halves the size of the entries
    /// Spherical and ellipsoidal: samples crowd at the poles, so put the poles where the detail is.
    PoleAxis pole_axis = PoleAxis::Z;
    CentreChoice centre =
        CentreChoice::BoundingSphere; ///< the start of the rays; with Search a build takes five times as long
    unsigned thread_count = 0;        ///< 0: all cores. The bytes of the map do not depend on it.
};

/// Statistics of the build, stored with the map.
struct DistanceMapStatistics {
    std::uint32_t face_count = 0; ///< the number of the mesh's faces
    std::uint32_t dropped_faces =
        0; ///< faces with two corners at one point of the lattice, which have no area there
    std::uint32_t max_entries = 0;       ///< largest number of entries of one direction
    std::uint32_t corrected_entries = 0; ///< entries moved by the vertex correction
    std::uint32_t clamped_entries = 0;   ///< corrections cut short at 0, R or a neighbouring entry
    /// Share of directions whose number of entries has the wrong parity for the centre, because of holes that
    /// can be seen from the centre. It is 0 for a closed mesh.
    float wrong_parity_share = 0;
};

/// A map as plain arrays, wherever they are stored: in a DistanceMap, in a mapped file, or in JavaScript's
/// memory. All queries take a view. It owns nothing and is cheap to copy. validate() in src/distance_map
/// checks its invariants, for untrusted bytes and for built maps: entry_offsets ascends from 0 to the number
/// of entries; the entries of a direction ascend within [0, largest_entry()].
struct DistanceMapView {
    Vec3f centre;     ///< C, local
    float radius = 0; ///< R: every vertex of the mesh lies within R of C
    DirectionGrid grid = DirectionGrid::Spherical;
    std::uint32_t longitude_count = 0;  ///< spherical and ellipsoidal; 0 in other maps
    std::uint32_t colatitude_count = 0; ///< spherical and ellipsoidal; 0 in other maps
    std::uint32_t divisions = 0;        ///< octahedral and cube; 0 in other maps
    PoleAxis pole_axis = PoleAxis::Z;   ///< spherical and ellipsoidal
    /// Ellipsoidal: the factors of x, y and z that are applied before a direction's longitude and colatitude
    /// are computed, each within [1/64, 1]. They are 1 in other maps.
    Vec3f scale{1, 1, 1};
    EntryFormat entry_format = EntryFormat::Float32;
    VertexCorrection correction = VertexCorrection::None;
    bool centre_inside = false;
    /// [direction_count + 1] The index of a direction is j * longitude_count + i for longitude i and
    /// colatitude j; j * (2 divisions + 1) + i for column i and row j of the unfolded octahedron
    /// (docs/file_format.md); and (s (divisions + 1) + j) (divisions + 1) + i for column i and row j of side
    /// s of the cube.
    std::span<const std::uint32_t> entry_offsets;
    /// [entry_count] or empty. Spherical and cube: distances from C. Octahedral: L1 radii |x| + |y| + |z|
    /// around C. Ellipsoidal: distances from C in the scaled frame.
    std::span<const float> entries_float32;
    std::span<const std::uint16_t>
        entries_unorm16; ///< [entry_count] or empty: these entries times 65535 / largest_entry(), rounded
    Vec3d origin{};      ///< TriangleMesh::origin: the origin of the local frame. Queries ignore it

    std::size_t direction_count() const;
    /// R; octahedral: a little more than sqrt(3) R, the largest L1 radius in the bounding sphere;
    /// ellipsoidal: R, or a little more than sqrt(3) times the smallest scale times R if that is less.
    float largest_entry() const;
    std::size_t entry_count() const { return entry_offsets.empty() ? 0 : entry_offsets.back(); }
    /// The size of all arrays that a query reads.
    std::size_t byte_count() const {
        return entry_offsets.size_bytes() + entries_float32.size_bytes() + entries_unorm16.size_bytes();
    }
};

/// A distance map that owns its arrays, or keeps alive the file that contains them. It is immutable, and
/// copies share the arrays. Any number of threads may query one map.
class DistanceMap {
  public:
    /// Builds the map on all cores. The same mesh and options give the same bytes for any number of threads.
    /// The time is O(faces + crossings + directions).
    /// @param mesh  closed; behind a hole answers are wrong, and wrong_parity_share is the share of
    /// directions that see one. VertexCorrection::Signed also requires faces that are counter-clockwise
    /// seen from outside. A solid so flat or thin that no ray meets it gives a map without entries, for which
    /// every point is outside
    /// @throws Error InvalidMesh as inspect() does, or when the bounding radius lies outside [1e-15, 1e15];
    /// InvalidOptions when a count that the grid uses lies outside the bounds in DistanceMapOptions
    static DistanceMap build(const TriangleMesh& mesh, const DistanceMapOptions& options = {});

    /// Makes a map from existing arrays. They belong to `storage`, which the map keeps alive. The file reader
    /// uses this constructor.
    /// @pre the invariants of DistanceMapView hold
    DistanceMap(const DistanceMapView& view, const DistanceMapStatistics& statistics,
                std::uint64_t source_hash, std::shared_ptr<const void> storage);

    /// A map converts to its view, so it can be passed to every query. Since a view must not outlive its
    /// map's arrays, a temporary map does not convert: store it in a variable first.
    const DistanceMapView& view() const& { return view_; }
    const DistanceMapView& view() const&& = delete;
    operator const DistanceMapView&() const& { return view_; }
    operator const DistanceMapView&() const&& = delete;

    const DistanceMapStatistics& statistics() const { return statistics_; }
    /// Identifies the mesh and the options that the map was built from; it does not depend on
    /// thread_count.
    std::uint64_t source_hash() const { return source_hash_; }

  private:
    DistanceMapView view_;
    DistanceMapStatistics statistics_;
    std::uint64_t source_hash_ = 0;
    std::shared_ptr<const void> storage_;
};

// ---- Queries: paper section 2.2. They are noexcept and may run on any number of threads. On one thread they
// do not allocate
//
// A point with NaN or infinity is outside and has no contact. The centre is inside if centre_inside is true;
// its push-out follows the direction of longitude 0 and colatitude 0. Points on the seam (longitude 0 = 2 pi)
// and at the poles need no special treatment.

/// Is the particle inside? Points outside the bounding sphere are not. If a direction has no entries, as in a
/// hole of an open mesh, the whole ray up to R has the same answer as the centre.
bool contains(const DistanceMapView& map, Vec3f point_local) noexcept;

/// Finds whether the particle is inside, how deep it is along its ray, and where the push-out leads: to the
/// interpolated entry nearest to the particle on its own ray. The depth is radial, so it is at least the true
/// depth below the map's surface and often greater. The normal is that of the map's surface at `point`, so
/// that (point, normal) is the contact plane; it is not parallel to the push-out in general.
///
/// @param margin  particles outside that are at most this far from the nearest entry along their ray also get
/// a contact, with negative depth. Not negative; NaN counts as 0.
///
/// If the ray does not leave the solid, as in a hole of an open mesh, the solid ends at the bounding sphere.
Contact contact(const DistanceMapView& map, Vec3f point_local, float margin = 0) noexcept;

/// contains() for many points, with the same answers. It uses vector instructions (instruction_set.hpp) and
/// is several times as fast as single queries.
/// @param points_local  [n]
/// @param inside        [n] out: 1 inside, 0 outside. Must not overlap points_local.
/// @param thread_count  number of threads for 32 768 points or more; 0: all cores. The answers do not depend
/// on it
/// @pre points_local.size() == inside.size()
void contains_batch(const DistanceMapView& map, StridedSpan<const Vec3f> points_local,
                    std::span<std::uint8_t> inside, unsigned thread_count = 1) noexcept;

/// contact() for many points, with the same answers; it uses vector instructions, too.
/// @param points_local  [n]
/// @param contacts      [n] out. Must not overlap points_local.
/// @pre points_local.size() == contacts.size()
void contacts_batch(const DistanceMapView& map, StridedSpan<const Vec3f> points_local, float margin,
                    std::span<Contact> contacts, unsigned thread_count = 1) noexcept;

// ---- Inspecting a map
/// The numbers of directions with 0, 1, 2 ... entries.
std::vector<std::size_t> entry_histogram(const DistanceMapView& map);

/// The number of samples around a point that are used in the interpolation, out of four, or out of three on
/// an octahedron (paper section 2.2: "rarely ... less than 3"). It is 1 to 4, or 0 for a point that is
/// outside the sphere or not finite, for which no query interpolates.
int usable_sample_count(const DistanceMapView& map, Vec3f point_local) noexcept;

/// The surface of the map (figures 2 and 3): where four neighbouring directions have the same number of
/// entries, each layer is a quadrilateral that is divided into two triangles; on an octahedron, three such
/// directions give a triangle.
struct MapSurface {
    TriangleMesh mesh;                ///< local frame; faces point out of the solid
    std::vector<std::uint32_t> layer; ///< [face_count] the face's layer; 0 for the one nearest to the centre
};
MapSurface reconstruct_surface(const DistanceMapView& map);

} // namespace echinus

ECHINUS_EXPORT_END
