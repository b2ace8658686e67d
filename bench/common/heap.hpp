#pragma once

#include <cstddef>

/// Bytes that the process has taken from the heap of the C library and not given back. Its growth while a
/// structure is built is what the structure weighs, for libraries that keep no account of their own.
std::size_t heap_bytes();
