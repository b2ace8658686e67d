#ifndef ECHINUS_VERSION_H
#define ECHINUS_VERSION_H

/// The version of these headers, for C and C++. CMake reads it from here, so it is defined nowhere else.
#define ECHINUS_VERSION_MAJOR 0
#define ECHINUS_VERSION_MINOR 2
#define ECHINUS_VERSION_PATCH 0
#define ECHINUS_VERSION_STRING "0.2.0"

#endif
