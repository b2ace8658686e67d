#include "mesh_io/point_cache.hpp"
#include "support/attacks.hpp"
#include "support/memory_file.hpp"

#include <echinus/error.hpp>

#include <cstdint>
#include <span>

using namespace echinus;

/// A reader of hostile bytes either refuses them with an Error or gives as many finite points as it says.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static test::MemoryFile file;
    file.hold(std::as_bytes(std::span(data, size)));
    try {
        const PointCacheReader reader(file.path());
        for (std::size_t sample = 0; sample < reader.sample_count(); ++sample)
            if (reader.positions(sample).size() != reader.point_count()) std::abort();
    } catch (const Error& error) {
        test::require_sentence(error.what(), file.path().string());
    }
    return 0;
}
