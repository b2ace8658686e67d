#include "simulation/collision.hpp"

#include "simulation/contact_collision.hpp"
#include "simulation/exact_collision.hpp"

#include <variant>

namespace echinus {

std::unique_ptr<Collision> make_collision(const Collider& collider, const Particles& particles,
                                          std::span<const std::uint8_t> passes,
                                          const SimulationOptions& options) {
    if (std::holds_alternative<ExactMap>(collider.map.kind))
        return std::make_unique<ExactCollision>(collider, particles, passes, options);
    return std::make_unique<ContactCollision>(collider, particles, passes, options);
}

} // namespace echinus
