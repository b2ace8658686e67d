#pragma once

#include "simulation/surfaces/model_surface.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// The models that a deformable's surface may not meet: which are near in this frame, which move, and where
/// vertices may end beside all that are near.
struct NearModels {
    std::vector<ModelSurface> all;
    std::vector<std::uint8_t> is_near;         ///< by model: not away (BroadPhase)
    std::vector<std::uint8_t> moves;           ///< by model
    std::vector<const SurfaceMotion*> motions; ///< by model: how its surface deforms in this frame, or null

    std::size_t count() const { return all.size(); }
    void add(ModelSurface model);
    std::size_t near_count() const;
    bool any_moves() const;   ///< of those that are near
    bool any_deforms() const; ///< the same

    /// Calls visit(number, model) for the models that are near.
    template <typename Visit>
    void for_each_near(const Visit& visit) {
        for (std::size_t c = 0; c < count(); ++c)
            if (is_near[c] != 0) visit(c, all[c]);
    }

    /// @param is_carried  there by one of the models
    bool permit(std::uint32_t vertex, const Vec3f& place, bool is_carried) const;
    /// The same, after a closer look where little is known of what is around.
    bool permit_after_a_look(std::uint32_t vertex, const Vec3f& place, bool is_carried,
                             const Workers& workers);
};

} // namespace echinus
