#pragma once

#include <echinus/export.hpp>
#include <echinus/version.h> // the numbers

ECHINUS_EXPORT_BEGIN

namespace echinus {

/// The version of the library that the program runs with, such as "0.2.0"; with a shared library it may
/// differ from ECHINUS_VERSION_STRING in the last number. Before 1.0 a new minor version may change
/// declarations and has a soname of its own.
const char* version() noexcept;

} // namespace echinus

ECHINUS_EXPORT_END
