#pragma once

#include <echinus/exact_map.hpp>

#include <map_generated.h>

#include <string>

/// An exact map as a table of a map file.
namespace echinus {

flatbuffers::Offset<schema::ExactMap> write_table(flatbuffers::FlatBufferBuilder& builder,
                                                  const ExactMap& map);

/// Reads in place, after checking the meaning.
/// @pre the table's structure is sound; `storage` keeps its bytes alive
/// @throws Error Damaged; the sentence begins with `name` and names the field or the array and the index
ExactMap read_table(const schema::ExactMap& stored, std::uint64_t source_hash,
                    std::shared_ptr<const void> storage, const std::string& name);

} // namespace echinus
