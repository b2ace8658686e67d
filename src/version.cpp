#include <echinus/version.hpp>

namespace echinus {

const char* version() noexcept {
    return ECHINUS_VERSION_STRING;
}

} // namespace echinus
