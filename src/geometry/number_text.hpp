#pragma once

#include <cstdio>
#include <string>

namespace echinus {

/// A number in a sentence: six significant digits, as a stream writes it. Streams would bring their locales
/// along, which make the WebAssembly file a fifth larger.
inline std::string number_text(double number) {
    char digits[32];
    std::snprintf(digits, sizeof digits, "%g", number);
    return digits;
}

} // namespace echinus
