#pragma once

#include "files/text.hpp"

#include <echinus/echinus.h>
#include <echinus/geometry.hpp>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

/// The work of every function of the C interface at the boundary between C and C++: catching exceptions,
/// checking what the types of C cannot exclude, and converting values.
namespace echinus::c {

/// A wrong argument of a C function; the sentence begins with the argument's name.
class WrongArgument : public std::invalid_argument {
  public:
    using std::invalid_argument::invalid_argument;
};

inline void require(bool holds, const char* sentence) {
    if (!holds) throw WrongArgument(sentence);
}

// ---- Errors

/// Turns the current exception into a status, and records its sentence for echinus_last_error(). To be called
/// from a handler.
echinus_status note_error(const char* function) noexcept;

/// The status of `body`.
template <typename Body>
echinus_status guarded(const char* function, const Body& body) noexcept {
    try {
        body();
        return ECHINUS_OK;
    } catch (...) {
        return note_error(function);
    }
}

// ---- Pointers and handles

/// @throws WrongArgument for null
inline void require_address(const void* pointer, const char* name) {
    if (pointer == nullptr) throw WrongArgument(std::string(name) + " is NULL");
}
template <typename T>
T& at(T* pointer, const char* name) {
    require_address(pointer, name);
    return *pointer;
}

/// Stores a new handle of the value that `body` returns in *result, or null if it throws.
template <typename Handle, typename Body>
echinus_status make(const char* function, Handle** result, const Body& body) noexcept {
    if (result != nullptr) *result = nullptr;
    return guarded(function, [&] {
        at(result, "the place for the result");
        *result = new Handle{body()};
    });
}

/// @throws WrongArgument for an index that is too large
void require_index(std::size_t index, std::size_t count, const char* name);

/// The number of elements that `count` items of `width` elements each make.
/// @throws WrongArgument if the product overflows
std::size_t times(std::size_t count, std::size_t width, const char* name);

/// @throws WrongArgument for null if there are elements, and for a size that exceeds all memory
template <typename T>
std::span<T> values_at(T* first, std::size_t count, const char* name) {
    if (count == 0) return {};
    require_address(first, name);
    times(count, sizeof(T), name);
    return {first, count};
}

/// A batch of values that consist of floats, in the caller's memory.
/// @param stride  in bytes; 0 for contiguous values
/// @throws WrongArgument for null, a stride that is too small or not a multiple of 4, an address that is not
/// a multiple of 4, and a batch that exceeds all memory
template <typename T>
StridedSpan<const T> batch_at(const float* first, std::size_t count, std::size_t stride, const char* name) {
    if (count == 0) return {};
    if (stride == 0) stride = sizeof(T);
    const std::string batch(name);
    require_address(first, name);
    if (stride < sizeof(T) || stride % sizeof(float) != 0)
        throw WrongArgument("the stride of " + batch + " is " + std::to_string(stride) +
                            "; expected a multiple of 4, at least " + std::to_string(sizeof(T)) + ", or 0");
    if (reinterpret_cast<std::uintptr_t>(first) % alignof(float) != 0)
        throw WrongArgument("the address of " + batch + " is not a multiple of 4");
    times(count, stride, name);
    return {reinterpret_cast<const T*>(first), count, stride};
}

/// A vector of three finite numbers.
/// @throws WrongArgument
Vec3d finite_vector_at(const double* first, const char* name);

/// Three numbers of an option, which the library checks.
inline Vec3d vector_of(const double (&numbers)[3]) {
    return {numbers[0], numbers[1], numbers[2]};
}
template <typename T>
void put_vector(const Vec3<T>& vector, T* numbers) {
    numbers[0] = vector.x;
    numbers[1] = vector.y;
    numbers[2] = vector.z;
}

/// An enumerator of C++ from one of C with the same numbers. It is read as an integer, since the caller may
/// have stored any number.
/// @throws WrongArgument for one beyond `last`
template <typename Enum, typename CEnum>
Enum enumerator(const CEnum& value, Enum last, const char* name) {
    static_assert(sizeof value == sizeof(std::int32_t));
    std::int32_t number = 0;
    std::memcpy(&number, &value, sizeof number);
    if (number < 0 || number > static_cast<int>(last))
        throw WrongArgument(std::string(name) + " is " + std::to_string(number) + "; expected 0 to " +
                            std::to_string(static_cast<int>(last)));
    return static_cast<Enum>(number);
}

/// @throws WrongArgument unless it is 0 or 1
template <typename Integer>
bool flag(Integer value, const char* name) {
    if (value != 0 && value != 1)
        throw WrongArgument(std::string(name) + " is " + std::to_string(value) + "; expected 0 or 1");
    return value == 1;
}

// ---- Structs that begin with their size

/// The size of a struct in its first version; a struct that has grown since passes its first size explicitly.
template <typename Struct>
inline constexpr std::size_t kFirstSize = sizeof(Struct);

/// @throws WrongArgument if the size of a caller's struct cannot be right
void require_size(std::size_t size, std::size_t known_size, std::size_t first_size, const char* name);

/// @throws WrongArgument if a byte after the known ones is set, which belongs to a member that this library
/// does not have
void require_zero(const void* first, std::size_t known_size, std::size_t size, const char* name);

/// Refuses a value to which a later version may give a meaning that this version would ignore.
/// @throws WrongArgument unless it is 0
template <typename Integer>
void require_unused(Integer reserved) {
    if (reserved != 0)
        throw WrongArgument("options.reserved is " + std::to_string(reserved) +
                            "; expected 0: fill options by their _init function");
}

/// The part that the caller's struct and the library's have in common.
inline std::size_t common_size(std::size_t size, std::size_t known_size) {
    return size < known_size ? size : known_size;
}

/// A copy of the caller's struct, which may be older or newer than the library's: members that it lacks keep
/// their value in `defaults`.
/// @pre Struct has no padding at its end, since the bytes that an older header leaves there would be taken
/// for a member by a newer one
template <typename Struct>
Struct read_struct(const Struct* given, const Struct& defaults, const char* name) {
    const std::size_t size = at(given, name).size;
    require_size(size, sizeof(Struct), kFirstSize<Struct>, name);
    require_zero(given, sizeof(Struct), size, name);
    Struct result = defaults;
    std::memcpy(&result, given, common_size(size, sizeof(Struct)));
    return result;
}

/// Writes the members for which the caller's struct has room; members that the library does not have become
/// zero.
template <typename Struct>
void write_struct(Struct* result, Struct value, const char* name) {
    const std::size_t size = at(result, name).size;
    require_size(size, sizeof(Struct), kFirstSize<Struct>, name);
    value.size = size;
    std::memset(result, 0, size);
    std::memcpy(result, &value, common_size(size, sizeof(Struct)));
}

/// The body of the _init functions.
template <typename Struct>
void init_struct(Struct* result, std::size_t size, Struct defaults) noexcept {
    if (result == nullptr || size < sizeof result->size) return;
    defaults.size = size;
    std::memset(result, 0, size);
    std::memcpy(result, &defaults, common_size(size, sizeof(Struct)));
}

/// Asserts that there is no padding after the last member; see read_struct().
#define ECHINUS_REQUIRE_NO_PADDING_AFTER(STRUCT, LAST)                                                       \
    static_assert(sizeof(STRUCT) == offsetof(STRUCT, LAST) + sizeof(STRUCT::LAST))

} // namespace echinus::c

// ---- The objects behind handles: plain C++ values

/// Holds arrays of any type.
struct echinus_array {
    std::shared_ptr<const void> storage;
    const void* data;
    std::size_t count;
};

namespace echinus::c {

/// An array for the caller from a vector.
template <typename T>
echinus_array array_of(std::vector<T> values) {
    const auto storage = std::make_shared<const std::vector<T>>(std::move(values));
    return {storage, storage->data(), storage->size()};
}

} // namespace echinus::c
