#pragma once

#ifdef _WIN32
#include <windows.h>
#endif

namespace echinus::test {

/// Does the test run in Wine?
inline bool is_wine() {
#ifdef _WIN32
    const HMODULE system = GetModuleHandleW(L"ntdll.dll");
    return system != nullptr && GetProcAddress(system, "wine_get_version") != nullptr;
#else
    return false;
#endif
}

inline constexpr const char* kWineReplacesNoOpenFile =
    "Wine 8 lacks the rename of Windows 10 that replaces a file which somebody has open";

} // namespace echinus::test
