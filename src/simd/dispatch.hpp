#pragma once

#include <hwy/highway.h>

#include <cstddef>

/// Chooses among the variants of a kernel that foreach_target.h compiled. Highway's own choice applies to the
/// whole process; Echinus keeps a separate one, so that forcing it does not affect other users of Highway.
namespace echinus {

/// The instruction set in use, as Highway represents it.
hwy::ChosenTarget& chosen_target() noexcept;

/// Returns false if queries must use the scalar reference.
bool use_kernels() noexcept;

} // namespace echinus

/// The variant of FUNCTION, which HWY_EXPORT(FUNCTION) names, for the instruction set in use.
#if HWY_IDE || ((HWY_TARGETS & (HWY_TARGETS - 1)) == 0)
#define ECHINUS_DISPATCH(FUNCTION) (*HWY_DISPATCH_TABLE(FUNCTION)[0])
#else
#define ECHINUS_DISPATCH(FUNCTION) (*HWY_DISPATCH_TABLE(FUNCTION)[::echinus::chosen_target().GetIndex()])
#endif
