#include "mesh/components.hpp"
#include "mesh/edges.hpp"
#include "mesh/faces.hpp"
#include "mesh/winding_number.hpp"
#include "repair/repairs.hpp"

#include <algorithm>
#include <utility>

namespace echinus {

namespace {

struct Component {
    std::vector<std::uint32_t> face_numbers;
    std::vector<Triangle> faces;
    Vec3f low;  // corners of its bounding box
    Vec3f high; //
    bool closed = true;
    bool inside_out = false;
    bool flip = false;
};

void find_bounding_box(const TriangleMesh& mesh, Component& component) {
    component.low = component.high = mesh.vertices[component.faces[0][0]];
    for (const Triangle& face : component.faces)
        for (std::uint32_t vertex : face) {
            const Vec3f& p = mesh.vertices[vertex];
            component.low = {std::min(component.low.x, p.x), std::min(component.low.y, p.y),
                             std::min(component.low.z, p.z)};
            component.high = {std::max(component.high.x, p.x), std::max(component.high.y, p.y),
                              std::max(component.high.z, p.z)};
        }
}

bool has_negative_volume(const TriangleMesh& mesh, const Component& component) {
    double sum = 0;
    for (const Triangle& face : component.faces) sum += six_volumes(mesh, face, Vec3d(component.low));
    return sum < 0;
}

std::vector<Component> examine_components(const TriangleMesh& mesh) {
    const Components numbers = find_components(mesh);
    std::vector<Component> components(numbers.count);
    for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
        Component& component = components[numbers.of_face[face]];
        component.face_numbers.push_back(static_cast<std::uint32_t>(face));
        component.faces.push_back(mesh.faces[face]);
    }
    for_each_edge(sorted_edge_uses(mesh), [&](std::span<const EdgeUse> uses) {
        if (!is_balanced(uses)) components[numbers.of_face[uses[0].face]].closed = false;
    });
    for (Component& component : components) {
        find_bounding_box(mesh, component);
        component.inside_out = component.closed && has_negative_volume(mesh, component);
    }
    return components;
}

bool box_contains(const Component& outer, const Component& inner) {
    return outer.low.x <= inner.low.x && outer.low.y <= inner.low.y && outer.low.z <= inner.low.z &&
           outer.high.x >= inner.high.x && outer.high.y >= inner.high.y && outer.high.z >= inner.high.z;
}

/// Does the inner component lie in the outer one? One vertex decides for the whole component: components
/// whose surfaces cross have no meaningful nesting.
bool contains(const TriangleMesh& mesh, const Component& outer, const Component& inner) {
    return &outer != &inner && outer.closed && box_contains(outer, inner) &&
           std::abs(winding_number(mesh.vertices, outer.faces, Vec3d(mesh.vertices[inner.faces[0][0]]))) >
               0.5;
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
