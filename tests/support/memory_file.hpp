#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <span>
#include <string>

namespace echinus::test {

/// A file in memory, for readers that take a path.
class MemoryFile {
  public:
    MemoryFile() : descriptor_(memfd_create("echinus", MFD_CLOEXEC)) {
        if (descriptor_ < 0) std::abort();
    }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;
    ~MemoryFile() { close(descriptor_); }

    std::filesystem::path path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }
    /// In place of what it held.
    void hold(std::span<const std::byte> bytes) {
        const auto size = static_cast<ssize_t>(bytes.size());
        if (ftruncate(descriptor_, 0) != 0 || pwrite(descriptor_, bytes.data(), bytes.size(), 0) != size)
            std::abort();
    }

  private:
    int descriptor_;
};

} // namespace echinus::test
