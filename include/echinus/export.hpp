#pragma once

/// Shared libraries export the declarations between these two macros: those of the public headers, and of the
/// few internal headers that one library includes from another. Everything else is hidden. (An attribute on
/// the namespace would suffice for GCC, but in Clang it does not apply to the definitions of functions.)
#if defined(__GNUC__)
#define ECHINUS_EXPORT_BEGIN _Pragma("GCC visibility push(default)")
#define ECHINUS_EXPORT_END _Pragma("GCC visibility pop")
#else
#define ECHINUS_EXPORT_BEGIN
#define ECHINUS_EXPORT_END
#endif
