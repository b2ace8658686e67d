#include "simulation/deformables/cloth_surface.hpp"

#include "mesh/faces.hpp"

#include <echinus/error.hpp>

#include <string>
#include <utility>

namespace echinus {

namespace {

[[noreturn]] void fail_for_surface(const std::string& sentence) {
    throw Error(ErrorCode::InvalidMesh, sentence);
}

std::string name_of(std::span<const EdgeUse> uses) {
    std::string faces;
    for (const EdgeUse& use : uses) faces += (faces.empty() ? "" : ", ") + std::to_string(use.face);
    return "the edge between vertices " + std::to_string(uses[0].low) + " and " +
           std::to_string(uses[0].high) + " has the faces " + faces;
}

void require_cloth(const TriangleMesh& mesh, std::span<const EdgeUse> edge_uses) {
    for (std::size_t face = 0; face < mesh.faces.size(); ++face)
        if (has_equal_corners(mesh.faces[face]))
            fail_for_surface("face " + std::to_string(face) +
                             " of the cloth has two equal corners; remove it");
    for_each_edge(edge_uses, [](std::span<const EdgeUse> uses) {
        if (uses.size() > 2)
            fail_for_surface(name_of(uses) +
                             "; an edge of a cloth has at most two: give all others vertices of their own");
    });
    const auto equal = find_equal_faces(mesh);
    if (!equal.empty())
        fail_for_surface("faces " + std::to_string(equal[0][0]) + " and " + std::to_string(equal[0][1]) +
                         " of the cloth have the same corners; remove one of them (repair() can)");
}

/// A face beyond an edge, and whether both faces run along the edge in the same direction.
struct Neighbour {
    std::uint32_t face;
    bool same_way;
};

/// Up to three neighbours of each face.
class Neighbours {
  public:
    Neighbours(std::size_t face_count, std::span<const EdgeUse> edge_uses)
        : of_face_(face_count), counts_(face_count, 0) {
        for_each_edge(edge_uses, [&](std::span<const EdgeUse> uses) {
            if (uses.size() != 2) return;
            add(uses[0].face, {uses[1].face, !is_balanced(uses)});
            add(uses[1].face, {uses[0].face, !is_balanced(uses)});
        });
    }
    std::span<const Neighbour> operator[](std::uint32_t face) const {
        return {of_face_[face].data(), counts_[face]};
    }

  private:
    void add(std::uint32_t face, const Neighbour& neighbour) { of_face_[face][counts_[face]++] = neighbour; }
    std::vector<std::array<Neighbour, 3>> of_face_;
    std::vector<std::uint8_t> counts_;
};

/// @return for each face whether it has to be turned round
std::vector<bool> faces_to_turn(std::size_t face_count, const Neighbours& neighbours) {
    std::vector<bool> turn(face_count, false), is_reached(face_count, false);
    std::vector<std::uint32_t> pending;
    for (std::uint32_t first = 0; first < face_count; ++first) {
        if (is_reached[first]) continue;
        is_reached[first] = true;
        pending.push_back(first);
        while (!pending.empty()) {
            const std::uint32_t face = pending.back();
            pending.pop_back();
            for (const auto& [next, same_way] : neighbours[face]) {
                if (is_reached[next]) continue;
                is_reached[next] = true;
                turn[next] = turn[face] != same_way;
                pending.push_back(next);
            }
        }
    }
    return turn;
}

std::uint32_t corner_opposite(const EdgeUse& use, const std::vector<Triangle>& faces) {
    return faces[use.face][(use.corner + 2U) % 3];
}

Hinge hinge_at(std::span<const EdgeUse> uses, const std::vector<Triangle>& faces) {
    Hinge hinge{uses[0].low, uses[0].high, corner_opposite(uses[0], faces), corner_opposite(uses[1], faces)};
    if (!uses[0].ascending) std::swap(hinge.a, hinge.b);
    return hinge;
}

} // namespace

ClothSurface surface_of(const TriangleMesh& mesh) {
    const std::vector<EdgeUse> as_given = sorted_edge_uses(mesh);
    require_cloth(mesh, as_given);
    TriangleMesh turned{{}, mesh.faces};
    const std::vector<bool> turn = faces_to_turn(mesh.faces.size(), Neighbours(mesh.faces.size(), as_given));
    for (std::size_t face = 0; face < turn.size(); ++face)
        if (turn[face]) std::swap(turned.faces[face][1], turned.faces[face][2]);

    ClothSurface surface;
    for_each_edge(sorted_edge_uses(turned), [&](std::span<const EdgeUse> uses) {
        surface.edges.push_back({uses[0].low, uses[0].high});
        if (uses.size() == 2) surface.hinges.push_back(hinge_at(uses, turned.faces));
    });
    surface.faces = std::move(turned.faces);
    return surface;
}

} // namespace echinus
