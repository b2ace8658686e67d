#include "console/machine.hpp"

#include <fmt/format.h>

#include <fstream>
#include <thread>

namespace {

/// The value of the first line "key ... separator value" of a system file, or "unknown".
std::string value_of(const char* path, const std::string& key, char separator) {
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
        const std::size_t at = line.find(separator);
        if (!line.starts_with(key) || at == std::string::npos) continue;
        const std::size_t begin = line.find_first_not_of(" \t\"", at + 1);
        const std::size_t end = line.find_last_not_of(" \t\"");
        if (begin != std::string::npos) return line.substr(begin, end + 1 - begin);
    }
    return "unknown";
}

} // namespace

std::string describe_machine() {
    return fmt::format("{}, {} cores, {}, GCC {}", value_of("/proc/cpuinfo", "model name", ':'),
                       std::thread::hardware_concurrency(), value_of("/etc/os-release", "PRETTY_NAME", '='),
                       __VERSION__);
}
