#pragma once

#include <cassert>
#include <cmath>
#include <compare>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>

namespace echinus {

// Conversions to integers that preserve the value. Converting a number that is out of range would be
// undefined or silently change it: with assertions it stops the program; without them, these are plain casts.

namespace detail {

/// False for NaN. Both bounds are powers of two or 0, hence exactly representable.
template <std::integral To, std::floating_point From>
constexpr bool holds_truncated(From value) {
    constexpr int kDigits = std::numeric_limits<To>::digits;
    constexpr From kBeyond = From{2} * (std::uint64_t{1} << (kDigits - 1));
    if constexpr (std::unsigned_integral<To>)
        return value > -1 && value < kBeyond;
    else
        return value >= -kBeyond && value < kBeyond;
}

} // namespace detail

/// A number rounded towards 0. @pre the result is in range, and the value is not NaN
template <std::integral To, std::floating_point From>
constexpr To truncated_to(From value) {
    assert(detail::holds_truncated<To>(value));
    return static_cast<To>(value);
}

/// The nearest integer; of two, the even one. @pre |value| < 2^63; not NaN
inline std::int64_t nearest_whole(double value) {
    assert(detail::holds_truncated<std::int64_t>(value));
    return std::llrint(value);
}

/// The same number as another type. @pre it is in the range of that type
template <std::integral To, std::integral From>
constexpr To kept_as(From value) {
    assert(std::in_range<To>(value));
    return static_cast<To>(value);
}

/// Packs two numbers into one, so that the results compare like the pairs. @pre low fits into kLowBits bits,
/// and high into the others
template <int kLowBits>
constexpr std::uint64_t packed(std::uint64_t high, std::uint64_t low) {
    assert(low >> kLowBits == 0 && high >> (64 - kLowBits) == 0);
    return high << kLowBits | low;
}

/// std::bit_cast, which is missing from the libc++ of Emscripten 3.1.
template <typename To, typename From>
To bit_cast(const From& from) noexcept {
    static_assert(sizeof(To) == sizeof(From) && std::is_trivially_copyable_v<To> &&
                  std::is_trivially_copyable_v<From>);
    To to;
    std::memcpy(&to, &from, sizeof to);
    return to;
}

/// Products of two int64 for compilers without 128-bit integers. Always declared, so that a test can compare
/// both implementations.
namespace portable {

/// A 128-bit integer in two's complement; it is ordered by `high`, then `low`.
struct Int128 {
    std::int64_t high;
    std::uint64_t low;

    friend auto operator<=>(const Int128&, const Int128&) = default;
};

/// Multiplies the halves of the factors; no sum of the middle terms exceeds 64 bits.
constexpr Int128 wide_product(std::int64_t a, std::int64_t b) {
    constexpr std::uint64_t kLow = 0xffff'ffff;
    const auto ua = static_cast<std::uint64_t>(a), ub = static_cast<std::uint64_t>(b);
    const std::uint64_t low = (ua & kLow) * (ub & kLow);
    const std::uint64_t middle = (ua >> 32) * (ub & kLow) + (low >> 32);
    const std::uint64_t other_middle = (ua & kLow) * (ub >> 32) + (middle & kLow);
    std::uint64_t high = (ua >> 32) * (ub >> 32) + (middle >> 32) + (other_middle >> 32);
    // A negative factor was counted as 2^64 more.
    if (a < 0) high -= ub;
    if (b < 0) high -= ua;
    return {static_cast<std::int64_t>(high), other_middle << 32 | (low & kLow)};
}

} // namespace portable

#ifdef __SIZEOF_INT128__

/// A type that holds the product of two int64 and is ordered.
__extension__ using Int128 = __int128;

constexpr Int128 wide_product(std::int64_t a, std::int64_t b) {
    return Int128{a} * b;
}

#else

using portable::Int128;
using portable::wide_product;

#endif

} // namespace echinus
