// Judges many points on several threads.

#include "judges/accuracy.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>

namespace echinus::test {

namespace {

constexpr std::size_t kBatch = 8192;
/// Side_of_triangle_mesh takes many times as long as everything else.
constexpr std::size_t kComparedWithCgal = 256;

Verdicts judge_batch(const AccuracyJudge& judge, std::span<const Vec3f> points,
                     std::span<const Defendant> defendants) {
    Verdicts verdicts;
    verdicts.scores.resize(defendants.size());
    std::vector<Answers> answers(defendants.size());
    for (std::size_t d = 0; d < defendants.size(); ++d) defendants[d].ask(points, answers[d]);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const std::int32_t face = answers.empty() ? 0 : answers.front().contacts[i].face;
        const bool is_hint = face >= 0 && static_cast<std::uint32_t>(face) < judge.face_count();
        const Truth truth = judge.truth(points[i], is_hint ? static_cast<std::uint32_t>(face) : 0);
        for (std::size_t d = 0; d < defendants.size(); ++d)
            judge.judge(points[i], truth, defendants[d].rule, answers[d].inside[i] != 0,
                        answers[d].contacts[i], verdicts.scores[d]);
        if (!judge.closed() || i % kComparedWithCgal != 0) continue;
        ++verdicts.compared_with_cgal;
        verdicts.judges_disagree += judge.agrees_with_cgal(points[i], truth) ? 0 : 1;
    }
    return verdicts;
}

/// Calls body(i) for i in [0, count) on several threads; the first exception reaches the caller.
template <typename Body>
void on_threads(std::size_t count, unsigned thread_count, const Body& body) {
    std::atomic<std::size_t> next{0};
    std::exception_ptr failure;
    std::mutex failure_mutex;
    const auto work = [&] {
        try {
            for (std::size_t i = next++; i < count; i = next++) body(i);
        } catch (...) {
            const std::lock_guard lock(failure_mutex);
            if (!failure) failure = std::current_exception();
            next = count;
        }
    };
    {
        std::vector<std::jthread> helpers;
        for (unsigned i = 1; i < thread_count; ++i) helpers.emplace_back(work);
        work();
    }
    if (failure) std::rethrow_exception(failure);
}

} // namespace

Verdicts judge_points(const AccuracyJudge& judge, std::span<const Vec3f> points,
                      std::span<const Defendant> defendants, unsigned thread_count,
                      const std::function<void(std::size_t done)>& report_progress) {
    const std::size_t batch_count = (points.size() + kBatch - 1) / kBatch;
    std::vector<Verdicts> batches(batch_count); // merged in order, so that the complaints are the first
                                                // overall
    std::mutex progress_mutex;
    std::size_t done = 0;
    on_threads(batch_count,
               std::max(1U, thread_count != 0 ? thread_count : std::thread::hardware_concurrency()),
               [&](std::size_t i) {
                   const std::size_t first = i * kBatch;
                   const auto batch = points.subspan(first, std::min(kBatch, points.size() - first));
                   batches[i] = judge_batch(judge, batch, defendants);
                   const std::lock_guard lock(progress_mutex);
                   done += batch.size();
                   if (report_progress) report_progress(done);
               });
    Verdicts total;
    total.scores.resize(defendants.size());
    for (const Verdicts& batch : batches) {
        for (std::size_t d = 0; d < defendants.size(); ++d) total.scores[d].merge(batch.scores[d]);
        total.compared_with_cgal += batch.compared_with_cgal;
        total.judges_disagree += batch.judges_disagree;
    }
    return total;
}

} // namespace echinus::test
