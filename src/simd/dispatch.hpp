#pragma once

#include <hwy/highway.h>

#include <cstddef>

/// Chooses among the variants of a kernel that foreach_target.h compiled. Highway's own choice is one for the
/// whole process; Echinus keeps its own, so that forcing it leaves other users of Highway alone.
namespace echinus {

/// The instruction set in use, in Highway's form.
hwy::ChosenTarget& chosen_target() noexcept;

/// False when queries are to run as the scalar reference.
bool use_kernels() noexcept;

} // namespace echinus

/// The variant of FUNCTION, named in HWY_EXPORT(FUNCTION), for the instruction set in use.
#if HWY_IDE || ((HWY_TARGETS & (HWY_TARGETS - 1)) == 0)
#define ECHINUS_DISPATCH(FUNCTION) (*HWY_DISPATCH_TABLE(FUNCTION)[0])
#else
#define ECHINUS_DISPATCH(FUNCTION) (*HWY_DISPATCH_TABLE(FUNCTION)[::echinus::chosen_target().GetIndex()])
#endif
