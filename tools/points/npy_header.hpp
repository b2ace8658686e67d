#pragma once

#include "input.hpp"

#include <cstdint>
#include <string>
#include <vector>

/// What the header of a .npy file says of the array behind it (NumPy enhancement proposal 1; the format's
/// versions 1 to 3).
struct NpyHeader {
    std::string descr; ///< the type of the elements, such as "<f4"; a list of fields begins with "["
    bool fortran_order = false;
    std::vector<std::uint64_t> shape;
};

/// The first byte of every .npy file, and of no text.
inline constexpr char kNpyFirstByte = '\x93';

/// Reads the header and leaves the input at the first element.
/// @throws echinus::Error WrongFormat or Damaged
NpyHeader read_npy_header(Input& input);

/// The header of a version 1 file, for an array [element_count] of elements whose type is written as the
/// Python literal `descr`.
std::string format_npy_header(const std::string& descr, std::uint64_t element_count);
