#pragma once

#include <echinus/distance_map.hpp>
#include <echinus/exact_map.hpp>
#include <echinus/geometry.hpp>

#include <map_generated.h>

#include <bit>
#include <span>
#include <string>
#include <type_traits>

namespace echinus {

// Conversions between the tables of a file and the arrays that queries read, for all kinds of maps.

static_assert(std::endian::native == std::endian::little, "map files are little-endian and used in place");

/// Does the map's frame differ from that of its mesh's file?
template <typename Map>
bool has_origin(const Map& map) {
    return map.view().origin != Vec3d{};
}

/// The enumerators of the schema equal those of the public headers, so values need no conversion.
template <typename Stored, typename Ours>
constexpr bool same_value(Stored stored, Ours ours) {
    return static_cast<int>(stored) == static_cast<int>(ours);
}

/// The schema's type for the elements of an array of T: T itself for numbers, a different type for structs.
template <typename T>
struct StoredAs {
    using Type = T;
};

template <typename T>
using StoredArray =
    flatbuffers::Vector<std::conditional_t<std::is_arithmetic_v<T>, T, const typename StoredAs<T>::Type*>>;

template <typename T>
flatbuffers::Offset<StoredArray<T>> write_array(flatbuffers::FlatBufferBuilder& builder,
                                                std::span<const T> array) {
    using Stored = typename StoredAs<T>::Type;
    static_assert(sizeof(Stored) == sizeof(T) && alignof(Stored) == alignof(T));
    const auto* first = reinterpret_cast<const Stored*>(array.data());
    if constexpr (std::is_arithmetic_v<T>)
        return builder.CreateVector(first, array.size());
    else
        return builder.CreateVectorOfStructs(first, array.size());
}

/// write_array() for an optional array: an empty one is omitted.
template <typename T>
flatbuffers::Offset<StoredArray<T>> write_if_any(flatbuffers::FlatBufferBuilder& builder,
                                                 std::span<const T> array) {
    if (array.empty()) return {};
    return write_array(builder, array);
}

/// Reads an array in place. An absent array becomes empty.
template <typename T>
void read_array(const StoredArray<T>* stored, std::span<const T>& array) {
    if (stored != nullptr) array = {reinterpret_cast<const T*>(stored->Data()), stored->size()};
}

inline schema::Origin to_stored(const Vec3d& origin) {
    return {origin.x, origin.y, origin.z};
}
/// The origin of a map; 0 if it has none.
inline Vec3d from_stored(const schema::Origin* origin) {
    return origin == nullptr ? Vec3d{} : Vec3d{origin->x(), origin->y(), origin->z()};
}

inline schema::Point to_stored(const Vec3f& point) {
    return {point.x, point.y, point.z};
}

inline Vec3f from_stored(const schema::Point& point) {
    return {point.x(), point.y(), point.z()};
}

// A distance map as a table of a map file.

flatbuffers::Offset<schema::DistanceMap> write_table(flatbuffers::FlatBufferBuilder& builder,
                                                     const DistanceMap& map);

/// Reads a map in place, after checking that its values are valid.
/// @pre the table's structure is sound; `storage` keeps its bytes alive
/// @throws Error Damaged; the message begins with `name` and names the field, or the array and the index
DistanceMap read_table(const schema::DistanceMap& stored, std::uint64_t source_hash,
                       std::shared_ptr<const void> storage, const std::string& name);

// An exact map as a table of a map file.

flatbuffers::Offset<schema::ExactMap> write_table(flatbuffers::FlatBufferBuilder& builder,
                                                  const ExactMap& map);

/// Reads a map in place, after checking that its values are valid.
/// @pre the table's structure is sound; `storage` keeps its bytes alive
/// @throws Error Damaged; the message begins with `name` and names the field, or the array and the index
ExactMap read_table(const schema::ExactMap& stored, std::uint64_t source_hash,
                    std::shared_ptr<const void> storage, const std::string& name);

} // namespace echinus
