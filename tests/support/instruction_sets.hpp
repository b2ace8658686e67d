#pragma once

#include <echinus/instruction_set.hpp>

#include <string>

namespace echinus::test {

/// Calls body(name) under each instruction set of the machine, then restores the previous one.
template <typename Body>
void under_each_instruction_set(const Body& body) {
    const std::string before(instruction_set());
    for (const std::string_view name : available_instruction_sets()) {
        use_instruction_set(name);
        body(name);
    }
    use_instruction_set(before);
}

} // namespace echinus::test
