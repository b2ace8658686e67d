#pragma once

#include <cstddef>

/// What a test program allocates, counted by an operator new of its own: allocations.cpp is to be one of its
/// sources.
namespace echinus::test {

/// Calls of operator new so far.
std::size_t allocation_count();

/// The most memory that was held at a time since the beginning of this object's life, beyond what was held
/// then. One at a time.
class PeakOfHeldBytes {
  public:
    PeakOfHeldBytes();
    std::size_t get() const;

  private:
    std::size_t before_;
};

} // namespace echinus::test
