#pragma once

#include <echinus/intersections.hpp>
#include <echinus/simulation.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

/// Judges whether surfaces meet, on published positions and with no part of the simulation.
namespace echinus::test {

/// The faces of a deformable, and its structural constraints without faces as faces without area.
inline TriangleMesh surface_of(const Deformable& deformable) {
    TriangleMesh surface{deformable.positions, deformable.faces};
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const auto& [a, b, c] : deformable.faces)
        for (const auto& edge : {std::minmax(a, b), std::minmax(b, c), std::minmax(c, a)}) edges.insert(edge);
    for (const DistanceConstraint& constraint : deformable.constraints)
        if (constraint.kind == ConstraintKind::Structural &&
            !edges.contains(std::minmax(constraint.a, constraint.b)))
            surface.faces.push_back({constraint.a, constraint.b, constraint.b});
    return surface;
}

/// A collider's mesh where the collider is now.
inline TriangleMesh placed(TriangleMesh mesh, const Collider& collider) {
    const Vec3d& scale = collider.scale;
    for (Vec3f& v : mesh.vertices)
        v = Vec3f(collider.pose.to_world(Vec3d(v.x * scale.x, v.y * scale.y, v.z * scale.z)));
    return mesh;
}

/// The pairs of faces that intersect now: of the deformable with each model, then of its own.
inline std::vector<FacePair> meeting_faces(const Simulation& simulation,
                                           const std::vector<TriangleMesh>& models) {
    const TriangleMesh surface = surface_of(simulation.deformable());
    std::vector<FacePair> all;
    const auto add = [&](const std::vector<FacePair>& pairs) {
        all.insert(all.end(), pairs.begin(), pairs.end());
    };
    for (std::size_t i = 0; i < models.size(); ++i)
        add(intersecting_pairs(surface, placed(models[i], simulation.colliders()[i])));
    if (simulation.options().layers_collide()) add(self_intersecting_pairs(surface));
    return all;
}

/// Steps and judges every frame. Expects that surfaces touched, or the run would have shown nothing.
/// @param models  the mesh of each collider
inline void expect_nothing_meets(Simulation& simulation, const std::vector<TriangleMesh>& models,
                                 std::uint32_t frame_count) {
    for (std::uint32_t i = 0; i < frame_count; ++i) {
        simulation.step();
        const std::vector<FacePair> pairs = meeting_faces(simulation, models);
        ASSERT_EQ(pairs.size(), 0u) << "in frame " << simulation.frame() << ", first faces " << pairs[0].a
                                    << " and " << pairs[0].b << "; squeezed "
                                    << simulation.profile().unresolved_count << " times";
    }
    EXPECT_EQ(simulation.profile().unresolved_count, 0u);
    EXPECT_GT(simulation.profile().contact_count, 0u);
}

/// Colliders with exact maps of the meshes.
inline std::vector<Collider> colliders_of(const std::vector<TriangleMesh>& models) {
    std::vector<Collider> colliders;
    for (const TriangleMesh& model : models) colliders.push_back({.map = ExactMap::build(model)});
    return colliders;
}

} // namespace echinus::test
