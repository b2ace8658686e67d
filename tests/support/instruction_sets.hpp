#pragma once

#include <echinus/instruction_set.hpp>

#include <string>
#include <string_view>

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

/// The value that body() returns under an instruction set; the previous one is restored.
template <typename Body>
auto under_instruction_set(std::string_view name, const Body& body) {
    const std::string before(instruction_set());
    use_instruction_set(name);
    auto result = body();
    use_instruction_set(before);
    return result;
}

} // namespace echinus::test
