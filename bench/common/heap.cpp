#include "common/heap.hpp"

#include <malloc.h>

std::size_t heap_bytes() {
    const auto info = mallinfo2();
    return info.uordblks + info.hblkhd;
}
