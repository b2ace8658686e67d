#pragma once

#include <cstddef>
#include <new>
#include <type_traits>

namespace echinus {

/// An array whose elements are not initialised: a kernel's memory on the stack, of which a small call uses
/// little, and in which default values would be written for nothing.
template <typename T, std::size_t kSize>
class RawArray {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

  public:
    T* data() { return std::launder(reinterpret_cast<T*>(bytes_)); }
    const T* data() const { return std::launder(reinterpret_cast<const T*>(bytes_)); }
    T& operator[](std::size_t i) { return data()[i]; }
    const T& operator[](std::size_t i) const { return data()[i]; }

  private:
    alignas(T) std::byte bytes_[kSize * sizeof(T)];
};

} // namespace echinus
