#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <new>
#include <span>
#include <type_traits>

namespace echinus {

/// A growing array of plain values that keeps its memory from one use to the next. Unlike std::vector it
/// leaves new elements unwritten, so the first thread to touch a page is the one that needs it.
template <typename T>
class Arena {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

  public:
    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    T* data() { return data_.get(); }
    const T* data() const { return data_.get(); }
    T* begin() { return data(); }
    T* end() { return data() + size_; }
    const T* begin() const { return data(); }
    const T* end() const { return data() + size_; }
    T& operator[](std::size_t i) { return data_[i]; }
    const T& operator[](std::size_t i) const { return data_[i]; }
    T& back() { return data_[size_ - 1]; }
    operator std::span<const T>() const { return {data(), size_}; }
    operator std::span<T>() { return {data(), size_}; }

    /// Empties the array but keeps its memory.
    void clear() { size_ = 0; }

    /// Sets the size. The previous contents are lost, and the new ones are arbitrary.
    void reset(std::size_t size) {
        if (size > capacity_) {
            data_.reset();
            data_ = unwritten(size);
            capacity_ = size;
        }
        size_ = size;
    }

    /// Memory for the next `count` values, which extend() then adds to the array.
    T* room_for(std::size_t count) {
        if (size_ + count > capacity_) grow(size_ + count);
        return data() + size_;
    }

    /// @pre `count` values were written to the memory from room_for(), which was called with at least this
    /// count
    void extend(std::size_t count) { size_ += count; }

    void push_back(const T& value) {
        *room_for(1) = value;
        extend(1);
    }

  private:
    using Memory = std::unique_ptr<T[]>;

    /// std::make_unique_for_overwrite, which is missing from the libc++ of Emscripten 3.1.
    static Memory unwritten(std::size_t size) { return Memory(new T[size]); }

    void grow(std::size_t least) {
        const std::size_t capacity = std::max(least, 2 * capacity_);
        auto data = unwritten(capacity);
        std::copy_n(data_.get(), size_, data.get());
        data_ = std::move(data);
        capacity_ = capacity;
    }

    Memory data_;
    std::size_t size_ = 0, capacity_ = 0;
};

/// An array whose elements are not initialised, for a kernel's memory: a small call uses little of it, so
/// that default values would mostly be written in vain.
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
