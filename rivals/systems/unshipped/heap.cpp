#include "rivals/systems/unshipped/unshipped.hpp"

#include <malloc.h>

std::size_t echinus::rivals::heap_bytes() {
    const auto info = mallinfo2();
    return info.uordblks + info.hblkhd;
}
