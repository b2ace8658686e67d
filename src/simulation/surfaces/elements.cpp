#include "simulation/surfaces/elements.hpp"

#include <algorithm>

namespace echinus {

namespace {

Edge sorted(std::uint32_t a, std::uint32_t b) {
    return a < b ? Edge{a, b} : Edge{b, a};
}

/// An edge of an element: edge `side` of element `element`.
struct EdgeUse {
    Edge edge;
    std::uint32_t element;
    std::uint8_t side;

    friend bool operator<(const EdgeUse& a, const EdgeUse& b) {
        return a.edge != b.edge ? a.edge < b.edge : a.element < b.element;
    }
};

/// Numbers the edges, and assigns each to the first of its elements.
void number_edges(std::vector<EdgeUse>& uses, Elements& elements) {
    std::sort(uses.begin(), uses.end());
    for (std::size_t i = 0; i < uses.size(); ++i) {
        const EdgeUse& use = uses[i];
        const bool is_first = i == 0 || uses[i - 1].edge != use.edge;
        if (is_first) elements.edges.push_back(use.edge);
        Element& element = elements.all[use.element];
        element.edges[use.side] = static_cast<std::uint32_t>(elements.edges.size() - 1);
        if (is_first) element.owned_edges |= static_cast<std::uint8_t>(1U << use.side);
    }
}

/// Assigns each vertex to the first of its elements.
void own_vertices(std::size_t vertex_count, std::vector<Element>& all) {
    std::vector<bool> owned(vertex_count, false);
    for (Element& element : all)
        for (std::size_t k = 0; k < element.vertex_count; ++k) {
            if (owned[element.vertices[k]]) continue;
            owned[element.vertices[k]] = true;
            element.owned_vertices |= static_cast<std::uint8_t>(1U << k);
        }
}

void list_around(std::size_t vertex_count, Elements& elements) {
    std::vector<std::uint32_t>& offsets = elements.around_offsets;
    offsets.assign(vertex_count + 1, 0);
    for (const Element& element : elements.all)
        for (std::size_t k = 0; k < element.vertex_count; ++k) ++offsets[element.vertices[k] + 1];
    for (std::size_t v = 0; v < vertex_count; ++v) offsets[v + 1] += offsets[v];
    elements.around.resize(offsets.back());
    std::vector<std::uint32_t> next(offsets.begin(), offsets.end() - 1);
    for (std::uint32_t e = 0; e < elements.all.size(); ++e)
        for (std::size_t k = 0; k < elements.all[e].vertex_count; ++k)
            elements.around[next[elements.all[e].vertices[k]]++] = e;
}

} // namespace

Elements::Elements(std::size_t vertex_count, std::span<const Triangle> faces,
                   std::span<const Edge> loose_edges, const std::vector<bool>& inner) {
    std::vector<EdgeUse> uses;
    std::vector<bool> used = inner;
    used.resize(vertex_count, false);
    for (const Triangle& face : faces) {
        const auto number = static_cast<std::uint32_t>(all.size());
        all.push_back({.vertices = {face[0], face[1], face[2]}});
        for (std::uint8_t k = 0; k < 3; ++k) {
            uses.push_back({sorted(face[k], face[(k + 1U) % 3]), number, k});
            used[face[k]] = true;
        }
    }
    std::vector<Edge> face_edges;
    for (const EdgeUse& use : uses) face_edges.push_back(use.edge);
    std::sort(face_edges.begin(), face_edges.end());
    for (const auto& [a, b] : loose_edges) {
        if (std::binary_search(face_edges.begin(), face_edges.end(), sorted(a, b))) continue;
        uses.push_back({sorted(a, b), static_cast<std::uint32_t>(all.size()), 0});
        all.push_back({.vertices = {a, b, b}, .vertex_count = 2});
        used[a] = used[b] = true;
    }
    for (std::uint32_t v = 0; v < vertex_count; ++v)
        if (!used[v]) all.push_back({.vertices = {v, v, v}, .vertex_count = 1});
    number_edges(uses, *this);
    own_vertices(vertex_count, all);
    list_around(vertex_count, *this);
}

Elements elements_of(const Deformable& deformable, std::span<const std::uint8_t> passes) {
    std::vector<Triangle> faces;
    for (const Triangle& face : deformable.faces)
        if (!passes_through(face, passes)) faces.push_back(face);
    std::vector<Edge> threads;
    for (const auto& [a, b, rest_length, kind] : deformable.constraints)
        if (kind == ConstraintKind::Structural && !passes_through({a, b, b}, passes))
            threads.push_back({a, b});
    std::vector<bool> inner(passes.begin(), passes.end());
    inner.resize(deformable.particle_count(), false);
    for (const ElasticTetrahedron& tetrahedron : deformable.tetrahedra)
        for (const std::uint32_t i : tetrahedron.particles) inner[i] = true;
    return {deformable.particle_count(), faces, threads, inner};
}

TriangleMesh surface_of(const Elements& elements, std::span<const Vec3f> positions) {
    TriangleMesh surface{{positions.begin(), positions.end()}, {}};
    for (const Element& element : elements.all) surface.faces.push_back(element.vertices);
    return surface;
}

} // namespace echinus
