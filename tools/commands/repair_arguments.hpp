#pragma once

#include "console/options.hpp"

#include <echinus/mesh.hpp>

#include <cstdint>

/// The repairs that `build` and `mesh repair` can make.
struct RepairArguments {
    bool repair = false; ///< the repairs that require no guesswork
    /// The other repairs, as in RepairOptions.
    double weld_distance = 0;
    std::uint32_t max_hole_edges = 0;
    bool drop_inner_faces = false;
    double sheet_thickness = 0;

    echinus::RepairOptions options() const;
    bool given() const;
};

/// Adds --weld, --close-holes, --drop-inner-faces and --thicken.
void add_solid_options(Command command, RepairArguments& arguments);
