#pragma once

#include <echinus/exact_map.hpp>

#include <map_generated.h>

#include <string>

/// An exact map as a table of a map file.
namespace echinus {

flatbuffers::Offset<schema::ExactMap> write_table(flatbuffers::FlatBufferBuilder& builder,
                                                  const ExactMap& map);

/// Reads in place, once the meaning is checked.
/// @pre the table's structure is sound; `storage` keeps it
/// @throws Error Damaged; the sentence begins with `name` and names the field or the array and the index
ExactMap read_table(const schema::ExactMap& stored, std::uint64_t source_hash,
                    std::shared_ptr<const void> storage, const std::string& name);

/// Checks what makes every query harmless, and what else one pass can: that bands, faces and tree agree in
/// their numbers, that no integer that a query computes overflows, that the tree is one and no deeper than a
/// query's stack, that its boxes hold their faces. It does not check that the bands are those of the faces:
/// then answers are wrong. For arrays from untrusted bytes.
/// @throws Error as read_table()
void validate(const ExactMapView& map, const ExactMapStatistics& statistics, const std::string& name);

} // namespace echinus
