#include "interruption.hpp"

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <set>
#include <thread>

namespace fs = std::filesystem;

namespace {

struct Registry {
    std::mutex mutex;
    std::set<fs::path> paths;
    std::atomic<bool> interrupted = false;
};

/// Never destroyed: the thread that waits for signals ends with the process.
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

[[noreturn]] void clean_up_and_end(int signal, const sigset_t& signals) {
    registry().interrupted = true;
    pthread_sigmask(SIG_UNBLOCK, &signals, nullptr); // here a second one ends the program
    {
        const std::lock_guard lock(registry().mutex);
        for (const fs::path& path : registry().paths) remove_for_good(path);
    }
    raise(signal);
    _exit(128 + signal);
}

bool is_ignored(int signal) {
    struct sigaction action {};
    return sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

} // namespace

void clean_up_when_interrupted() {
    sigset_t signals;
    sigemptyset(&signals);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP})
        if (!is_ignored(signal)) sigaddset(&signals, signal);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr); // all threads that are started later have the same mask
    std::thread([signals] {
        int signal = 0;
        if (sigwait(&signals, &signal) == 0) clean_up_and_end(signal, signals);
    }).detach();
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
    while (registry().interrupted) pause();
}
