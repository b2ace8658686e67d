#include "interface.hpp"

#include <echinus/instruction_set.hpp>

namespace echinus::wasm {

ECHINUS_EXPORT(instruction_set_name) Text* instruction_set_name() {
    return make_handle([] { return Text{std::string(instruction_set())}; });
}
ECHINUS_EXPORT(instruction_set_use) bool instruction_set_use(const char* name, std::uint32_t size) {
    return guarded([&] {
        use_instruction_set(text_at(name, size));
        return true;
    });
}

} // namespace echinus::wasm
