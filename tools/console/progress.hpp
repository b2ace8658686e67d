#pragma once

#include <chrono>
#include <optional>
#include <string>

/// A bar on standard error that shows how much of a long task is done, and nothing at all if standard error
/// is not a terminal. A function object, so that it can be passed as any progress callback.
class ProgressBar {
  public:
    explicit ProgressBar(std::string label);
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;
    /// Erases the bar, so that further output starts on a clean line.
    ~ProgressBar();

    /// @param fraction  the completed share of the task, 0 to 1; may be called at any rate
    void operator()(double fraction);

  private:
    using Clock = std::chrono::steady_clock;

    std::string label_;
    bool on_terminal_;
    bool drawn_ = false;
    Clock::time_point last_drawn_;
};

/// One bar after the other, for work in stages that each have a name.
class StageBars {
  public:
    void operator()(const std::string& stage, double fraction);
    /// Erases the last bar.
    void finish() { bar_.reset(); }

  private:
    std::string stage_;
    std::optional<ProgressBar> bar_;
};
