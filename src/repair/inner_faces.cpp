#include "geometry/union_find.hpp"
#include "mesh/faces.hpp"
#include "repair/repairs.hpp"

#include <echinus/exact_map.hpp>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <numeric>
#include <utility>

namespace echinus {

namespace {

using Faces = std::vector<std::uint32_t>;

/// Tests points on both sides of faces, at a small distance from them.
class Sides {
  public:
    /// The barycentric coordinates of the places of a face at which its sides are tested.
    static constexpr std::array<std::array<double, 3>, 4> kPlaces{
        {{1.0 / 3, 1.0 / 3, 1.0 / 3}, {0.8, 0.1, 0.1}, {0.1, 0.8, 0.1}, {0.1, 0.1, 0.8}}};

    Sides(const TriangleMesh& mesh, const ExactMap& map) : mesh_(mesh), map_(map) {}

    /// [faces.size()] Is the solid on the given side of each face (of this mesh) at this place?
    std::vector<std::uint8_t> are_inside(const Faces& faces, std::size_t place, bool behind) const {
        std::vector<Vec3f> points;
        points.reserve(faces.size());
        for (const std::uint32_t face : faces) points.push_back(beside(face, place, behind));
        std::vector<std::uint8_t> inside(faces.size());
        contains_batch(map_, points, inside);
        return inside;
    }

  private:
    Vec3f beside(std::uint32_t face, std::size_t place, bool behind) const {
        // Eight lattice steps: snapping moves the mesh by less than one.
        const double offset = map_.view().radius * (behind ? -0x1p-16 : 0x1p-16);
        std::array<Vec3d, 3> corners;
        Vec3d point;
        for (std::size_t k = 0; k < 3; ++k) {
            corners[k] = Vec3d(mesh_.vertices[mesh_.faces[face][k]]);
            point += corners[k] * kPlaces[place][k];
        }
        const Vec3d normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
        const double twice_area = length(normal);
        return Vec3f(twice_area > 0 ? point + normal * (offset / twice_area) : point);
    }

    const TriangleMesh& mesh_;
    const ExactMap& map_;
};

ExactMap map_of(const TriangleMesh& mesh) {
    return ExactMap::build(mesh, {.thread_count = 1});
}

/// The faces that have the solid on both sides at all places.
Faces faces_within(const TriangleMesh& mesh, const Sides& sides) {
    Faces faces(mesh.faces.size());
    std::iota(faces.begin(), faces.end(), 0U);
    for (std::size_t place = 0; place < Sides::kPlaces.size(); ++place)
        for (const bool behind : {false, true}) {
            const std::vector<std::uint8_t> inside = sides.are_inside(faces, place, behind);
            std::size_t kept = 0;
            for (std::size_t i = 0; i < faces.size(); ++i)
                if (inside[i] != 0) faces[kept++] = faces[i];
            faces.resize(kept);
        }
    return faces;
}

/// How many more faces run in one direction along an edge than in the other.
template <typename Belongs>
std::ptrdiff_t imbalance(std::span<const EdgeUse> uses, const Belongs& belongs) {
    std::ptrdiff_t sum = 0;
    for (const EdgeUse& use : uses)
        if (belongs(use.face)) sum += use.ascending ? 1 : -1;
    return std::abs(sum);
}

enum class Patches { Closed, NotMissed };

/// Selects those patches of neighbours among the faces that are closed, or else those that no edge of another
/// face misses: without them, no edge is less balanced than with them.
Faces whole_patches(const TriangleMesh& mesh, const Faces& faces, Patches wanted) {
    std::vector<bool> is_candidate(mesh.faces.size());
    for (const std::uint32_t face : faces) is_candidate[face] = true;
    const auto goes = [&](std::uint32_t face) { return static_cast<bool>(is_candidate[face]); };
    const auto stays = [&](std::uint32_t face) { return !is_candidate[face]; };
    UnionFind patches(mesh.faces.size());
    std::vector<std::uint32_t> spoilt; // a face of each patch that must stay; perhaps several of a patch
    for_each_edge(sorted_edge_uses(mesh), [&](std::span<const EdgeUse> uses) {
        const auto first =
            std::find_if(uses.begin(), uses.end(), [&](const auto& u) { return goes(u.face); });
        if (first == uses.end()) return;
        for (const EdgeUse& use : uses)
            if (goes(use.face)) patches.join(first->face, use.face);
        const bool misses =
            std::any_of(uses.begin(), uses.end(), [&](const auto& u) { return stays(u.face); }) &&
            imbalance(uses, stays) > imbalance(uses, [](std::uint32_t) { return true; });
        if (wanted == Patches::Closed ? imbalance(uses, goes) != 0 : misses) spoilt.push_back(first->face);
    });
    std::vector<bool> patch_stays(mesh.faces.size());
    for (const std::uint32_t face : spoilt) patch_stays[patches.find(face)] = true;
    Faces whole;
    for (const std::uint32_t face : faces)
        if (!patch_stays[patches.find(face)]) whole.push_back(face);
    return whole;
}

/// Are both sides of all remaining faces unchanged?
bool is_the_same_solid_without(const TriangleMesh& mesh, const Sides& before, const Faces& dropped) {
    Faces kept;
    TriangleMesh rest{mesh.vertices, {}};
    for (std::uint32_t face = 0, next = 0; face < mesh.faces.size(); ++face)
        if (next < dropped.size() && dropped[next] == face) {
            ++next;
        } else {
            kept.push_back(face);
            rest.faces.push_back(mesh.faces[face]);
        }
    if (kept.empty()) return false;
    const ExactMap map = map_of(rest);
    const Sides after(mesh, map);
    for (const bool behind : {false, true})
        if (before.are_inside(kept, 0, behind) != after.are_inside(kept, 0, behind)) return false;
    return true;
}

} // namespace

std::vector<std::uint32_t> find_inner_faces(const TriangleMesh& mesh) {
    const ExactMap map = map_of(mesh);
    const Sides sides(mesh, map);
    const Faces within = faces_within(mesh, sides);
    for (const Patches wanted : {Patches::NotMissed, Patches::Closed}) {
        Faces dropped = whole_patches(mesh, within, wanted);
        if (dropped.empty() || is_the_same_solid_without(mesh, sides, dropped)) return dropped;
    }
    return {};
}

} // namespace echinus
