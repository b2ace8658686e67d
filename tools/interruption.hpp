#pragma once

#include <filesystem>
#include <mutex>

/// From now on SIGINT, SIGTERM and SIGHUP first remove the registered files and folders and then end the
/// program as they would have done, so that a shell sees 130, 143 or 129 (files/system.hpp). A separate
/// thread waits for the signals, so that they may arrive at any time. On Windows an open file may remain; the
/// next run removes it.
/// @pre the program has no other threads yet
void clean_up_when_interrupted();

/// During its lifetime, interruption removes this file or folder.
class RemovedWhenInterrupted {
  public:
    explicit RemovedWhenInterrupted(std::filesystem::path path);
    RemovedWhenInterrupted(const RemovedWhenInterrupted&) = delete;
    RemovedWhenInterrupted& operator=(const RemovedWhenInterrupted&) = delete;
    ~RemovedWhenInterrupted();

  private:
    std::filesystem::path path_;
};

/// Interruption waits as long as this is held, so that several renames are done together.
std::unique_lock<std::mutex> hold_interruption();

/// Does not return if the program is being interrupted: errors at that time occur because results have been
/// removed.
void wait_if_interrupted();
