#pragma once

#include <compare>
#include <cstdint>

namespace echinus {

/// Products of two int64 where the compiler has no whole numbers of 128 bits; always declared, so that a test
/// compares both.
namespace portable {

/// A whole number of 128 bits, in two's complement: the order is that of the parts.
struct Int128 {
    std::int64_t high;
    std::uint64_t low;

    friend auto operator<=>(const Int128&, const Int128&) = default;
};

/// By the halves of each factor; no sum of the middle exceeds 64 bits.
constexpr Int128 wide_product(std::int64_t a, std::int64_t b) {
    constexpr std::uint64_t kLow = 0xffff'ffff;
    const auto ua = static_cast<std::uint64_t>(a), ub = static_cast<std::uint64_t>(b);
    const std::uint64_t low = (ua & kLow) * (ub & kLow);
    const std::uint64_t middle = (ua >> 32) * (ub & kLow) + (low >> 32);
    const std::uint64_t other_middle = (ua & kLow) * (ub >> 32) + (middle & kLow);
    std::uint64_t high = (ua >> 32) * (ub >> 32) + (middle >> 32) + (other_middle >> 32);
    // A negative factor counted as 2^64 more.
    if (a < 0) high -= ub;
    if (b < 0) high -= ua;
    return {static_cast<std::int64_t>(high), other_middle << 32 | (low & kLow)};
}

} // namespace portable

#ifdef __SIZEOF_INT128__

/// Holds the product of two int64, and is ordered.
__extension__ using Int128 = __int128;

constexpr Int128 wide_product(std::int64_t a, std::int64_t b) {
    return Int128{a} * b;
}

#else

using portable::Int128;
using portable::wide_product;

#endif

} // namespace echinus
