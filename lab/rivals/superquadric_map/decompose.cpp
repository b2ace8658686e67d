#include "rivals/superquadric_map/decompose.hpp"

#include "mesh/faces.hpp"

#include <echinus/error.hpp>

#include <hacdHACD.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <span>
#include <string>
#include <tuple>

namespace echinus::rivals {

namespace {

/// The sum of squared distances from planes, each weighted by the area of its face, as a quadratic form.
class Quadric {
  public:
    Quadric() = default;
    Quadric(const Vec3d& normal, double offset, double weight)
        : xx_(weight * normal.x * normal.x), xy_(weight * normal.x * normal.y),
          xz_(weight * normal.x * normal.z), yy_(weight * normal.y * normal.y),
          yz_(weight * normal.y * normal.z), zz_(weight * normal.z * normal.z),
          linear_(normal * (weight * offset)), constant_(weight * offset * offset) {}

    Quadric& operator+=(const Quadric& b) {
        xx_ += b.xx_, xy_ += b.xy_, xz_ += b.xz_, yy_ += b.yy_, yz_ += b.yz_, zz_ += b.zz_;
        linear_ += b.linear_;
        constant_ += b.constant_;
        return *this;
    }
    double at(const Vec3d& p) const {
        const Vec3d product{xx_ * p.x + xy_ * p.y + xz_ * p.z, xy_ * p.x + yy_ * p.y + yz_ * p.z,
                            xz_ * p.x + yz_ * p.y + zz_ * p.z};
        return dot(p, product) + 2 * dot(linear_, p) + constant_;
    }

  private:
    double xx_ = 0, xy_ = 0, xz_ = 0, yy_ = 0, yz_ = 0, zz_ = 0;
    Vec3d linear_;
    double constant_ = 0;
};

/// One end of an edge onto the other, as it was judged when both had these ages.
struct Collapse {
    double cost;
    std::uint32_t from, to;
    std::uint32_t from_age, to_age;

    friend bool operator>(const Collapse& a, const Collapse& b) {
        return std::tie(a.cost, a.from, a.to) > std::tie(b.cost, b.from, b.to);
    }
};

bool has_corner(const Triangle& face, std::uint32_t vertex) {
    return face[0] == vertex || face[1] == vertex || face[2] == vertex;
}

class Simplifier {
  public:
    explicit Simplifier(const TriangleMesh& mesh)
        : faces_(mesh.faces), alive_(mesh.faces.size(), 0), ages_(mesh.vertices.size()),
          faces_at_(mesh.vertices.size()), quadrics_(mesh.vertices.size()) {
        // Around the first vertex in use: a quadric's terms cancel, the farther away the worse.
        const Vec3d origin(mesh.vertices[mesh.faces.front()[0]]);
        for (const Vec3f& p : mesh.vertices) positions_.push_back(Vec3d(p) - origin);
        for (std::uint32_t face = 0; face < faces_.size(); ++face) add(face);
        for (std::uint32_t vertex = 0; vertex < faces_at_.size(); ++vertex) judge_edges_from(vertex);
    }

    void reduce_to(std::size_t face_limit) {
        while (alive_count_ > face_limit && !queue_.empty()) {
            const Collapse next = queue_.top();
            queue_.pop();
            const bool is_stale = ages_[next.from] != next.from_age || ages_[next.to] != next.to_age;
            if (is_stale || !may_collapse(next.from, next.to)) continue;
            collapse(next.from, next.to);
        }
    }

    SimplifiedMesh result(const TriangleMesh& mesh) const {
        SimplifiedMesh simplified;
        simplified.mesh.vertices = mesh.vertices;
        for (std::uint32_t face = 0; face < faces_.size(); ++face) {
            if (!alive_[face]) continue;
            simplified.mesh.faces.push_back(faces_[face]);
            simplified.face_numbers.push_back(face);
        }
        return simplified;
    }

  private:
    Vec3d normal_of(const Triangle& face) const { // twice the area long
        return cross(positions_[face[1]] - positions_[face[0]], positions_[face[2]] - positions_[face[0]]);
    }

    void add(std::uint32_t number) {
        const Triangle& face = faces_[number];
        const Vec3d normal = normal_of(face);
        const double double_area = length(normal);
        if (!(double_area > 0)) return;
        alive_[number] = 1;
        ++alive_count_;
        const Vec3d unit = normal * (1 / double_area);
        const Quadric quadric(unit, -dot(unit, positions_[face[0]]), double_area);
        for (const std::uint32_t vertex : face) {
            faces_at_[vertex].push_back(number);
            quadrics_[vertex] += quadric;
        }
    }

    /// Ascending, each once.
    std::vector<std::uint32_t> neighbours_of(std::uint32_t vertex) const {
        std::vector<std::uint32_t> result;
        for (const std::uint32_t face : faces_at_[vertex])
            for (const std::uint32_t other : faces_[face])
                if (other != vertex) result.push_back(other);
        std::ranges::sort(result);
        result.erase(std::unique(result.begin(), result.end()), result.end());
        return result;
    }

    void judge(std::uint32_t from, std::uint32_t to) {
        // The second term is next to nothing but on plane parts, which it shrinks evenly.
        constexpr double kEvenness = 1e-6;
        Quadric both = quadrics_[from];
        both += quadrics_[to];
        const Vec3d edge = positions_[to] - positions_[from];
        const double cost =
            std::max(both.at(positions_[to]), 0.0) + kEvenness * dot(edge, edge) * dot(edge, edge);
        queue_.push({cost, from, to, ages_[from], ages_[to]});
    }
    void judge_edges_from(std::uint32_t vertex) {
        for (const std::uint32_t other : neighbours_of(vertex)) judge(vertex, other);
    }

    /// The surface stays a surface of the same topology, and no face turns over.
    bool may_collapse(std::uint32_t from, std::uint32_t to) const {
        std::vector<std::uint32_t> common;
        std::ranges::set_intersection(neighbours_of(from), neighbours_of(to), std::back_inserter(common));
        const auto holds_both = [&](std::uint32_t f) { return has_corner(faces_[f], to); };
        const auto shared = std::ranges::count_if(faces_at_[from], holds_both);
        if (common.size() != 2 || shared != 2) return false;
        for (const std::uint32_t number : faces_at_[to]) // the last four faces of a part
            if (has_corner(faces_[number], common[0]) && has_corner(faces_[number], common[1])) return false;
        return std::ranges::all_of(faces_at_[from], [&](std::uint32_t number) {
            return has_corner(faces_[number], to) || stays_upright(number, from, to);
        });
    }
    bool stays_upright(std::uint32_t number, std::uint32_t from, std::uint32_t to) const {
        constexpr double kMinCosine = 0.2;
        Triangle moved = faces_[number];
        std::ranges::replace(moved, from, to);
        const Vec3d before = normal_of(faces_[number]), after = normal_of(moved);
        return dot(before, after) > kMinCosine * length(before) * length(after);
    }

    void collapse(std::uint32_t from, std::uint32_t to) {
        const std::vector<std::uint32_t> around = neighbours_of(from);
        for (const std::uint32_t number : faces_at_[from]) {
            if (has_corner(faces_[number], to)) {
                alive_[number] = 0;
                --alive_count_;
            } else {
                std::ranges::replace(faces_[number], from, to);
                faces_at_[to].push_back(number);
            }
        }
        faces_at_[from].clear();
        for (const std::uint32_t vertex : around)
            std::erase_if(faces_at_[vertex], [&](std::uint32_t number) { return !alive_[number]; });
        quadrics_[to] += quadrics_[from];
        ++ages_[from];
        ++ages_[to];
        for (const std::uint32_t other : neighbours_of(to)) {
            judge(to, other);
            judge(other, to);
        }
    }

    std::vector<Vec3d> positions_;
    std::vector<Triangle> faces_;
    std::vector<std::uint8_t> alive_; ///< [face_count]
    std::size_t alive_count_ = 0;
    std::vector<std::uint32_t> ages_; ///< [vertex_count] how often a vertex took part in a collapse
    std::vector<std::vector<std::uint32_t>> faces_at_;
    std::vector<Quadric> quadrics_;
    std::priority_queue<Collapse, std::vector<Collapse>, std::greater<>> queue_;
};

} // namespace

SimplifiedMesh simplify(const TriangleMesh& mesh, std::size_t face_limit) {
    Simplifier simplifier(mesh);
    simplifier.reduce_to(face_limit);
    return simplifier.result(mesh);
}

namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

// HACD works in a box whose diagonal is twice this.
constexpr double kScale = 1000;

// The weight of perimeter^2 / (4 pi area) of a segment relative to its concavity, which HACD measures in its
// box. Compared with HACD's own 0.1 and with 3 and 10, this value gave the fewest wrong answers for a horse
// in 17 segments and a torus in 12 together. Concavity measured across thin parts as well (extra points) was
// as good, and takes time with the square of the number of faces.
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
    // The remaining faces have no edge, since they are lines or points, or border only on such faces: any
    // segment is right for them.
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
