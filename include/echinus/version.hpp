#pragma once

#include <echinus/export.hpp>

/// The version of these headers. CMake reads it here, so it stands in no other place.
#define ECHINUS_VERSION_MAJOR 0
#define ECHINUS_VERSION_MINOR 2
#define ECHINUS_VERSION_PATCH 0
#define ECHINUS_VERSION_STRING "0.2.0"

ECHINUS_EXPORT_BEGIN

namespace echinus {

/// The version of the library that the program runs with, such as "0.2.0"; with a shared library it may
/// differ from ECHINUS_VERSION_STRING in the last number. Before 1.0 a new minor version may change
/// declarations and has a soname of its own.
const char* version() noexcept;

} // namespace echinus

ECHINUS_EXPORT_END
