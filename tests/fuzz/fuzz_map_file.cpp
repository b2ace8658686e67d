#include "support/map_file_attack.hpp"

#include <cstdint>

/// Any exception except echinus::Error leaves attack_map_file() and ends the program, which signals a finding
/// to the fuzzer.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    echinus::test::attack_map_file({reinterpret_cast<const std::byte*>(data), size});
    return 0;
}
