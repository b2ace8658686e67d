#pragma once

#include <cstring>
#include <type_traits>

namespace echinus {

/// std::bit_cast, which the libc++ of Emscripten 3.1 lacks.
template <typename To, typename From>
To bit_cast(const From& from) noexcept {
    static_assert(sizeof(To) == sizeof(From) && std::is_trivially_copyable_v<To> &&
                  std::is_trivially_copyable_v<From>);
    To to;
    std::memcpy(&to, &from, sizeof to);
    return to;
}

} // namespace echinus
