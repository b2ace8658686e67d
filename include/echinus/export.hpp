#pragma once

/// The shared libraries export what is declared between these two marks: the public headers, and the few
/// internal ones that one of the libraries takes from another. All else is hidden. (GCC would take a mark of
/// the namespace; for Clang that does not reach the definitions of functions.)
#if defined(__GNUC__)
#define ECHINUS_EXPORT_BEGIN _Pragma("GCC visibility push(default)")
#define ECHINUS_EXPORT_END _Pragma("GCC visibility pop")
#else
#define ECHINUS_EXPORT_BEGIN
#define ECHINUS_EXPORT_END
#endif
