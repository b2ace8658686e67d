#include "points/points.hpp"
#include "support/attacks.hpp"
#include "support/memory_file.hpp"

#include <echinus/error.hpp>

#include <array>
#include <cstdint>
#include <memory>
#include <span>

namespace {

std::unique_ptr<PointSource> open_points(const std::filesystem::path& path) {
    auto input = std::make_unique<Input>(path);
    return format_of_points(path, *input) == TableFormat::Npy ? open_npy_points(std::move(input))
                                                              : open_csv_points(std::move(input));
}

} // namespace

/// A table of points either is refused with an Error or holds as many points as it says.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static echinus::test::MemoryFile file;
    file.hold(std::as_bytes(std::span(data, size)));
    try {
        const std::unique_ptr<PointSource> points = open_points(file.path());
        std::array<echinus::Vec3d, 64> block;
        std::uint64_t total = 0;
        while (const std::size_t count = points->read(block)) total += count;
        if (total != points->count()) std::abort();
    } catch (const echinus::Error& error) {
        echinus::test::require_sentence(error.what(), file.path().string());
    }
    return 0;
}
