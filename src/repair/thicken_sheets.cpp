#include "files/text.hpp"
#include "geometry/union_find.hpp"
#include "mesh/faces.hpp"
#include "mesh/require_valid.hpp"
#include "repair/repairs.hpp"

#include <echinus/error.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace echinus {

namespace {

std::vector<bool> find_open_components(const Components& components, std::span<const EdgeUse> edge_uses) {
    std::vector<bool> is_open(components.count);
    for_each_edge(edge_uses, [&](std::span<const EdgeUse> uses) {
        if (!is_balanced(uses)) is_open[components.of_face[uses[0].face]] = true;
    });
    return is_open;
}

/// Rejects a thickness so small that both sides would be rounded to the same position, or so large that the
/// unit must be wrong.
void require_suitable(const TriangleMesh& mesh, double thickness) {
    double farthest = 0;
    const std::vector<Vec3f> positions = used_positions(mesh);
    for (const Vec3f& p : positions)
        farthest =
            std::max({farthest, std::fabs(double{p.x}), std::fabs(double{p.y}), std::fabs(double{p.z})});
    const double radius = smallest_enclosing_sphere(positions).radius;
    // 16 steps of a map's lattice or of float.
    const double least = std::max(radius * 0x1p-15, farthest * 0x1p-20);
    if (thickness >= least && thickness <= radius) return;
    throw Error(ErrorCode::InvalidOptions,
                "sheets cannot be given the thickness " + number_text(thickness) +
                    "; for this mesh it must be " + number_text(least) + " to " + number_text(radius) +
                    ", from what its coordinates resolve to the radius of its bounding sphere");
}

/// The sheets of a mesh: faces of open components, connected across every edge at which exactly two of them
/// meet and run in opposite directions. Any other edge is a rim of each of its faces. The corners of
/// connected faces at one vertex form a *fan*, which gets a front and a back vertex of its own.
class Sheets {
  public:
    Sheets(TriangleMesh& mesh, double thickness)
        : mesh_(mesh), edge_uses_(sorted_edge_uses(mesh)), face_count_(mesh.faces.size()),
          fans_(3 * face_count_), sheets_(face_count_), is_sheet_(face_count_) {
        const Components components = find_components(mesh);
        const std::vector<bool> is_open = find_open_components(components, edge_uses_);
        for (std::size_t face = 0; face < face_count_; ++face)
            is_sheet_[face] = is_open[components.of_face[face]] && !has_equal_corners(mesh.faces[face]);
        if (std::find(is_sheet_.begin(), is_sheet_.end(), true) == is_sheet_.end()) return;
        require_suitable(mesh, thickness);
        join_neighbours();
        make_vertices(thickness / 2);
        make_faces();
    }

    std::size_t count() {
        std::size_t result = 0;
        for (std::uint32_t face = 0; face < face_count_; ++face)
            result += is_sheet_[face] && sheets_.find(face) == face ? 1 : 0;
        return result;
    }

  private:
    static bool is_inner(std::span<const EdgeUse> uses) { return uses.size() == 2 && is_balanced(uses); }

    /// The corners at which a use of an edge begins and ends.
    static std::uint32_t begin_of(const EdgeUse& use) { return 3 * use.face + use.corner; }
    static std::uint32_t end_of(const EdgeUse& use) { return 3 * use.face + (use.corner + 1U) % 3; }

    void join_neighbours() {
        for_each_edge(std::span<const EdgeUse>(edge_uses_), [&](std::span<const EdgeUse> uses) {
            if (!is_inner(uses)) return;
            sheets_.join(uses[0].face, uses[1].face);
            fans_.join(begin_of(uses[0]), end_of(uses[1]));
            fans_.join(end_of(uses[0]), begin_of(uses[1]));
        });
    }

    Vec3d position_of(std::uint32_t corner) const {
        return Vec3d(mesh_.vertices[mesh_.faces[corner / 3][corner % 3]]);
    }

    template <typename Visit>
    void for_each_corner(const Visit& visit) {
        for (std::uint32_t corner = 0; corner < 3 * face_count_; ++corner)
            if (is_sheet_[corner / 3]) visit(corner, fans_.find(corner));
    }

    /// For each fan, a displacement that moves all its faces by at least the given distance, unless their
    /// normals differ from it by more than 60 degrees.
    std::vector<Vec3d> find_offsets(double distance) {
        // The weights of Max, "Weights for Computing Vertex Normals from Facet Normals" (1999), which require
        // no trigonometry.
        std::vector<Vec3d> offsets(3 * face_count_), normals(face_count_);
        for_each_corner([&](std::uint32_t corner, std::uint32_t fan) {
            const std::uint32_t face = corner / 3;
            const Vec3d p = position_of(corner);
            const Vec3d a = position_of(3 * face + (corner + 1) % 3) - p;
            const Vec3d b = position_of(3 * face + (corner + 2) % 3) - p;
            const double weight = dot(a, a) * dot(b, b);
            if (weight > 0) offsets[fan] += cross(a, b) * (1 / weight);
            normals[face] = unit(cross(a, b));
        });
        std::vector<double> least_cosine(3 * face_count_, 1);
        for_each_corner([&](std::uint32_t corner, std::uint32_t fan) {
            if (corner == fan) offsets[fan] = unit(offsets[fan]);
        });
        for_each_corner([&](std::uint32_t corner, std::uint32_t fan) {
            if (normals[corner / 3] != Vec3d{})
                least_cosine[fan] = std::min(least_cosine[fan], dot(normals[corner / 3], offsets[fan]));
        });
        constexpr double kSharpest = 0.5;
        for_each_corner([&](std::uint32_t corner, std::uint32_t fan) {
            if (corner == fan) offsets[fan] *= distance / std::max(least_cosine[fan], kSharpest);
        });
        return offsets;
    }

    /// The unit vector, or 0 for 0.
    static Vec3d unit(const Vec3d& v) {
        const double size = length(v);
        return size > 0 ? v * (1 / size) : Vec3d{};
    }

    void make_vertices(double distance) {
        const std::vector<Vec3d> offsets = find_offsets(distance);
        const std::size_t old_count = mesh_.vertices.size();
        std::vector<bool> is_taken(old_count);
        front_.resize(3 * face_count_);
        back_.resize(3 * face_count_);
        const std::vector<Vec3f> old(mesh_.vertices);
        for_each_corner([&](std::uint32_t corner, std::uint32_t fan) {
            if (corner != fan) return; // the fan's smallest corner comes first
            const std::uint32_t vertex = mesh_.faces[corner / 3][corner % 3];
            const Vec3d middle(old[vertex]);
            const Vec3d offset = offsets[fan] == Vec3d{} ? Vec3d{0, 0, distance} : offsets[fan];
            if (is_taken[vertex]) mesh_.vertices.emplace_back();
            front_[fan] = is_taken[vertex] ? last_vertex() : vertex;
            is_taken[vertex] = true;
            mesh_.vertices[front_[fan]] = Vec3f(middle + offset);
            mesh_.vertices.push_back(Vec3f(middle - offset));
            back_[fan] = last_vertex();
        });
    }

    std::uint32_t last_vertex() const { return static_cast<std::uint32_t>(mesh_.vertices.size() - 1); }

    void make_faces() {
        for (std::uint32_t face = 0; face < face_count_; ++face) {
            if (!is_sheet_[face]) continue;
            const std::array<std::uint32_t, 3> fans{fans_.find(3 * face), fans_.find(3 * face + 1),
                                                    fans_.find(3 * face + 2)};
            mesh_.faces[face] = {front_[fans[0]], front_[fans[1]], front_[fans[2]]};
            mesh_.faces.push_back({back_[fans[0]], back_[fans[2]], back_[fans[1]]});
        }
        for_each_edge(std::span<const EdgeUse>(edge_uses_), [&](std::span<const EdgeUse> uses) {
            if (is_inner(uses)) return;
            for (const EdgeUse& use : uses)
                if (is_sheet_[use.face]) add_wall(fans_.find(begin_of(use)), fans_.find(end_of(use)));
        });
    }

    /// Adds the faces along a rim that runs from one fan to another.
    void add_wall(std::uint32_t from, std::uint32_t to) {
        mesh_.faces.push_back({front_[to], front_[from], back_[from]});
        mesh_.faces.push_back({front_[to], back_[from], back_[to]});
    }

    TriangleMesh& mesh_;
    std::vector<EdgeUse> edge_uses_; ///< of the sheets in their original state
    std::size_t face_count_;         ///< of the original mesh
    UnionFind fans_;                 ///< [3 * face_count] corners
    UnionFind sheets_;               ///< [face_count]
    std::vector<bool> is_sheet_;     ///< [face_count]
    std::vector<std::uint32_t> front_,
        back_; ///< [3 * face_count] the vertices of each fan, indexed by its first corner
};

} // namespace

std::size_t thicken_sheets(TriangleMesh& mesh, double thickness) {
    return Sheets(mesh, thickness).count();
}

} // namespace echinus
