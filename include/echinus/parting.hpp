#pragma once

#include <echinus/export.hpp>
#include <echinus/geometry.hpp>
#include <echinus/intersections.hpp>
#include <echinus/mesh.hpp>
#include <echinus/simulation.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

ECHINUS_EXPORT_BEGIN

/// Moves a surface such as a garment out of models, and its layers out of each other.
namespace echinus {

struct PartOptions {
    /// The material that resists the displacements; its weight has no effect.
    ClothMaterial material{};
    /// Distance in units, above 0, from which contact pushes the surface off the models; layers off each
    /// other, too, but less near small faces. Where the material presses, the distance is less. By default a
    /// tenth of the mean edge length.
    std::optional<double> thickness{};
    /// [vertex_count] 1 for vertices that stay where they are, otherwise 0; or empty.
    std::vector<std::uint8_t> pinned = {};
    unsigned thread_count = 1; ///< as in SimulationOptions; the result does not depend on it
    /// Called with the completed share of the work, 0 to 1, in the thread that called part(). An exception
    /// that it throws ends the work and reaches the caller.
    std::function<void(double share)> progress = nullptr;
};

/// The surface after part(), and what still intersects.
struct Parted {
    std::vector<Vec3f> vertices;          ///< [vertex_count]
    std::vector<FacePair> own_pairs = {}; ///< pairs of faces of the surface
    /// [model_count] pairs of a face of the surface and a face of the model
    std::vector<std::vector<FacePair>> model_pairs = {};
    /// The vertices that are inside a closed model, ascending. An open model has no inside.
    std::vector<std::uint32_t> inside = {};
    double stretched_share = 0; ///< the share of edges whose length changed by more than 5 %
    double largest_stretch = 0; ///< the largest length of an edge over its length before, minus 1

    /// Whether nothing intersects and no vertex is inside.
    bool is_apart() const;
};

/// Moves the vertices of a surface, as little as its material permits, until no face intersects a model or
/// another face of the surface, and no vertex is inside a closed model. The method is that of
/// NewtonOptions::untangle (docs/surfaces.md), after which the material contracts in a simulation without
/// gravity, in which no face can intersect anything. Models stay where they are, and may intersect
/// themselves and each other: the surface leaves their union.
///
/// If the surface cannot be parted, for instance because it is knotted or the models leave no room, the
/// result has the fewest intersections found. A surface that neither intersects anything nor is inside a
/// model is returned as it is.
///
/// The cost is that of untangling, up to a minute for 10 000 vertices on a detailed model, and of up to
/// thirty frames of a simulation. The function may be called in several threads at once.
/// A pinned vertex inside a model cannot be parted, and what it holds is stretched in vain.
/// @param models  open or closed meshes; those in other frames are moved to that of the surface, where their
/// coordinates are rounded to float
/// @throws Error InvalidMesh as make_cloth() does for the surface and ExactMap::build() does for a model,
/// whose message begins with its index; InvalidOptions for options out of range
Parted part(const TriangleMesh& surface, std::span<const TriangleMesh> models,
            const PartOptions& options = {});

} // namespace echinus

ECHINUS_EXPORT_END
