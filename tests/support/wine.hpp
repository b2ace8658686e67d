#pragma once

#include <filesystem>

namespace echinus::test {

/// Does the test run in Wine?
inline bool is_wine() {
#ifdef _WIN32
    return std::filesystem::exists("C:/windows/system32/winecfg.exe");
#else
    return false;
#endif
}

inline constexpr const char* kWineReplacesNoOpenFile =
    "Wine 8 lacks the rename of Windows 10 that replaces a file which somebody has open";

} // namespace echinus::test
