#include "simulation/surface_layers.hpp"

#include "geometry/union_find.hpp"
#include "simulation/start/validation.hpp"
#include "simulation/surfaces/model_mesh.hpp"

#include <echinus/error.hpp>
#include <echinus/exact_map.hpp>

#include <cstddef>
#include <limits>
#include <numeric>
#include <span>
#include <string>
#include <utility>

namespace echinus {

namespace {

void require_entries(std::span<const std::uint8_t> option, const std::string& name,
                     const TriangleMesh& surface) {
    require_option(option.empty() || option.size() == surface.vertices.size(),
                   name + " has " + std::to_string(option.size()) +
                       " entries; it needs one for each of the " + std::to_string(surface.vertices.size()) +
                       " vertices, or none");
}

std::vector<SurfaceLayer> whole(const TriangleMesh& surface, const PartOptions& options) {
    std::vector<std::uint32_t> all(surface.vertices.size());
    std::iota(all.begin(), all.end(), 0U);
    return {{surface, all, options.pinned}};
}

std::vector<SurfaceLayer> divided(const TriangleMesh& surface, const PartOptions& options) {
    std::vector<SurfaceLayer> layers(std::size_t{std::numeric_limits<std::uint8_t>::max()} + 1); // [number]
    std::vector<std::uint32_t> in_layer;
    for (std::uint32_t v = 0; v < surface.vertices.size(); ++v) {
        SurfaceLayer& layer = layers[options.layers[v]];
        in_layer.push_back(static_cast<std::uint32_t>(layer.vertices.size()));
        layer.vertices.push_back(v);
        layer.mesh.vertices.push_back(surface.vertices[v]);
        if (!options.pinned.empty()) layer.pinned.push_back(options.pinned[v]);
    }
    for (const auto& [a, b, c] : surface.faces)
        layers[options.layers[a]].mesh.faces.push_back({in_layer[a], in_layer[b], in_layer[c]});
    std::erase_if(layers, [](const SurfaceLayer& layer) { return layer.mesh.faces.empty(); });
    return layers;
}

} // namespace

void require_layers(const TriangleMesh& surface, const PartOptions& options) {
    require_entries(options.pinned, "pinned", surface);
    const std::span<const std::uint8_t> layers = options.layers;
    require_entries(layers, "layers", surface);
    if (layers.empty()) return;
    for (std::size_t f = 0; f < surface.faces.size(); ++f) {
        const auto& [a, b, c] = surface.faces[f];
        require_option(layers[a] == layers[b] && layers[a] == layers[c],
                       "the vertices of face " + std::to_string(f) +
                           " are in different layers; a face must be in one");
    }
    if (const Fault& fault = inspect(surface).misoriented_edges; fault.count > 0)
        throw Error(ErrorCode::InvalidMesh,
                    std::to_string(fault.count) +
                        " edges have faces that face opposite sides (first at face " +
                        std::to_string(fault.first_faces[0]) +
                        "), so that a layer has no outer side; turn faces such that neighbours agree");
}

bool has_inside(const Collider& collider) {
    return map_of_surface(collider)->view().border.empty(); // an open surface has none
}

std::vector<SurfaceLayer> layers_of(const TriangleMesh& surface, const PartOptions& options) {
    return options.layers.empty() ? whole(surface, options) : divided(surface, options);
}

void turn_outward(TriangleMesh& layer, const std::vector<Collider>& colliders) {
    UnionFind pieces(layer.vertices.size());
    for (const auto& [a, b, c] : layer.faces) {
        pieces.join(a, b);
        pieces.join(a, c);
    }
    std::vector<double> agreement(layer.vertices.size()); // [root]
    for (const Collider& collider : colliders) {
        if (!has_inside(collider)) continue;
        for (const auto& [a, b, c] : layer.faces) {
            const Vec3f &p = layer.vertices[a], &q = layer.vertices[b], &r = layer.vertices[c];
            const Vec3f outward =
                contact(collider, (p + q + r) * (1.0F / 3), std::numeric_limits<float>::infinity()).normal;
            agreement[pieces.find(a)] += double{dot(cross(q - p, r - p), outward)};
        }
    }
    for (Triangle& face : layer.faces)
        if (agreement[pieces.find(face[0])] < 0) std::swap(face[1], face[2]);
}

} // namespace echinus
