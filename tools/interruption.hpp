#pragma once

#include <filesystem>
#include <mutex>

/// From now on SIGINT, SIGTERM and SIGHUP first remove what is registered below and then end the program as
/// they would have done, so that a shell sees 130, 143 or 129 (files/system.hpp). A thread waits for them, so
/// that the program may be anywhere meanwhile. On Windows a file that is open may stay; the next run removes
/// it.
/// @pre the program has no other threads yet
void clean_up_when_interrupted();

/// While it lives, interruption removes this file or folder.
class RemovedWhenInterrupted {
  public:
    explicit RemovedWhenInterrupted(std::filesystem::path path);
    RemovedWhenInterrupted(const RemovedWhenInterrupted&) = delete;
    RemovedWhenInterrupted& operator=(const RemovedWhenInterrupted&) = delete;
    ~RemovedWhenInterrupted();

  private:
    std::filesystem::path path_;
};

/// Interruption waits as long as this is held, so that a few renames are done together.
std::unique_lock<std::mutex> hold_interruption();

/// Does not return where the program is being interrupted: what fails meanwhile, fails because results were
/// removed.
void wait_if_interrupted();
