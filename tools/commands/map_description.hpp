#pragma once

#include "json.hpp"

#include <echinus/any_map.hpp>
#include <echinus/map_file.hpp>

#include <cstdint>
#include <string>

/// The description of a map by `build` and `info`.
struct MapDescription {
    const echinus::AnyMap& map;
    echinus::MapFileNotes notes;
    std::uint64_t file_bytes = 0;
};

/// The object of --json.
Json to_json(const MapDescription& description);

/// A table for people, for a distance map with the histogram of the entries per direction.
std::string to_text(const MapDescription& description, const std::string& title);
