#include "interruption.hpp"

#include "files/system.hpp"

#include <atomic>
#include <chrono>
#include <set>
#include <thread>

namespace fs = std::filesystem;

namespace {

struct Registry {
    std::mutex mutex;
    std::set<fs::path> paths;
    std::atomic<bool> interrupted = false;
};

/// Never destroyed, since the thread that cleans up ends with the process.
Registry& registry() {
    static auto& instance = *new Registry;
    return instance;
}

/// The rest of the program still runs and may put files into a folder while it is being removed.
void remove_for_good(const fs::path& path) {
    constexpr int kMostTries = 100;
    std::error_code ignored;
    for (int tries = 0; tries < kMostTries && fs::exists(path, ignored); ++tries) {
        fs::remove_all(path, ignored);
        std::this_thread::sleep_for(std::chrono::milliseconds(tries));
    }
}

} // namespace

void clean_up_when_interrupted() {
    echinus::system::when_interrupted([] {
        registry().interrupted = true;
        const std::lock_guard lock(registry().mutex);
        for (const fs::path& path : registry().paths) remove_for_good(path);
    });
}

RemovedWhenInterrupted::RemovedWhenInterrupted(fs::path path) : path_(std::move(path)) {
    const std::lock_guard lock(registry().mutex);
    registry().paths.insert(path_);
}

RemovedWhenInterrupted::~RemovedWhenInterrupted() {
    const std::lock_guard lock(registry().mutex);
    registry().paths.erase(path_);
}

std::unique_lock<std::mutex> hold_interruption() {
    return std::unique_lock(registry().mutex);
}

void wait_if_interrupted() {
    if (registry().interrupted) echinus::system::wait_for_end();
}
