#pragma once

#include <echinus/mesh.hpp>
#include <echinus/simulation.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// A face, an edge without faces or a vertex without edges. Two surfaces that do not intersect can only begin
/// to do so at a vertex and a face, or at two edges. Every vertex and every edge is owned by one of its
/// elements, so that each such pair is searched once.
struct Element {
    std::array<std::uint32_t, 3> vertices{}; ///< the last one is repeated if there are fewer than three
    std::array<std::uint32_t, 3> edges{};    ///< from vertex k to vertex (k + 1) % 3; one for an edge
    std::uint8_t vertex_count = 3;
    std::uint8_t owned_vertices = 0; ///< one bit for each vertex
    std::uint8_t owned_edges = 0;    ///< one bit for each edge

    bool is_face() const { return vertex_count == 3; }
    bool owns_vertex(std::size_t k) const { return ((owned_vertices >> k) & 1U) != 0; }
    bool owns_edge(std::size_t k) const { return ((owned_edges >> k) & 1U) != 0; }
    bool has(std::uint32_t vertex) const {
        return vertices[0] == vertex || vertices[1] == vertex || vertices[2] == vertex;
    }
};

using Edge = std::array<std::uint32_t, 2>;

/// The elements of a surface.
struct Elements {
    std::vector<Element> all; ///< the faces in their order, then the edges, then the vertices
    std::vector<Edge> edges;
    std::vector<std::uint32_t> around_offsets; ///< [vertex_count + 1]
    std::vector<std::uint32_t> around;         ///< the elements at each vertex

    Elements() = default;
    /// @param loose_edges  edges that are also edges of faces are not counted twice
    /// @param inner  [vertex_count] or empty: vertices that need no element
    Elements(std::size_t vertex_count, std::span<const Triangle> faces, std::span<const Edge> loose_edges,
             const std::vector<bool>& inner = {});

    std::size_t vertex_count() const { return around_offsets.size() - 1; }
    std::span<const std::uint32_t> at(std::size_t vertex) const {
        return std::span(around).subspan(around_offsets[vertex],
                                         around_offsets[vertex + 1] - around_offsets[vertex]);
    }
};

/// The deformable's faces and threads, which are structural constraints that are not edges of faces.
/// Particles inside a soft body and particles that pass have no elements.
/// @param passes  [particle_count] 1 for particles that a collider lets through, or empty
Elements elements_of(const Deformable& deformable, std::span<const std::uint8_t> passes = {});

/// The elements as a mesh: the faces, followed by the edges and vertices as faces without area.
TriangleMesh surface_of(const Elements& elements, std::span<const Vec3f> positions);

} // namespace echinus
