#pragma once

#include "mesh_io/line_scanner.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace echinus {

enum class PlyType : std::uint8_t { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float32, Float64 };

enum class PlyFormat : std::uint8_t { Text, LittleEndian, BigEndian };

struct PlyProperty {
    std::string name;
    PlyType type{};
    std::optional<PlyType> count_type; ///< of a list
};

struct PlyElement {
    std::string name;
    std::size_t count = 0;
    std::vector<PlyProperty> properties;
};

struct PlyHeader {
    PlyFormat format{};
    std::vector<PlyElement> elements;

    /// How many elements of this name the file has.
    std::size_t count_of(const std::string& name) const;
    std::size_t element_count() const; ///< of all names
};

/// Reads up to and with the line end_header.
/// @throws Error WrongFormat or Damaged
PlyHeader read_ply_header(LineScanner& scanner);

} // namespace echinus
