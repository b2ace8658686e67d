#include "files/part.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <random>
#include <string>
#include <string_view>
#include <system_error>

namespace echinus {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kPrefix = ".echinus.part";

bool is_part(const fs::path& path) {
    const std::string name = path.filename().string();
    return name.size() > kPrefix.size() && name.starts_with(kPrefix) &&
           std::all_of(name.begin() + kPrefix.size(), name.end(),
                       [](char c) { return c >= '0' && c <= '9'; });
}

void remove_if_abandoned(const fs::path& part) {
    const int descriptor = open(part.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) return;
    std::error_code ignored;
    if (lock_part(descriptor)) fs::remove_all(part, ignored);
    close(descriptor);
}

} // namespace

fs::path new_part(const fs::path& folder) {
    static std::atomic<unsigned> counter{std::random_device{}()};
    return folder / (std::string(kPrefix) + std::to_string(counter++));
}

bool lock_part(int descriptor) noexcept {
    return flock(descriptor, LOCK_EX | LOCK_NB) == 0;
}

void remove_abandoned_parts(const fs::path& folder) noexcept {
    std::error_code error;
    fs::directory_iterator entry(folder, error);
    for (; !error && entry != fs::directory_iterator(); entry.increment(error))
        if (is_part(entry->path())) remove_if_abandoned(entry->path());
}

} // namespace echinus
