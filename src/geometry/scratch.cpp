#include "geometry/scratch.hpp"

#include "files/system.hpp"

#include <algorithm>
#include <memory>

namespace echinus {

Scratch::Memory Scratch::allocate(std::size_t byte_count) {
    return Memory(static_cast<std::byte*>(::operator new (byte_count, std::align_val_t{kAlignment})));
}

void* Scratch::take(std::size_t byte_count) {
    const std::size_t rounded = (byte_count + kAlignment - 1) / kAlignment * kAlignment;
    if (rounded < byte_count || rounded + sizeof(Header) < rounded) throw std::bad_alloc();
    const std::size_t needed = rounded + sizeof(Header);
    if (last_ == nullptr && beyond_ == 0 && most_beyond_ > 0) {
        buffer_.reset();
        const std::size_t size = size_ + most_beyond_;
        size_ = 0;
        buffer_ = allocate(size);
        size_ = size;
        most_beyond_ = 0;
    }
    if (needed <= size_ - used_) {
        last_ = new (buffer_.get() + used_) Header{last_, needed, true, false};
        used_ += needed;
        return last_ + 1;
    }
    Header* const header = new (allocate(needed).release()) Header{nullptr, needed, false, false};
    beyond_ += needed;
    most_beyond_ = std::max(most_beyond_, beyond_);
    return header + 1;
}

void Scratch::give_back(void* memory) noexcept {
    Header* const header = static_cast<Header*>(memory) - 1;
    if (!header->is_within) {
        beyond_ -= header->byte_count;
        Aligned{}(reinterpret_cast<std::byte*>(header));
        return;
    }
    header->is_given_back = true;
    for (; last_ != nullptr && last_->is_given_back; last_ = last_->below) used_ -= last_->byte_count;
}

namespace {

thread_local Scratch* of_thread = nullptr;

void end_of_thread(void* scratch) {
    of_thread = nullptr;
    delete static_cast<Scratch*>(scratch);
}

} // namespace

Scratch& scratch_of_thread() {
    if (of_thread == nullptr) [[unlikely]] {
        auto scratch = std::make_unique<Scratch>();
        system::give_at_thread_end(end_of_thread, scratch.get());
        of_thread = scratch.release();
    }
    return *of_thread;
}

} // namespace echinus
