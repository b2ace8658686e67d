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

/// Checks everything that keeps queries harmless, and what else one pass can check: bands, faces and tree
/// agree in their numbers, no integer of a query overflows, the tree is a tree and no deeper than a query's
/// stack, its boxes contain their faces. It does not check that the bands match the faces; where they do not,
/// answers are wrong. For arrays from untrusted bytes.
/// @throws Error as read_table()
void validate(const ExactMapView& map, const ExactMapStatistics& statistics, const std::string& name);

} // namespace echinus
