#include "support/attacks.hpp"

#include <cstddef>
#include <cstdint>

/// Any exception except echinus::Error from a reader ends the program, which signals a finding to the fuzzer.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    echinus::test::attack_mesh("attack" ECHINUS_MESH_ENDING, {reinterpret_cast<const char*>(data), size});
    return 0;
}
