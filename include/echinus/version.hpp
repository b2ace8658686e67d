#pragma once

#include <echinus/export.hpp>
#include <echinus/version.h> // the numbers

ECHINUS_EXPORT_BEGIN

namespace echinus {

/// The version of the library that the program runs with, such as "0.2.0". With a shared library, its last
/// number may differ from that of ECHINUS_VERSION_STRING. Before 1.0, a new minor version may change
/// declarations and has its own soname.
const char* version() noexcept;

} // namespace echinus

ECHINUS_EXPORT_END
