#include "console/progress.hpp"

#include "files/system.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

ProgressBar::ProgressBar(std::string label)
    : label_(std::move(label)), on_terminal_(echinus::system::has_terminal()) {}

ProgressBar::~ProgressBar() {
    if (drawn_) std::fputs("\r\033[K", stderr);
}

void ProgressBar::operator()(double fraction) {
    // Ten times a second is smooth enough to watch and too seldom to cost noticeable time.
    constexpr auto kRedrawInterval = std::chrono::milliseconds(100);
    constexpr int kWidth = 40;
    if (!on_terminal_) return;
    const Clock::time_point now = Clock::now();
    if (drawn_ && now - last_drawn_ < kRedrawInterval) return;
    const double done = std::clamp(fraction, 0.0, 1.0);
    const int filled = static_cast<int>(done * kWidth);
    const std::string bar = std::string(filled, '#') + std::string(kWidth - filled, '.');
    std::fputs(fmt::format("\r{} [{}] {:3.0f} %", label_, bar, done * 100).c_str(), stderr);
    std::fflush(stderr);
    drawn_ = true;
    last_drawn_ = now;
}

void StageBars::operator()(const std::string& stage, double fraction) {
    if (stage != stage_ || !bar_) {
        stage_ = stage;
        bar_.reset();
        bar_.emplace(stage);
    }
    (*bar_)(fraction);
}
