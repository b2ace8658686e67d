#pragma once

#include "map.hpp"

#include <echinus/echinus.h>
#include <echinus/simulation.hpp>

#include <vector>

struct echinus_simulation {
    explicit echinus_simulation(echinus::Simulation simulation) : value(std::move(simulation)) {
        for (const echinus::Collider& collider : value.colliders()) maps.push_back({collider.map});
    }

    echinus::Simulation value;
    /// [collider_count] For those who read a collider, as it was then.
    mutable std::vector<echinus_map> maps;
    bool failed = false; ///< a step has; then it can only be read
};
