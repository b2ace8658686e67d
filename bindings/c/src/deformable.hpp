#pragma once

#include <echinus/echinus.h>
#include <echinus/simulation.hpp>

struct echinus_deformable {
    echinus::Deformable value;
};

namespace echinus::c {

/// The arrays of a deformable, in place.
echinus_deformable_arrays arrays_of(const Deformable& deformable);

} // namespace echinus::c
