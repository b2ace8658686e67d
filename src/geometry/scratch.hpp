#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <vector>

namespace echinus {

/// Memory for the arrays that a step needs for a while. Those taken last are given back first, mostly, and
/// all of it is kept for the next step: steps allocate nothing once they have seen their largest. Of one
/// thread.
class Scratch {
  public:
    Scratch() = default;
    Scratch(const Scratch&) = delete;
    Scratch& operator=(const Scratch&) = delete;

    /// Aligned to kAlignment. @throws std::bad_alloc
    void* take(std::size_t byte_count);
    /// @param memory  that take() gave
    void give_back(void* memory) noexcept;

    static constexpr std::size_t kAlignment = 64;

  private:
    struct Aligned {
        void operator()(std::byte* memory) const noexcept {
            ::operator delete (memory, std::align_val_t{kAlignment});
        }
    };
    using Memory = std::unique_ptr<std::byte, Aligned>;
    /// In front of each array.
    struct alignas(kAlignment) Header {
        Header* below; ///< of the array taken before; null for the first, and beyond the buffer
        std::size_t byte_count;
        bool is_within, is_given_back; ///< the buffer
    };

    static Memory allocate(std::size_t byte_count);

    Memory buffer_;
    std::size_t size_ = 0, used_ = 0;
    std::size_t beyond_ = 0, most_beyond_ = 0; ///< bytes that the buffer had no room for: now, and at a time
    Header* last_ = nullptr;
};

/// By which a std::vector takes its memory from a Scratch, which has to outlive it.
template <typename T>
struct ScratchAllocator {
    using value_type = T;

    ScratchAllocator(Scratch& scratch_in) : scratch(&scratch_in) {} // NOLINT: vectors are given a Scratch
    template <typename Other>
    ScratchAllocator(const ScratchAllocator<Other>& other) : scratch(other.scratch) {} // NOLINT: as others do

    T* allocate(std::size_t count) { return static_cast<T*>(scratch->take(count * sizeof(T))); }
    void deallocate(T* items, std::size_t) noexcept { scratch->give_back(items); }

    friend bool operator==(const ScratchAllocator& a, const ScratchAllocator& b) {
        return a.scratch == b.scratch;
    }

    Scratch* scratch;
};

template <typename T>
using ScratchVector = std::vector<T, ScratchAllocator<T>>;

} // namespace echinus
