#pragma once

#include <echinus/distance_map.hpp>

#include <map_generated.h>

#include <string>

/// A distance map as a table of a map file.
namespace echinus {

flatbuffers::Offset<schema::DistanceMap> write_table(flatbuffers::FlatBufferBuilder& builder,
                                                     const DistanceMap& map);

/// Reads in place, after checking the meaning.
/// @pre the table's structure is sound; `storage` keeps its bytes alive
/// @throws Error Damaged; the sentence begins with `name` and names the field or the array and the index
DistanceMap read_table(const schema::DistanceMap& stored, std::uint64_t source_hash,
                       std::shared_ptr<const void> storage, const std::string& name);

} // namespace echinus
