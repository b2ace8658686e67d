#include "support/saved_state_attack.hpp"

#include <cstdint>
#include <span>

/// Any exception except echinus::Error leaves the attack and ends the program, which signals a finding to the
/// fuzzer.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    echinus::test::attack_saved_state({data, size});
    return 0;
}
