#pragma once

#include "options.hpp"

#include <echinus/mesh.hpp>

/// What `build` and `mesh repair` may do to a mesh.
struct RepairArguments {
    bool repair = false;          ///< what needs no guess
    echinus::RepairOptions solid; ///< the rest

    echinus::RepairOptions options() const;
    bool given() const;
};

/// Adds --close-holes, --drop-inner-faces and --thicken.
void add_solid_options(Command command, RepairArguments& arguments);
