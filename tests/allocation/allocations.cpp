#include "allocation/allocations.hpp"

#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

std::atomic<std::size_t> allocation_count_{0}, held_bytes{0}, most_held_bytes{0};

void raise_most_held_bytes(std::size_t held) {
    std::size_t most = most_held_bytes;
    while (most < held && !most_held_bytes.compare_exchange_weak(most, held)) {
    }
}

} // namespace

// Under a sanitizer, which has an operator new of its own, GCC does not see that these two belong together.
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"

void* operator new(std::size_t size) {
    void* const memory = std::malloc(size == 0 ? 1 : size);
    if (memory == nullptr) throw std::bad_alloc();
    ++allocation_count_;
    raise_most_held_bytes(held_bytes += malloc_usable_size(memory));
    return memory;
}
void operator delete(void* memory) noexcept {
    held_bytes -= malloc_usable_size(memory); // 0 of nothing
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    operator delete(memory);
}

namespace echinus::test {

std::size_t allocation_count() {
    return allocation_count_;
}

PeakOfHeldBytes::PeakOfHeldBytes() : before_(held_bytes) {
    most_held_bytes = before_;
}

std::size_t PeakOfHeldBytes::get() const {
    return most_held_bytes - before_;
}

} // namespace echinus::test
