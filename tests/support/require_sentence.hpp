#pragma once

#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace echinus::test {

/// Ends the program, as a finding of a fuzzer, unless an error is one line that begins with the file's name.
inline void require_sentence(std::string_view sentence, std::string_view name) {
    if (sentence.starts_with(name) && sentence.find('\n') == std::string_view::npos) return;
    std::fprintf(stderr, "not a sentence: %.*s\n", static_cast<int>(sentence.size()), sentence.data());
    std::abort();
}

} // namespace echinus::test
