#pragma once

#include <chrono>

namespace echinus {

/// Adds the duration of its lifetime to a sum.
class Stopwatch {
  public:
    explicit Stopwatch(double& sum_seconds) : sum_seconds_(sum_seconds) {}
    Stopwatch(const Stopwatch&) = delete;
    Stopwatch& operator=(const Stopwatch&) = delete;
    ~Stopwatch() { sum_seconds_ += std::chrono::duration<double>(Clock::now() - start_).count(); }

  private:
    using Clock = std::chrono::steady_clock;
    double& sum_seconds_;
    Clock::time_point start_ = Clock::now();
};

} // namespace echinus
