#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <vector>

namespace echinus {

/// Memory for the temporary arrays of a step. Mostly, arrays are given back in the reverse of the order in
/// which they were taken. All memory is kept for the next step, so that steps allocate nothing after the
/// largest one. For use by one thread.
class Scratch {
  public:
    Scratch() = default;
    Scratch(const Scratch&) = delete;
    Scratch& operator=(const Scratch&) = delete;

    /// Returns memory aligned to kAlignment. @throws std::bad_alloc
    void* take(std::size_t byte_count);
    /// @param memory  a result of take()
    void give_back(void* memory) noexcept;

    static constexpr std::size_t kAlignment = 64;

  private:
    struct Aligned {
        void operator()(std::byte* memory) const noexcept {
            ::operator delete (memory, std::align_val_t{kAlignment});
        }
    };
    using Memory = std::unique_ptr<std::byte, Aligned>;
    /// A header in front of each array.
    struct alignas(kAlignment) Header {
        Header* below; ///< header of the array taken before; null for the first, and outside the buffer
        std::size_t byte_count;
        bool is_within, is_given_back; ///< is_within: the array is in the buffer
    };

    static Memory allocate(std::size_t byte_count);

    Memory buffer_;
    std::size_t size_ = 0, used_ = 0;
    /// Bytes for which the buffer has no room: at present, and the most at a time.
    std::size_t beyond_ = 0, most_beyond_ = 0;
    Header* last_ = nullptr;
};

/// The allocator by which a std::vector takes its memory from a Scratch, which must outlive it.
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

/// The memory for data of the calling thread's batches that is too large for a small stack. The thread keeps
/// it until it ends. @throws std::bad_alloc
Scratch& scratch_of_thread();

/// An object in that memory. Calls may nest, for example if a custom map queries another map.
template <typename T>
class OnScratch {
    static_assert(alignof(T) <= Scratch::kAlignment);

  public:
    /// Like "T object;": members without an initialiser have arbitrary values.
    OnScratch() : object_(new (memory_.address) T) {}
    template <typename... Arguments>
    explicit OnScratch(const Arguments&... arguments) : object_(new (memory_.address) T(arguments...)) {}
    OnScratch(const OnScratch&) = delete;
    OnScratch& operator=(const OnScratch&) = delete;
    ~OnScratch() { object_->~T(); }

    T& operator*() { return *object_; }
    T* operator->() { return object_; }

  private:
    struct Memory {
        Memory() : scratch(scratch_of_thread()), address(scratch.take(sizeof(T))) {}
        Memory(const Memory&) = delete;
        Memory& operator=(const Memory&) = delete;
        ~Memory() { scratch.give_back(address); }

        Scratch& scratch;
        void* address;
    };

    Memory memory_;
    T* object_;
};

} // namespace echinus
