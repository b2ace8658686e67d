#include "geometry/box.hpp"
#include "geometry/union_find.hpp"
#include "geometry/whole_numbers.hpp"
#include "mesh/faces.hpp"
#include "repair/repairs.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <span>
#include <utility>
#include <vector>

namespace echinus {

namespace {

/// The sum over all edges of how many more faces run in one direction along the edge than in the other.
std::size_t total_imbalance(const std::vector<EdgeUse>& edge_uses) {
    std::size_t total = 0;
    for_each_edge(edge_uses, [&](std::span<const EdgeUse> uses) {
        std::ptrdiff_t sum = 0;
        for (const EdgeUse& use : uses) sum += use.ascending ? 1 : -1;
        total += static_cast<std::size_t>(std::abs(sum));
    });
    return total;
}

} // namespace

std::size_t orient_faces(TriangleMesh& mesh) {
    std::vector<EdgeUse> edge_uses = sorted_edge_uses(mesh);
    const Orientation orientation = find_orientation(edge_uses, mesh.faces.size());
    // For each patch, how many more faces run like its first one than in the opposite direction.
    std::vector<std::ptrdiff_t> majority(orientation.is_closed.size());
    for (std::size_t face = 0; face < mesh.faces.size(); ++face)
        majority[orientation.patch_of_face[face]] += orientation.is_turned[face] ? -1 : 1;
    const auto is_to_turn = [&](std::uint32_t face) {
        const std::uint32_t patch = orientation.patch_of_face[face];
        return orientation.is_closed[patch] && orientation.is_turned[face] == (majority[patch] >= 0);
    };
    // Faces of two patches may happen to balance each other. Only a smaller sum of imbalances counts as
    // progress, so that repair() terminates.
    const std::size_t before = total_imbalance(edge_uses);
    for (EdgeUse& use : edge_uses) use.ascending = use.ascending != is_to_turn(use.face);
    if (total_imbalance(edge_uses) >= before) return 0;
    std::size_t turned_count = 0;
    for (std::uint32_t face = 0; face < mesh.faces.size(); ++face) {
        if (!is_to_turn(face)) continue;
        std::swap(mesh.faces[face][1], mesh.faces[face][2]);
        ++turned_count;
    }
    return turned_count;
}

namespace {

struct Component {
    std::vector<std::uint32_t> face_numbers;
    std::vector<Triangle> faces;
    AlignedBox<float> box;
    bool closed = false;
    bool inside_out = false;
    bool flip = false;
};

/// Is the volume negative by more than the rounding error of a component that encloses nothing?
bool has_negative_volume(const TriangleMesh& mesh, const Component& component) {
    constexpr double kRounding = 1e-12;
    double sum = 0, magnitude = 0;
    for (const Triangle& face : component.faces) {
        const double part = six_volumes(mesh, face, Vec3d(component.box.low));
        sum += part;
        magnitude += std::fabs(part);
    }
    return sum < -kRounding * magnitude;
}

/// Sets of faces that are connected by edges, numbered in the order of their first faces. Solids that touch
/// only at vertices are separate, and so are solids that touch at edges if each patch is closed without the
/// other.
Components find_solids(std::span<const EdgeUse> edge_uses, std::size_t face_count) {
    const Orientation orientation = find_orientation(edge_uses, face_count);
    UnionFind sets(face_count);
    for_each_edge(edge_uses, [&](std::span<const EdgeUse> uses) {
        const EdgeUse* first = nullptr; // of a patch that is not closed by itself
        for (const EdgeUse& use : uses) {
            if (uses.size() != 2 && orientation.is_closed[orientation.patch_of_face[use.face]]) continue;
            if (first != nullptr) sets.join(first->face, use.face);
            first = &use;
        }
    });
    Components components;
    components.of_face.resize(face_count);
    for (std::uint32_t face = 0; face < face_count; ++face) {
        const std::uint32_t first = sets.find(face);
        components.of_face[face] =
            first == face ? kept_as<std::uint32_t>(components.count++) : components.of_face[first];
    }
    return components;
}

std::vector<Component> examine_components(const TriangleMesh& mesh) {
    const std::vector<EdgeUse> edge_uses = sorted_edge_uses(mesh);
    const Components numbers = find_solids(edge_uses, mesh.faces.size());
    const std::vector<bool> is_closed = find_closed_sets(edge_uses, numbers.of_face, numbers.count);
    std::vector<Component> components(numbers.count);
    for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
        Component& component = components[numbers.of_face[face]];
        component.face_numbers.push_back(kept_as<std::uint32_t>(face));
        component.faces.push_back(mesh.faces[face]);
        for (const std::uint32_t vertex : mesh.faces[face]) component.box.add(mesh.vertices[vertex]);
    }
    for (std::size_t number = 0; number < components.size(); ++number) {
        Component& component = components[number];
        component.closed = is_closed[number];
        component.inside_out = component.closed && has_negative_volume(mesh, component);
    }
    return components;
}

Vec3d centroid_of(const TriangleMesh& mesh, const Triangle& face) {
    return (Vec3d(mesh.vertices[face[0]]) + Vec3d(mesh.vertices[face[1]]) + Vec3d(mesh.vertices[face[2]])) *
           (1.0 / 3);
}

/// Does the inner component lie in the outer one? The centroid of one face decides for the whole component:
/// components whose surfaces cross have no meaningful nesting. It is the first of a few centroids that is not
/// on the outer component. Vertices would not do: all vertices of a cavity may be on the surface around it.
bool contains(const TriangleMesh& mesh, const Component& outer, const Component& inner) {
    if (&outer == &inner || !outer.closed || !outer.box.contains(inner.box)) return false;
    constexpr std::size_t kMostFaces = 16;
    constexpr double kOnSurface = 1e-3; // distance of the winding number from the nearest integer
    const std::size_t count = std::min(kMostFaces, inner.faces.size());
    for (std::size_t i = 0; i < count; ++i) {
        const Triangle& face = inner.faces[i * inner.faces.size() / count];
        const double winding = winding_number(mesh.vertices, outer.faces, centroid_of(mesh, face));
        if (std::fabs(winding - std::round(winding)) <= kOnSurface) return std::round(winding) != 0;
    }
    return false;
}

} // namespace

std::size_t flip_inside_out_components(TriangleMesh& mesh) {
    std::vector<Component> components = examine_components(mesh);
    for (Component& outer : components) {
        const bool is_cavity = outer.inside_out &&
                               std::any_of(components.begin(), components.end(), [&](const Component& other) {
                                   return contains(mesh, other, outer);
                               });
        if (!outer.inside_out || is_cavity) continue;
        outer.flip = true;
        for (Component& inner : components)
            if (inner.closed && contains(mesh, outer, inner)) inner.flip = true;
    }
    for (const Component& component : components)
        if (component.flip)
            for (std::uint32_t face : component.face_numbers)
                std::swap(mesh.faces[face][1], mesh.faces[face][2]);
    return static_cast<std::size_t>(std::count_if(components.begin(), components.end(),
                                                  [](const Component& component) { return component.flip; }));
}

} // namespace echinus
