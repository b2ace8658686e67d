#include <echinus/simulation.hpp>

#include <utility>

namespace echinus {

Deformable passing_through(std::uint32_t collider, Deformable deformable) {
    for (std::uint32_t particle = 0; particle < deformable.particle_count(); ++particle)
        deformable.filters.push_back({particle, collider});
    return deformable;
}

std::vector<std::uint8_t> let_through(const Deformable& deformable, std::size_t collider) {
    std::vector<std::uint8_t> passes;
    for (const CollisionFilter& filter : deformable.filters) {
        if (filter.collider != collider || filter.particle >= deformable.particle_count()) continue;
        passes.resize(deformable.particle_count());
        passes[filter.particle] = 1;
    }
    return passes;
}

} // namespace echinus
