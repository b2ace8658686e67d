#include "rivals/superquadric_map/decompose.hpp"

#include "mesh/edges.hpp"
#include "rivals/superquadric_map/simplify.hpp"

#include <echinus/error.hpp>

#include <hacdHACD.h>

#include <algorithm>
#include <limits>
#include <span>
#include <string>

namespace echinus::rivals {

namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

// HACD works in a box whose diagonal is twice this.
constexpr double kScale = 1000;

// What perimeter^2 / (4 pi area) of a segment counts against its concavity, which HACD measures in its box.
// Of its own 0.1 and of 1, 3 and 10, this gave the fewest wrong answers on a horse in 17 segments and a torus
// in 12 together. Concavity measured across thin parts as well (extra points) was as good, and takes time
// with the square of the number of faces.
constexpr double kCompactness = 1;

/// HACD reports to a plain function, so what it is to call waits here.
thread_local const Progress* listener = nullptr;

class Listening {
  public:
    explicit Listening(const Progress& progress) { listener = &progress; }
    ~Listening() { listener = nullptr; }
    Listening(const Listening&) = delete;
    Listening& operator=(const Listening&) = delete;

    static bool report(const char* message, double percent, double, std::size_t) {
        const bool is_heading = *message == '+' || *message == '\t'; // these come with other numbers
        if (*listener && !is_heading) (*listener)("decompose", percent / 100);
        return true;
    }
};

/// Moves coordinates by at most a millionth of the mesh's extent, each time another way. HACD's hulls, of
/// plain doubles, go wrong where four points lie in one plane, as on every sphere of meridians and parallels:
/// it then takes points of a convex surface for deep in its hull and will not merge it (a sphere fell into 7
/// segments).
class Jitter {
  public:
    explicit Jitter(const TriangleMesh& mesh) {
        for (const Triangle& face : mesh.faces)
            for (const std::uint32_t vertex : face)
                extent_ = std::max(
                    extent_, length(Vec3d(mesh.vertices[vertex]) - Vec3d(mesh.vertices[mesh.faces[0][0]])));
    }
    double operator()(double coordinate) {
        constexpr double kShare = 1e-6;
        state_ = state_ * 6364136223846793005U + 1442695040888963407U; // Knuth's MMIX
        return coordinate + kShare * extent_ * (static_cast<double>(state_ >> 11U) * 0x1p-53 - 0.5);
    }

  private:
    double extent_ = 0;
    std::uint64_t state_ = 1;
};

struct HacdMesh {
    std::vector<HACD::Vec3<HACD::Real>> points;
    std::vector<HACD::Vec3<long>> triangles;

    explicit HacdMesh(const TriangleMesh& mesh) {
        Jitter jitter(mesh);
        std::vector<long> numbers(mesh.vertices.size(),
                                  -1); // HACD goes by the box of all points, used or not
        for (const Triangle& face : mesh.faces)
            for (const std::uint32_t vertex : face) {
                if (numbers[vertex] >= 0) continue;
                numbers[vertex] = static_cast<long>(points.size());
                const Vec3d p(mesh.vertices[vertex]);
                const double x = jitter(p.x), y = jitter(p.y);
                points.emplace_back(x, y, jitter(p.z));
            }
        for (const auto& [a, b, c] : mesh.faces) triangles.emplace_back(numbers[a], numbers[b], numbers[c]);
    }
};

/// [face_count]
std::vector<std::uint32_t> run_hacd(const TriangleMesh& mesh, const DecompositionOptions& options,
                                    const Progress& progress) {
    HacdMesh input(mesh);
    HACD::HACD hacd;
    hacd.SetPoints(input.points.data());
    hacd.SetNPoints(input.points.size());
    hacd.SetTriangles(input.triangles.data());
    hacd.SetNTriangles(input.triangles.size());
    hacd.SetScaleFactor(kScale);
    hacd.SetCompacityWeight(kCompactness);
    hacd.SetVolumeWeight(0);
    hacd.SetAddExtraDistPoints(false);
    hacd.SetAddNeighboursDistPoints(false);
    hacd.SetAddFacesPoints(false);
    hacd.SetNClusters(std::max<std::size_t>(options.segment_count, 1));
    hacd.SetConcavity(options.segment_count > 0 ? std::numeric_limits<double>::max()
                                                : options.concavity * 2 * kScale);
    hacd.SetCallBack(&Listening::report);
    const Listening listening(progress);
    if (!hacd.Compute()) throw Error(ErrorCode::InvalidMesh, "HACD could not decompose the mesh");
    return {hacd.GetPartition(), hacd.GetPartition() + mesh.faces.size()};
}

/// Gives faces that have no segment that of the nearest face with one, counted in steps over edges.
void spread(const TriangleMesh& mesh, std::vector<std::uint32_t>& segments) {
    std::vector<std::vector<std::uint32_t>> neighbours(mesh.faces.size());
    const std::vector<EdgeUse> uses = sorted_edge_uses(mesh);
    for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
        for (const EdgeUse& use : edge.subspan(1)) {
            neighbours[use.face].push_back(edge.front().face);
            neighbours[edge.front().face].push_back(use.face);
        }
    });
    std::vector<std::uint32_t> reached;
    for (std::uint32_t face = 0; face < segments.size(); ++face)
        if (segments[face] != kNone) reached.push_back(face);
    for (std::size_t i = 0; i < reached.size(); ++i)
        for (const std::uint32_t neighbour : neighbours[reached[i]]) {
            if (segments[neighbour] != kNone) continue;
            segments[neighbour] = segments[reached[i]];
            reached.push_back(neighbour);
        }
    // What is left has no edge, being a line or a point, or borders on nothing but the like: anywhere is
    // right.
    std::ranges::replace(segments, kNone, segments[reached.front()]);
}

/// Numbers segments in the order of their first faces and counts them.
Decomposition numbered(std::vector<std::uint32_t> segments) {
    Decomposition result;
    std::vector<std::uint32_t> numbers(segments.size(), kNone);
    for (std::uint32_t& segment : segments) {
        if (numbers[segment] == kNone) numbers[segment] = result.segment_count++;
        segment = numbers[segment];
    }
    result.segment_of_face = std::move(segments);
    return result;
}

} // namespace

Decomposition decompose(const TriangleMesh& mesh, const DecompositionOptions& options,
                        const Progress& progress) {
    if (progress) progress("simplify", 0);
    const SimplifiedMesh simplified = simplify(mesh, options.face_limit);
    if (simplified.mesh.faces.empty()) throw Error(ErrorCode::InvalidMesh, "no face of the mesh has an area");
    constexpr std::size_t kPatience = 4;
    if (simplified.mesh.faces.size() > kPatience * options.face_limit)
        throw Error(ErrorCode::InvalidMesh,
                    "a superquadric map of this mesh would take too long: it can only be simplified to " +
                        std::to_string(simplified.mesh.faces.size()) + " faces, " +
                        std::to_string(options.face_limit) + " are wanted");
    const std::vector<std::uint32_t> found = run_hacd(simplified.mesh, options, progress);
    std::vector<std::uint32_t> segments(mesh.faces.size(), kNone);
    for (std::size_t i = 0; i < found.size(); ++i) segments[simplified.face_numbers[i]] = found[i];
    spread(mesh, segments);
    return numbered(std::move(segments));
}

} // namespace echinus::rivals
